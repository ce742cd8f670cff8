"""Columns of long logs: the same numbers wherever they lie, and no room for them is a refusal."""

from __future__ import annotations

import tempfile

import numpy as np
import pytest

from rovval.core.data import Series
from rovval.core.errors import BadInput
from rovval.core.long_columns import LONG, LongColumn, at_rest, is_at_rest


@pytest.mark.parametrize("dtype", [np.float64, np.int64])
@pytest.mark.parametrize("parts", [(), (3, 4), (LONG - 1,), (LONG,), (LONG // 2, LONG // 2, 7), (3, LONG, LONG)])
def test_a_column_is_what_was_appended(parts, dtype):
    column, whole = LongColumn(dtype), np.arange(sum(parts)).astype(dtype)
    for part in np.split(whole, np.cumsum(parts))[:-1]:
        column.append(part)
    assert len(column) == len(whole)
    got = column.array()
    assert got.dtype == dtype and np.array_equal(got, whole) and is_at_rest(got) == (len(whole) >= LONG)


def test_a_long_channel_lies_in_a_file_and_a_short_one_in_memory():
    t = at_rest(np.arange(LONG) * 0.01)
    one, two = Series(t, np.sin(t), "row"), Series(t, np.cos(t), "row")
    assert is_at_rest(one.values) and one.t is two.t and np.array_equal(one.values, np.sin(np.arange(LONG) * 0.01))
    assert not is_at_rest(Series(t[:100], np.sin(t[:100]), "row").values)


def test_no_room_is_said_with_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(BadInput, match="cannot be kept") as refused:
        at_rest(np.zeros(LONG))
    assert "TMPDIR" in refused.value.hint
