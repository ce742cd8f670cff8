"""Commanded motion without a log: the test scenarios of the thesis."""
