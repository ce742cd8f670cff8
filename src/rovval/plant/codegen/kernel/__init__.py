"""The kernel as one reads it: ordinary typed Python, of which `rovval.plant.codegen.text` makes the source of one kernel for one kind of plant.

Nothing here is run as it stands. Names in capitals and the functions of `symbols` are the insertion points: choices are decided and branches that
are not taken go, `unrolled` loops are written out, the effects' functions come in where `in_turn` and `effect_value` stand. Functions marked
`compiled_function` are compiled as they are; every other is written into the function that calls it.

A block is W lanes side by side: row ``r`` of lane ``j`` stands at ``m[r * W + j]``, so that one loop over lanes is one vector instruction an
operation. `symbols` says what each row holds. Letters are those of Fossen (2021) and the thesis, chapter 3: ``u v w`` and ``r_p r_q r_r`` velocity of
the body, ``ur vr wr`` through the water, ``X Y Z K M N`` force and moment, ``qw qx qy qz`` attitude, ``rij`` rotation matrix from body to world.
"""
