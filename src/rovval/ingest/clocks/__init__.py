"""Stamps as logged -> seconds that rise, and the moment that they count from."""
