"""Tables of text, however exported: encoding, header, rows, cells."""
