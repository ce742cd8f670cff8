"""Residuals of the windows: sensitivities, parity residuals, and the normal equations of both."""
