"""Report of a comparison: how far the simulator is from the vehicle, as text, Markdown, JSON and a page."""
