"""The search: the models that may explain the logs, a healthy vehicle with sets of causes, each with its evidence and its prior mass."""
