"""Report of a diagnosis: its sentences, and its text, Markdown, JSON and page."""
