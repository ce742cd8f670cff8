"""Bags as they lie on disk, whole or damaged: ROS 1 bag, ROS 2 sqlite3, MCAP -> blocks of messages -> columns of numbers.

`container` opens a file; its blocks hold many messages each, so that numbers are taken out of them by the column (`columns`), not by
the message. Damage is not raised but told (`damage`): every message that can be had is had.
"""
