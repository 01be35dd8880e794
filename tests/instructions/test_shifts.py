"""Rotates and shifts against bits that are moved one by one, and against big integers."""

from collections import deque

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim

OPERAND_ERROR = 64
WIDTHS = {"": (16, "WORD"), "D": (32, "DWORD")}
COUNTS = st.integers(0, 100)


def moved(plc, word, count, kind, carry=0):
    """D10 and the carry flag after the PLC's one instruction has moved D0 by D50 bits."""
    plc.set({f"D0:{kind}": word, "D50": count, "SM181": carry})
    plc.scan()
    return plc[f"D10:{kind}"], plc["SM181"]


def one_by_one(word, bits, count, to_the_left, ring=None):
    """A word moved bit by bit; with `ring` the carry is a member, without it a copy of the bit that moved last."""
    places = deque(int(digit) for digit in f"{word:0{bits}b}")
    last = ring
    if ring is not None:
        places.appendleft(ring)
    for _ in range(count):
        last = places[0] if to_the_left else places[-1]
        places.rotate(-1 if to_the_left else 1)
    if ring is not None:
        last = places.popleft()
    return int("".join(map(str, places)), 2), last


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize(("name", "to_the_left"), [("ROR", False), ("ROL", True)])
@given(data=st.data(), count=COUNTS, carry=st.integers(0, 1))
def test_a_rotate_moves_bit_by_bit_and_keeps_the_last_in_the_carry(running, width, name, to_the_left, data, count, carry):
    bits, kind = WIDTHS[width]
    word = data.draw(st.integers(0, 2**bits - 1))
    expected, last = one_by_one(word, bits, count, to_the_left)
    assert moved(running(f"LD SM0\n{width}{name} D0 D10 D50"), word, count, kind, carry) == (expected, carry if last is None else last)


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize(("name", "to_the_left"), [("RCR", False), ("RCL", True)])
@given(data=st.data(), count=COUNTS, carry=st.integers(0, 1))
def test_a_rotate_with_carry_is_a_ring_of_one_bit_more(running, width, name, to_the_left, data, count, carry):
    bits, kind = WIDTHS[width]
    word = data.draw(st.integers(0, 2**bits - 1))
    expected = one_by_one(word, bits, count, to_the_left, ring=carry)
    assert moved(running(f"LD SM0\n{width}{name} D0 D10 D50"), word, count, kind, carry) == expected


@pytest.mark.parametrize("width", WIDTHS)
@given(data=st.data(), count=st.one_of(COUNTS, st.just(32767)), carry=st.integers(0, 1))
def test_a_shift_multiplies_or_divides_by_powers_of_two_and_leaves_the_carry(running, width, data, count, carry):
    bits, kind = WIDTHS[width]
    word = data.draw(st.integers(0, 2**bits - 1))
    assert moved(running(f"LD SM0\n{width}SHR D0 D10 D50"), word, count, kind, carry) == (word // 2**count, carry)
    assert moved(running(f"LD SM0\n{width}SHL D0 D10 D50"), word, count, kind, carry) == (word * 2**count % 2**bits, carry)


@pytest.mark.parametrize("name", "ROR DROR ROL DROL RCR DRCR RCL DRCL SHR DSHR SHL DSHL".split())
@given(count=st.integers(-32768, -1), carry=st.integers(0, 1))
def test_a_count_below_zero_is_an_operand_error_and_changes_nothing(running, name, count, carry):
    plc = running(f"LD SM0\n{name} D0 D10 D50")
    plc.set({"D0": -1, "D10": 1234, "D11": 77, "D50": count, "SM181": carry})
    plc.scan()
    assert (plc["D10"], plc["D11"], plc["SM181"], plc["SM20"], plc["SD20"]) == (1234, 77, carry, 1, OPERAND_ERROR)


@pytest.mark.parametrize(("name", "text"), [("ROR", "K3M0"), ("SHL", "K1X0"), ("DRCL", "K7M0"), ("DSHR", "K5M0")])
def test_a_kn_source_has_the_full_width(name, text):
    with pytest.raises(ecsim.ProgramError, match=f"{text}' is too narrow for S1; a Kn string has the full width here"):
        ecsim.compile(f"LD SM0\n{name} {text} D10 1", "EC20")


def test_a_constant_count_below_zero_is_refused():
    with pytest.raises(ecsim.ProgramError, match="S2 = '-1' is out of range; S2 goes from 0 to 32767"):
        ecsim.compile("LD SM0\nROR D0 D10 -1", "EC20")


def string(plc, first, number, length):
    """A run of relays as a number, the one with the lowest number its lowest bit."""
    return sum(plc[f"{first}{number + place}"] << place for place in range(length))


@pytest.mark.parametrize("name", ["SFTR", "SFTL"])
@given(data=st.data(), length=st.integers(0, 20), step=st.integers(0, 25))
def test_a_string_of_bits_moves_as_a_number_does(running, name, data, length, step):
    plc = running(f"LD SM0\n{name} M100 M10 D0 D1")
    source, target = data.draw(st.integers(0, 2**step - 1)), data.draw(st.integers(0, 2**length - 1))
    plc.set({f"M{100 + place}": source >> place & 1 for place in range(step)})
    plc.set({f"M{10 + place}": target >> place & 1 for place in range(length)})
    plc.set({"D0": length, "D1": step, "M9": 1, f"M{10 + length}": 1})
    plc.scan()
    expected = (source << length | target) >> step if name == "SFTR" else target << step | source
    assert string(plc, "M", 10, length) == expected % 2**length
    assert string(plc, "M", 100, step) == source
    assert plc["M9"] == plc[f"M{10 + length}"] == 1


@given(start=st.integers(0, 1), step=st.integers(1, 8))
def test_a_string_that_is_its_own_source_is_read_before_it_is_written(running, start, step):
    plc = running("LD SM0\nSFTL M20 M20 8 D1")
    plc.set({f"M{20 + place}": (place + start) % 2 for place in range(8)} | {"D1": step})
    before = string(plc, "M", 20, 8)
    plc.scan()
    assert string(plc, "M", 20, 8) == (before << step | before % 2**step) % 2**8
