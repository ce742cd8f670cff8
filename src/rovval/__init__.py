"""rovval: where a simulator of a remotely operated vehicle and the real vehicle disagree, why, and by how much less once mended."""

__version__ = "0.1.0"
