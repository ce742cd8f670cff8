"""One file a format. A reader is imported when a log needs it."""
