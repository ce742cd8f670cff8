"""The protocol of a sealed set: make and seal, answer and commit by digest, and only then open."""
