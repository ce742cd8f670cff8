"""What every room speaks: data that flows between rooms, channels, frames, units, and the errors by which rovval refuses."""
