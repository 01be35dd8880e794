"""Numbers and registers (3.3.1, 3.2.4), against Python's own arithmetic and struct."""

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ecsim.values import BOOL, DINT, DWORD, INT, REAL, TYPES, WORD, join, real_from_words, signed16, single, split, words_from_real, wrap

WIDE = st.integers(-(2**40), 2**40)


@pytest.mark.parametrize(
    ("kind", "low", "high", "words", "signed"),
    [
        (BOOL, 0, 1, 0, False),
        (INT, -(2**15), 2**15 - 1, 1, True),
        (WORD, 0, 2**16 - 1, 1, False),
        (DINT, -(2**31), 2**31 - 1, 2, True),
        (DWORD, 0, 2**32 - 1, 2, False),
    ],
)
def test_a_type_has_the_range_of_its_width(kind, low, high, words, signed):
    assert (kind.low, kind.high, kind.words, kind.signed) == (low, high, words, signed)


def test_there_are_the_six_types_of_the_manual():
    assert list(TYPES) == ["BOOL", "INT", "WORD", "DINT", "DWORD", "REAL"]
    assert repr(REAL) == "REAL"


@given(WIDE)
@pytest.mark.parametrize(("kind", "code"), [(INT, "h"), (WORD, "H"), (DINT, "i"), (DWORD, "I")])
def test_wrapping_keeps_the_low_bits(kind, code, value):
    size = struct.calcsize(f">{code}")
    assert wrap(value, kind) == struct.unpack(f">{code}", (value % 256**size).to_bytes(size, "big"))[0]


@given(WIDE)
def test_a_register_holds_the_low_sixteen_bits(value):
    assert signed16(value) == wrap(value, INT)


@given(st.integers(-(2**31), 2**31 - 1))
def test_a_pair_of_registers_holds_thirty_two_bits(value):
    high, low = split(value)
    assert struct.pack(">hh", high, low) == struct.pack(">i", value)
    assert join(high, low) == value


@given(st.integers(0, 2**32 - 1))
def test_an_unsigned_number_is_split_bit_by_bit(value):
    assert struct.pack(">hh", *split(value)) == struct.pack(">I", value)


@given(st.floats(width=32, allow_nan=False))
def test_a_single_goes_through_registers_unchanged(value):
    assert struct.pack(">hh", *words_from_real(value)) == struct.pack(">f", value)
    assert real_from_words(*words_from_real(value)) == value


@given(st.floats(-3e38, 3e38))
def test_a_number_is_rounded_to_the_nearest_single(value):
    assert single(value) == struct.unpack(">f", struct.pack(">f", value))[0]


@pytest.mark.parametrize(
    ("value", "becomes"), [(1e39, math.inf), (-1e39, -math.inf), (3.5e38, math.inf), (math.inf, math.inf), (1e-50, 0.0)]
)
def test_a_number_beyond_the_singles_is_an_infinity(value, becomes):
    assert single(value) == becomes
    assert real_from_words(*words_from_real(value)) == becomes
