"""What competes as the cause of a gap: the hypotheses of the library, the points from which their fits begin, and which of them a log can show."""
