"""The decision: which of the causes found are isolated, with which probability, and what stays unexplained."""
