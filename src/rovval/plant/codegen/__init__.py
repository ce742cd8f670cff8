"""From the kernel that one reads to the one that runs.

`spec` says which kernel a plant needs and which effects are in it, `layout` where each number of a lane stands; `text` makes the source out of the
typed functions in `kernel`: `specialise` puts in what is known of the plant, `inline` the effects' functions. `cache` compiles, keeps and runs it,
with the arithmetic of `runtime`.
"""
