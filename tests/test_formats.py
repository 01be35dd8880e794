"""How values are written and read back."""

import pytest

from ecsim import EcsimError
from ecsim.formats import FORMATS, usual
from ecsim.values import BOOL, DINT, DWORD, INT, REAL, WORD

# (format, type, what is typed, the value)
READ = [
    ("decimal", INT, "4000", 4000),
    ("decimal", INT, "16#0FA0", 4000),  # a mark decides, whatever the format
    ("decimal", INT, "1,234", 1234),
    ("decimal", INT, "\N{MINUS SIGN}5", -5),
    ("decimal", INT, "65535", -1),  # unsigned numbers of the width fit, too
    ("decimal", WORD, "-1", 65535),
    ("hex", INT, "10", 16),
    ("hex", INT, "FFFF", -1),
    ("hex", DWORD, "16#FFFFFFFF", 4294967295),
    ("binary", INT, "2#0000 1111 1010 0000", 4000),
    ("binary", BOOL, "1", 1),
    ("octal", INT, "17", 15),
    ("decimal", DINT, "-2147483648", -2147483648),
    ("float", REAL, "-12.5", -12.5),
    ("float", DINT, "1", 0x3F800000),  # IEEE 754: 1.0
    ("text", INT, "AB", 0x4241),  # the first character in the low byte
    ("text", INT, "'A'", 0x41),
    ("text", DINT, "'AB42'", 0x42413234),  # the first register is the high word
]


@pytest.mark.parametrize(("name", "kind", "typed", "value"), READ)
def test_what_is_typed_becomes_a_value(name, kind, typed, value):
    assert FORMATS[name].read(typed, kind) == value


@pytest.mark.parametrize(
    ("name", "kind", "typed", "words"),
    [
        ("decimal", INT, "70000", "-32768 to 65535"),
        ("decimal", INT, "", "whole number"),
        ("decimal", INT, "1.5", "float"),
        ("decimal", INT, "1,5", "float"),  # a comma is no decimal point, and not to be passed over
        ("decimal", INT, "2#12", "base 2"),
        ("hex", INT, "G", "base 16"),
        ("octal", INT, "8", "base 8"),
        ("binary", BOOL, "2", "base 2"),
        ("decimal", BOOL, "2", "one bit"),
        ("float", REAL, "1e39", "does not fit"),
        ("float", REAL, "fast", "no number"),
        ("text", INT, "ABC", "2 ASCII"),
        ("text", INT, "ü", "2 ASCII"),
    ],
)
def test_what_cannot_be_read_is_refused_in_words(name, kind, typed, words):
    with pytest.raises(EcsimError, match=words):
        FORMATS[name].read(typed, kind)


@pytest.mark.parametrize("kind", [BOOL, INT, WORD, DINT, DWORD])
@pytest.mark.parametrize("value", [0, 1, 17, 4000, -1, -32768])
def test_what_a_format_writes_it_reads_back(kind, value):
    value = value & 1 if kind is BOOL else value & kind.high if not kind.signed else value
    for name, way in FORMATS.items():
        if way.suits(kind) and name not in ("float", "text"):
            assert way.read(way.text(value, kind), kind) == value


def test_the_usual_format_of_a_type():
    assert [usual(kind) for kind in (BOOL, INT, DWORD, REAL)] == ["binary", "decimal", "decimal", "float"]
