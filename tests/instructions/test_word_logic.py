"""Word logic against Python's operators on unsigned numbers."""

import operator

import pytest
from hypothesis import given
from hypothesis import strategies as st

WIDTHS = [pytest.param("", "WORD", 16, 4, id="16 bits"), pytest.param("D", "DWORD", 32, 8, id="32 bits")]


@pytest.mark.parametrize(("prefix", "kind", "bits", "digits"), WIDTHS)
@pytest.mark.parametrize(("name", "meaning"), [("WAND", operator.and_), ("WOR", operator.or_), ("WXOR", operator.xor)])
@given(data=st.data())
def test_two_words_meet_bit_by_bit(running, name, meaning, prefix, kind, bits, digits, data):
    first, second = data.draw(st.integers(0, 2**bits - 1)), data.draw(st.integers(0, 2**bits - 1))
    plc = running(f"LD SM0\n{prefix}{name} D0 K{digits}M0 D10\n{prefix}{name} D0 K{digits}M0 K{digits}Y0")
    plc.set({f"D0:{kind}": first, f"K{digits}M0:{kind}": second})
    plc.scan()
    assert plc[f"D10:{kind}"] == plc[f"K{digits}Y0:{kind}"] == meaning(first, second)


@pytest.mark.parametrize(("prefix", "kind", "bits", "digits"), WIDTHS)
@given(data=st.data())
def test_every_bit_turns_round(running, prefix, kind, bits, digits, data):
    word = data.draw(st.integers(0, 2**bits - 1))
    plc = running(f"LD SM0\n{prefix}WINV D0 D10")
    plc[f"D0:{kind}"] = word
    plc.scan()
    assert plc[f"D10:{kind}"] == 2**bits - 1 - word


@given(nibble=st.integers(0, 15))
def test_a_short_kn_source_is_filled_up_with_zeros(running, nibble):
    plc = running("LD SM0\nWINV K1M0 D10")
    plc["K1M0"] = nibble
    plc.scan()
    assert plc["D10:WORD"] == 0xFFFF - nibble


def test_logic_leaves_the_flags_alone(running):
    plc = running("LD SM0\nWAND D0 0 D10\nDWXOR D20 D20 D30")
    plc.set({"SM180": 0, "SM181": 1, "SM182": 1})
    plc.scan()
    assert [plc[f"SM{n}"] for n in (180, 181, 182)] == [0, 1, 1]
