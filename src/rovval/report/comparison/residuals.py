"""What the error in the windows looks like: its autocorrelation with the band of white noise, and its spectrum beside the sensor's noise."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from rovval.comparison.autocorrelation import autocorrelation
from rovval.comparison.spectrum import power_spectrum
from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Comparison
from rovval.core.units import in_degrees
from rovval.report.common.numbers import per_cent
from rovval.report.drawings import curves
from rovval.report.drawings.curves import Place

LONGEST_LAG_S = 30.0  # chosen: three windows; a swing by the surface or of a tether is shorter
NORMAL_95 = 1.96  # standard errors: white noise has 95 % of its autocorrelations within 1.96 / sqrt(n) (Box and Jenkins 1976, 2.1.6)
LEAST_DENSITY = 1e-12  # unit^2/Hz: below it there is no error at all
LEAD = (
    "An error that is noise is alike to nothing later, and its autocorrelation lies in the band; one that is not is a force that is wrong or missing. "
    "The spectrum says how quick it is: what lies on the dashed line is the sensor's own noise. Windows restart the error, which shows at their length."
)


def drawn(c: Comparison) -> tuple[dict[str, Any], list[dict[str, Any]], list[Place]]:
    """Axes of lag and frequency, what the script draws, and where: of every axis of the windows its autocorrelation, then its spectrum."""
    run, windowed = c.run, c.sim.windowed
    axes: dict[str, Any] = {}
    pictures, places = list[dict[str, Any]](), list[Place]()
    most = min(round(LONGEST_LAG_S / run.dt), len(run) // 4)
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        row = c.windowed.get(axis)
        if row is None:
            continue
        factor, unit = in_degrees(1.0, row.unit)
        error = (windowed.nu[:, j] - run.get(name)) * factor
        ok = run.ok(name) & windowed.ok & np.isfinite(error)
        found = autocorrelation(np.where(ok, error, 0.0), ok, most)
        band, level = NORMAL_95 / sqrt(row.n), np.ones(most + 1)
        outside = float(np.mean(np.abs(found[1:]) > band))
        axes["lag"] = curves.steps(most + 1, run.dt, "s")
        edges = [curves.series("muted", label, sign * band * level, dash=(4, 4)) for sign, label in ((1.0, "white noise, upper"), (-1.0, "lower"))]
        pictures.append(curves.plot(f"r-{axis}", [curves.series("windowed", "autocorrelation", found), *edges], "lag"))
        places.append(Place(f"r-{axis}", f"{axis}, autocorrelation of the error", "", f"{per_cent(outside)} of the lags outside the band", "short"))
        frequency, density = power_spectrum(error, ok, run.dt)
        if not len(frequency):
            continue
        axes["frequency"] = curves.steps(len(frequency), float(frequency[0]), "Hz", float(frequency[0]), log=True)
        lines = [curves.series("windowed", "spectrum of the error", _decibel(density))]
        if row.noise > 0.0:
            noise = 2.0 * (row.noise * factor) ** 2 * run.dt * np.ones(len(frequency))
            lines.append(curves.series("muted", "sensor's noise", _decibel(noise), dash=(4, 4)))
        pictures.append(curves.plot(f"f-{axis}", lines, "frequency"))
        places.append(Place(f"f-{axis}", f"{axis}, spectrum of the error", f"dB of 1 ({unit})²/Hz", css="short"))
    return axes, pictures, places


def _decibel(density: np.ndarray) -> np.ndarray:
    return np.asarray(10.0 * np.log10(np.maximum(density, LEAST_DENSITY)))
