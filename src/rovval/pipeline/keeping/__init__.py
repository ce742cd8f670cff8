"""What stays of a batch: catalogue, trends and summary of what was found, how long reports are kept, and whether they are whole."""
