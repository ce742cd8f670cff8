"""Reports of a mission that was flown, and of one that is not yet: JSON, a terminal's text, a page."""
