"""Autopilots of the ArduPilot family: what their logs say of the vehicle."""
