"""Confusion groups: how much of the evidence model-form error may cost."""

from __future__ import annotations

from rovval.diagnose.search.confusion import form_share


def test_few_windows_leave_more_to_the_form_of_an_equation():
    shares = [form_share(m) for m in (3, 6, 12, 30, 300)]
    assert shares == sorted(shares, reverse=True) and 1.0 > shares[0] > shares[-1] > 0.0
