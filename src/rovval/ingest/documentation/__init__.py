"""docs/profiles.md: the profile language, written out of its model, with worked examples that the tests read."""
