"""What a batch has to do: the pipeline file, the logs that it names, and what of them is done already."""
