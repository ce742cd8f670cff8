"""The version of rovval."""

__version__ = "0.1.0"
