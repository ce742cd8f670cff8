"""Runs on disk (`archive`) and files that appear whole or not at all (`atomic`)."""
