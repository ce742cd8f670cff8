"""Spectrum and autocorrelation of errors: scipy's own figures, closed forms, and gaps."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import welch

from rovval.comparison.autocorrelation import autocorrelation, autocovariance
from rovval.comparison.spectrum import SEGMENT_S, power_spectrum

RNG = np.random.default_rng(5)
NOISE = RNG.normal(0.0, 0.02, 6000)
ALL = np.ones(6000, bool)


@pytest.mark.parametrize("n", [6000, 801])
def test_the_spectrum_is_scipy_s(n: int):
    frequency, density = power_spectrum(NOISE[:n], ALL[:n], 0.1)
    theirs = welch(NOISE[:n], 10.0, "hann", nperseg=min(512, n // 2))
    np.testing.assert_allclose(frequency, theirs[0][1:])
    np.testing.assert_allclose(density, theirs[1][1:], rtol=1e-9)


def test_white_noise_lies_at_its_level_and_a_wave_at_its_frequency():
    frequency, density = power_spectrum(NOISE + 0.3 * np.sin(2 * np.pi * 0.25 * np.arange(6000) * 0.1), ALL, 0.1)
    assert frequency[np.argmax(density)] == pytest.approx(0.25, abs=1.0 / SEGMENT_S)
    assert np.median(density) == pytest.approx(2 * 0.02**2 * 0.1, rel=0.1)


def test_segments_with_a_gap_do_not_count():
    ok, spoiled = ALL.copy(), NOISE.copy()
    ok[1000:1050], spoiled[1000:1050] = False, 1e9
    assert power_spectrum(spoiled, ok, 0.1)[1].max() < 1.0
    ok[::100] = False
    assert len(power_spectrum(NOISE, ok, 0.1)[0]) == 0, "no segment is whole"


def test_autocorrelation_of_noise_lies_in_the_band_and_of_a_wave_is_a_wave():
    found = autocorrelation(NOISE, ALL, 300)
    assert found[0] == 1.0 and np.mean(np.abs(found[1:]) > 1.96 / np.sqrt(6000)) < 0.1
    wave = np.sin(2 * np.pi * np.arange(6000) / 50)
    np.testing.assert_allclose(autocorrelation(wave, ALL, 100), np.cos(2 * np.pi * np.arange(101) / 50), atol=0.02)


def test_a_gap_changes_an_autocorrelation_by_what_is_missing_alone():
    wave, ok = np.sin(2 * np.pi * np.arange(6000) / 50), ALL.copy()
    ok[2000:2500] = False
    np.testing.assert_allclose(autocorrelation(np.where(ok, wave, 1e6), ok, 100), np.cos(2 * np.pi * np.arange(101) / 50), atol=0.02)
    assert np.isnan(autocorrelation(np.ones(100), np.ones(100, bool), 10)).all(), "a constant has none"


def test_autocovariance_by_hand():
    """Of 1, 2, 3, 6 about their mean 3: (4 + 1 + 0 + 9) / 4, (2 + 0 + 0) / 4, (0 - 3) / 4."""
    assert autocovariance(np.array([1.0, 2.0, 3.0, 6.0]), 2) == pytest.approx([3.5, 0.5, -0.75])
