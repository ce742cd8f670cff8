"""A log of which no profile is known yet: what it holds, which profiles would read it, and a profile proposed for it."""
