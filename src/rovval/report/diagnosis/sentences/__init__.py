"""What a diagnosis says, in sentences and words."""
