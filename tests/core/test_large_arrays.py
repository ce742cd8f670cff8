"""Large arrays: the same numbers wherever they lie, and no room for them is a refusal."""

from __future__ import annotations

import tempfile

import numpy as np
import pytest

from rovval.core.errors import BadInput
from rovval.core.large_arrays import LARGE, columns_first, joined, taken, zeros
from rovval.core.long_columns import is_at_rest

MANY = LARGE // 8 // 100  # rows of 100 numbers that are a large array


@pytest.mark.parametrize("rows", [0, 3, MANY + 1])
def test_an_array_is_zero_until_it_is_written(rows):
    array = zeros(rows, 100)
    assert array.shape == (rows, 100) and not array.any()
    array += np.arange(100)
    assert np.array_equal(array.sum(axis=0), rows * np.arange(100.0))


def test_a_large_array_lies_in_a_file_and_a_small_one_in_memory():
    large, small = zeros(MANY + 1, 100).base, zeros(3, 100)
    assert large is not None and is_at_rest(large) and not is_at_rest(small)


def test_rows_are_taken_and_joined_in_their_order():
    rows = np.arange(12.0).reshape(6, 2)
    which = np.array([True, False, True, True, False, False])
    assert np.array_equal(taken(rows, which), rows[which]) and np.array_equal(taken(rows, np.array([4, 1])), rows[[4, 1]])
    assert np.array_equal(joined(rows[:2], rows[2:2], rows[2:]), rows)


def test_a_column_of_a_row_is_in_one_piece():
    array = columns_first(4, 5, 2, columns=3)
    assert array.shape == (4, 5, 2, 3) and array[1, ..., 2].flags["C_CONTIGUOUS"] and not array.any()


def test_no_room_is_said_with_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(BadInput, match="cannot be kept") as refused:
        zeros(MANY + 1, 100)
    assert "TMPDIR" in refused.value.hint
