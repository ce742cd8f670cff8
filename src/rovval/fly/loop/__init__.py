"""The closed loop: instruments and their filter, guidance, controllers, allocation."""
