"""Pairs of registers in compiled programs: compared word by word, given whole numbers as singles, cleared of an error once."""

import operator
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim
from ecsim.values import singles

RELATIONS = {"=": operator.eq, "<>": operator.ne, "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
SPECIAL = [
    "00000000",
    "80000000",
    "7f800000",
    "ff800000",
    "7fc00000",
    "ff800001",
    "00000001",
    "80000001",
    "7f7fffff",
    "3f800000",
    "3f80ffff",
]
PATTERNS = st.one_of(
    st.binary(min_size=4, max_size=4),
    st.sampled_from([bytes.fromhex(digits) for digits in SPECIAL]),
    st.floats(width=32).map(lambda number: struct.pack(">f", number)),
)
COUPLES = st.one_of(
    st.tuples(PATTERNS, PATTERNS),
    PATTERNS.map(lambda pattern: (pattern, pattern)),
    st.tuples(PATTERNS, PATTERNS).map(lambda couple: (couple[0], couple[0][:2] + couple[1][2:])),  # the high words agree
)


def ready(text):
    plc = ecsim.Plc("EC20")
    plc.load(text)
    plc.run()
    return plc


def put(plc, first, pattern):
    high, low = struct.unpack(">hh", pattern)
    plc.set({f"D{first}": high, f"D{first + 1}": low})


@pytest.fixture(scope="module")
def comparing():
    """Every comparison of D0 with D2 into its own relay: DINT from M0 on, REAL from M10 on."""
    rungs = [f"LD{kind}{sign} D0 D2\nOUT M{first + place}" for kind, first in (("D", 0), ("R", 10)) for place, sign in enumerate(RELATIONS)]
    return ready("\n".join(rungs))


@given(couple=COUPLES)
def test_registers_compare_as_the_numbers_that_they_are(comparing, couple):
    for place, pattern in enumerate(couple):
        put(comparing, 2 * place, pattern)
    comparing.scan()
    for kind, first in (("i", 0), ("f", 10)):
        numbers = [struct.unpack(f">{kind}", pattern)[0] for pattern in couple]
        expected = [int(relation(*numbers)) for relation in RELATIONS.values()]
        assert [comparing[f"M{first + place}"] for place in range(len(RELATIONS))] == expected


@pytest.mark.parametrize(
    ("kind", "code", "constant"), [("D", "i", 65536), ("D", "i", -1), ("D", "i", 0), ("R", "f", 12.5), ("R", "f", -12.5), ("R", "f", 0)]
)
def test_a_pair_compares_with_a_constant_on_either_side(kind, code, constant):
    rungs = [
        f"LD{kind}{sign} {sides}\nOUT M{first + place}"
        for first, sides in ((0, f"D0 {constant}"), (10, f"{constant} D0"))
        for place, sign in enumerate(RELATIONS)
    ]
    plc = ready("\n".join(rungs))
    near = [struct.pack(f">{code}", constant + step) for step in (-65536, -1, 0, 1, 65536)]
    for pattern in [*near, *map(bytes.fromhex, SPECIAL)]:
        put(plc, 0, pattern)
        plc.scan()
        (number,) = struct.unpack(f">{code}", pattern)
        assert [plc[f"M{place}"] for place in range(6)] == [int(relation(number, constant)) for relation in RELATIONS.values()]
        assert [plc[f"M{10 + place}"] for place in range(6)] == [int(relation(constant, number)) for relation in RELATIONS.values()]


def test_every_16_bit_integer_is_its_single():
    for number in range(-0x8000, 0x8000):
        high, low, value = singles()[number]
        assert struct.pack(">hh", high, low) == struct.pack(">f", number)
        assert (value, type(value)) == (number, float)


@pytest.mark.parametrize("number", [0, 1, -1, 255, 32767, -32768])
def test_flt_hands_on_a_float_and_no_integer(number):
    plc = ready("LD SM0\nFLT D0 D2\nRMUL D2 -0.5 D4\nFLT D0 D6\nRNEG D6 D8")
    plc["D0"] = number
    plc.scan()
    expected = [struct.unpack(">hh", struct.pack(">f", value)) for value in (number, float(number) * -0.5, number, -float(number))]
    assert [plc[f"D{place}"] for place in range(2, 10)] == [word for pair in expected for word in pair]


WELL, ILL = "MOV 1 D1", "BCD D10 D11"  # D10 = 10000 has no four digits (6.5.7)


@pytest.mark.parametrize(
    ("chain", "left"),
    [((WELL, ILL), 1), ((ILL, WELL), 0), ((WELL, ILL, WELL), 0), ((ILL, WELL, ILL), 1), ((WELL, WELL, ILL), 1), ((ILL, WELL, WELL), 0)],
)
def test_an_execution_error_stands_until_the_next_correct_instruction(chain, left):
    """2.4.2: SM20 is about the application instruction that was executed last."""
    plc = ready("\n".join(["LD M0", *chain]))
    plc.set({"D10": 10000, "M0": 1})
    plc.scan(2)
    assert (plc["SM20"], plc["SD20"]) == (left, 64)
