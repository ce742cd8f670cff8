"""What can be wrong in plant b, by where it acts: on the body, its drives and jets, the water, the tether, the log; and what no library holds."""
