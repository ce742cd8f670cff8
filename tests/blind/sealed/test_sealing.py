"""The seal: what goes in comes out with the key, and shows nothing without it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovval.blind.sealed import sealing
from rovval.core.errors import BadInput


@settings(deadline=None, max_examples=20)  # scrypt is slow on purpose
@given(st.binary(max_size=300))
def test_what_is_sealed_comes_out_again(text):
    key = b"k" * 64
    assert sealing.unseal(sealing.seal(text, key), key) == text


def test_a_seal_shows_nothing_and_is_another_each_time():
    text = b'{"effects": ["buoyancy_error"]}' * 50
    one, two = sealing.seal(text, b"key"), sealing.seal(text, b"key")
    assert one != two
    assert b"buoyancy" not in one


@pytest.mark.parametrize("place", [0, 25, 60, -1])
def test_a_damaged_seal_is_refused(place):
    sealed = bytearray(sealing.seal(b"labels", b"key"))
    sealed[place] ^= 1
    with pytest.raises(BadInput):
        sealing.unseal(bytes(sealed), b"key")


def test_another_key_is_refused():
    with pytest.raises(BadInput, match="does not fit this key"):
        sealing.unseal(sealing.seal(b"labels", b"key"), b"other")
