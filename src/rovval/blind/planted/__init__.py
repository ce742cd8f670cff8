"""Everything that can be planted, a family a file: each class is one effect, and `rovval.blind.planted.catalogue` lists them.

The order of the families and of the classes in them is part of a set's seed: a new effect goes to the end of its file.
"""
