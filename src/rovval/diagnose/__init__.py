"""Diagnosis: where the gap between a simulator and logs of the vehicle lies, which effect causes it, how far it shrinks.

Every answer is about this simulator, these logs and this library of effects. A group of effects that the logs cannot tell apart, no
gap at all, an effect outside the library, and "this log cannot tell" are answers.
"""

from rovval.diagnose.pipeline import diagnose
from rovval.diagnose.result.diagnosis import Diagnosis

__all__ = ["Diagnosis", "diagnose"]
