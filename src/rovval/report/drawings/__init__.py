"""Drawings that need no script, the curves of a page, and the colours of both."""
