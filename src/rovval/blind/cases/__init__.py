"""Which logs a set holds, and the making of each: cases, the flight through the plant, the CSV that a diagnosis is given."""
