"""Stated tolerances: how they are written, and what exceeds them."""

import pytest

from rovval.comparison import metrics
from rovval.core.errors import UsageProblem
from rovval.pipeline.tolerances import exceeded, parse

COMPARISON = {
    "axes": {
        "surge": {"unit": "m/s", "rmse": 0.08, "mae": 0.06, "iae": 10.0, "mean_error": -0.05, "vaf": 91.0, "lag": -0.3},
        "yaw": {"unit": "rad/s", "rmse": 0.01},
    },
    "window": {"axes": {"surge": {"rms": 0.03, "iae": 5.0}}},
}


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("surge=0.08", True),
        ("surge=0.0799", False),
        ("surge.iae=10", True),
        ("surge.iae=9.9", False),
        ("surge.vaf=90", True),  # of what is larger the better the limit is the least
        ("surge.vaf=92", False),
        ("surge.lag=0.2", False),
        ("surge.mean_error=0.04", False),  # the sign does not excuse it
        ("window.surge=0.03", True),
        ("window.surge.rms=0.029", False),
        ("sway=100", False),  # not measured: the tolerance cannot be said to be kept
        ("window.yaw=1", False),
    ],
)
def test_exceeded(text, kept):
    assert (exceeded(parse([text]), COMPARISON) == ()) is kept


def test_the_sentence_says_value_unit_and_limit():
    assert exceeded(parse(["surge.iae=9"]), COMPARISON) == ("surge.iae: 10 m is above the limit 9",)
    assert exceeded(parse(["surge.lag=0.2"]), COMPARISON) == ("surge.lag: 0.3 s is above the limit 0.2",)


def test_every_wrong_one_is_named_at_once():
    with pytest.raises(UsageProblem) as refused:
        parse(["surge", "bow=1", "surge.median=1", "surge=-1", "surge=nan", "yaw=0.1"])
    assert "5 problems" in refused.value.message


def test_every_metric_can_be_one():
    assert [t.metric for t in parse([f"surge.{name}=1" for name in metrics.names()])] == list(metrics.names())
