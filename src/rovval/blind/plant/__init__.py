"""The independent plant: a vehicle's equations of motion, motors, instruments and environment, written apart from `rovval.plant`."""
