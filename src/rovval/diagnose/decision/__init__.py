"""The decision: how probable every model is, and what is named, with which probability, and what stays unexplained."""
