"""Bit instructions against Python's own text of a number in base 2."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim

OPERAND_ERROR = 64
WORDS = st.integers(0, 0xFFFF)


def written(plc, word, kind="WORD"):
    """D10 after the PLC's one instruction has worked on D0."""
    plc.set({f"D0:{kind}": word, "D10": -321})
    plc.scan()
    return plc["D10:WORD"]


@given(word=WORDS)
def test_deco_sets_one_bit_of_sixteen(running, word):
    plc = running("LD SM0\nDECO D0 D10")
    result = written(plc, word)
    if word < 16:
        assert f"{result:016b}" == "1".rjust(16 - word, "0").ljust(16, "0")
    else:
        assert (plc["D10"], plc["SM20"], plc["SD20"]) == (-321, 1, OPERAND_ERROR)


@given(word=WORDS)
def test_enco_finds_the_lowest_bit(running, word):
    plc = running("LD SM0\nENCO D0 D10")
    result = written(plc, word)
    if word:
        assert result == f"{word:016b}"[::-1].index("1")
    else:
        assert (plc["D10"], plc["SM20"], plc["SD20"]) == (-321, 1, OPERAND_ERROR)


@given(word=WORDS, wide=st.integers(0, 0xFFFF_FFFF))
def test_bits_are_counted(running, word, wide):
    assert written(running("LD SM0\nBITS D0 D10"), word) == f"{word:b}".count("1")
    assert written(running("LD SM0\nDBITS D0 D10"), wide, "DWORD") == f"{wide:b}".count("1")


@pytest.mark.parametrize("name", ["ZSET", "ZRST"])
@given(pattern=st.integers(0, 0xFFFFF), first=st.integers(0, 19), data=st.data())
def test_a_run_is_set_or_cleared_and_nothing_beside_it(running, name, pattern, first, data):
    count = data.draw(st.integers(0, 20 - first))
    plc = running(f"LD SM0\n{name} M0Z0 D0")
    plc.set({f"M{place}": pattern >> place & 1 for place in range(20)} | {"Z0": first, "D0": count})
    plc.scan()
    run = range(first, first + count)
    assert [plc[f"M{place}"] for place in range(20)] == [name == "ZSET" if place in run else pattern >> place & 1 for place in range(20)]


@pytest.mark.parametrize("name", ["ZSET", "ZRST"])
def test_a_run_of_fewer_than_no_bits_is_an_operand_error(running, name):
    plc = running(f"LD SM0\n{name} M0 D0")
    plc.set({"M0": 1, "D0": -1})
    plc.scan()
    assert (plc["M0"], plc["SD20"]) == (1, OPERAND_ERROR)


def test_zset_leaves_the_values_of_timers_and_counters(running):
    plc = running("LD X0\nZSET T0 2\nZSET C0 2\nLD X1\nZRST T0 2\nZRST C0 2")
    plc.set({"X0": 1, "X1": 0, "T0": 5, "C1": 7})
    plc.scan()
    assert [plc[name] for name in ("T0", "T0:BOOL", "T1:BOOL", "C1", "C0:BOOL", "C1:BOOL")] == [5, 1, 1, 7, 1, 1]
    plc.set({"X0": 0, "X1": 1})
    plc.scan()
    assert [plc[name] for name in ("T0", "T0:BOOL", "T1:BOOL", "C1", "C0:BOOL", "C1:BOOL")] == [0] * 6


@pytest.mark.parametrize("line", ["DECO 2 K4SM0", "BITS D0 K2SM16", "DBITS D0 K4SM182"])
def test_relays_that_only_the_system_writes_are_refused_as_part_of_a_string(line):
    with pytest.raises(ecsim.ProgramError, match="is read only"):
        ecsim.compile(f"LD SM0\n{line}", "EC20")
