"""Where the gap lies: slices of one quantity are named once an axis."""

from rovval.diagnose.result.attribution import Slice, worst


def test_slices_of_one_quantity_are_named_once_an_axis():
    def slice_(axis: str, regime: str, share: float) -> Slice:
        return Slice(axis, regime, share, 0.2, share / 0.2, 1.5, 4.0, 9)

    found = [slice_("yaw", "u < -0.3 m/s", 0.6), slice_("yaw", "|u| > 0.3 m/s", 0.7), slice_("sway", "|u| > 0.3 m/s", 0.5), slice_("yaw", "depth > 3 m", 0.4)]
    named = [(s.axis, s.regime) for s in worst(found, {"yaw": 1.0, "sway": 0.5})]
    assert named == [("yaw", "|u| > 0.3 m/s"), ("yaw", "depth > 3 m"), ("sway", "|u| > 0.3 m/s")]
