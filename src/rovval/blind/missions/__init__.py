"""What the vehicle is asked to do in a flight, and the pilot and autopilot that try to do it."""
