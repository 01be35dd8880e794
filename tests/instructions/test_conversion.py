"""Conversions against decimal text, numpy's singles and bytes."""

import math
import struct

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim

OPERAND_ERROR = 64
UNTOUCHED = -321
WORDS, DWORDS = st.integers(0, 0xFFFF), st.integers(0, 0xFFFF_FFFF)
DINTS = st.integers(-(2**31), 2**31 - 1)
SINGLES = st.floats(width=32, allow_nan=False)
FLAGS = ("SM180", "SM181", "SM182")


def converted(plc, value, source, target):
    """D10 after the PLC's one instruction has converted D0."""
    plc.set({"D10": UNTOUCHED, "D11": UNTOUCHED, f"D0:{source}": value})
    plc.scan()
    return plc[f"D10:{target}"]


def refused(plc):
    """Whether the last scan ended in an operand error that left D10 alone."""
    return (plc["D10"], plc["D11"], plc["SM20"], plc["SD20"]) == (UNTOUCHED, UNTOUCHED, 1, OPERAND_ERROR)


# -- whole numbers and reals --------------------------------------------------------------------------------------


@given(number=st.one_of(DINTS, st.integers(-32770, 32770)))
def test_a_long_integer_becomes_an_integer_where_it_fits(running, number):
    plc = running("LD SM0\nDTI D0 D10")
    result = converted(plc, number, "DINT", "INT")
    assert result == number if -32768 <= number <= 32767 else refused(plc)


@given(number=st.integers(-32768, 32767))
def test_an_integer_keeps_its_value_in_32_bits(running, number):
    assert converted(running("LD SM0\nITD D0 D10"), number, "INT", "DINT") == number


@given(number=DINTS)
def test_a_long_integer_becomes_the_nearest_single(running, number):
    assert converted(running("LD SM0\nDFLT D0 D10"), number, "DINT", "REAL") == float(numpy.float32(number))


@given(number=st.integers(-32768, 32767))
def test_an_integer_becomes_the_same_real(running, number):
    assert converted(running("LD SM0\nFLT D0 D10"), number, "INT", "REAL") == number


@pytest.mark.parametrize(("name", "kind", "bits"), [("INT", "INT", 16), ("DINT", "DINT", 32)])
@given(number=st.one_of(SINGLES, st.floats(-70000, 70000, width=32), st.integers(-40000, 40000).map(float)))
def test_a_real_loses_its_fraction_and_is_held_in_range(running, name, kind, bits, number):
    plc = running(f"LD SM0\n{name} D0 D10")
    plc.set(dict.fromkeys(FLAGS, 1))
    result = converted(plc, number, "REAL", kind)
    low, high = -(2 ** (bits - 1)), 2 ** (bits - 1) - 1
    outside = not low <= number <= high
    expected = (high if number > 0 else low) if outside else math.trunc(number)
    assert result == expected
    assert [plc[flag] for flag in FLAGS] == [expected == 0, outside, not outside and expected != number]


@pytest.mark.parametrize("name", ["INT", "DINT"])
def test_what_is_no_number_is_an_operand_error(running, name):
    plc = running(f"LD SM0\n{name} D0 D10")
    plc.set(dict.fromkeys(FLAGS, 1))
    converted(plc, 0x7FC0_0000, "DWORD", "INT")
    assert refused(plc)
    assert [plc[flag] for flag in FLAGS] == [1, 1, 1]


# -- codes --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "kind", "digits"), [("BCD", "WORD", 4), ("DBCD", "DWORD", 8)])
@given(data=st.data())
def test_bcd_spells_the_decimal_digits(running, name, kind, digits, data):
    plc = running(f"LD SM0\n{name} D0 D10")
    number = data.draw(st.integers(0, 10**digits + 10**digits // 10))
    result = converted(plc, number, kind, kind)
    assert f"{result:0{digits}X}" == f"{number:0{digits}d}" if number < 10**digits else refused(plc)


@pytest.mark.parametrize(("name", "kind", "digits"), [("BIN", "WORD", 4), ("DBIN", "DWORD", 8)])
@given(data=st.data())
def test_bin_reads_the_decimal_digits(running, name, kind, digits, data):
    plc = running(f"LD SM0\n{name} D0 D10")
    text = data.draw(st.one_of(st.text("0123456789", min_size=digits, max_size=digits), st.text("09AF", min_size=digits, max_size=digits)))
    result = converted(plc, int(text, 16), kind, kind)
    assert result == int(text) if text.isdecimal() else refused(plc)


@pytest.mark.parametrize(("prefix", "kind", "bits"), [("", "WORD", 16), ("D", "DWORD", 32)])
@given(data=st.data())
def test_neighbours_in_gray_code_differ_in_one_bit_and_the_way_back_leads_home(running, prefix, kind, bits, data):
    there, back = running(f"LD SM0\n{prefix}GRY D0 D10"), running(f"LD SM0\n{prefix}GBIN D0 D10")
    number = data.draw(st.integers(0, 2**bits - 1))
    code, neighbour = converted(there, number, kind, kind), converted(there, (number + 1) % 2**bits, kind, kind)
    assert (code ^ neighbour).bit_count() == 1
    assert converted(back, code, kind, kind) == number


# Which segments light up, drawn: a on top, then clockwise b to f, g in the middle.
DIGITS = "abcdef bc abdeg abcdg bcfg acdfg acdefg abc abcdefg abcdfg abcefg cdefg adef bcdeg adefg aefg".split()


@pytest.mark.parametrize("digit", range(16))
def test_a_digit_lights_its_segments(running, digit):
    pattern = converted(running("LD SM0\nSEG D0 D10"), digit, "WORD", "WORD")
    assert {"abcdefg"[bit] for bit in range(16) if pattern >> bit & 1} == set(DIGITS[digit])


@given(number=st.integers(16, 0xFFFF))
def test_what_is_no_hexadecimal_digit_has_no_segments(running, number):
    plc = running("LD SM0\nSEG D0 D10")
    converted(plc, number, "WORD", "WORD")
    assert refused(plc)


# -- characters ---------------------------------------------------------------------------------------------------

# A comma separates operands; what opens a comment is none of the text.
CHARACTERS = st.text([chr(code) for code in range(0x21, 0x7F) if chr(code) != ","], min_size=1, max_size=8)
TEXTS = CHARACTERS.filter(lambda text: not any(comment in text for comment in ("//", "/*", "(*")))


def words_of(characters, bytewise):
    """Characters as registers hold them."""
    if bytewise:
        return list(characters)
    return [word for (word,) in struct.iter_unpack("<H", characters + bytes(len(characters) % 2))]


def registers(plc, first, count):
    """Registers without sign."""
    return [plc[f"D{number}:WORD"] for number in range(first, first + count)]


@given(text=TEXTS, bytewise=st.booleans())
def test_characters_are_stored_as_they_are_typed(text, bytewise):
    plc = ecsim.Plc("EC10")
    plc.load(f"LD SM0\nASC {text} D10")
    plc.run()
    expected = words_of(text.encode().ljust(8, b"\0"), bytewise)
    plc.set({"SM186": bytewise, **{f"D{number}": UNTOUCHED for number in range(10, 20)}})
    plc.scan()
    assert registers(plc, 10, len(expected) + 1) == [*expected, UNTOUCHED & 0xFFFF]


@pytest.mark.parametrize(("text", "why"), [("123456789", "9 characters; S takes 8 at most"), ("12ü", "'ü' is no character of ASCII")])
def test_what_cannot_be_stored_is_refused(text, why):
    with pytest.raises(ecsim.ProgramError, match=why):
        ecsim.compile(f"LD SM0\nASC {text} D0", "EC10")


@given(words=st.lists(WORDS, min_size=1, max_size=12), data=st.data(), bytewise=st.booleans())
def test_hexadecimal_digits_become_characters_and_back(running, words, data, bytewise):
    count = data.draw(st.integers(4 * len(words) - 3, 4 * len(words)))
    plc = running("LD SM0\nITA D100 D200 D50\nATI D200 D300 D50", "EC10")
    plc.set({"SM186": bytewise, "D50": count} | {f"D{100 + place}:WORD": word for place, word in enumerate(words)})
    plc.set(dict.fromkeys((f"D{number}" for number in [*range(200, 250), *range(300, 314)]), UNTOUCHED))
    plc.scan()
    digits = "".join(f"{word:04X}" for word in words)[:count]
    expected = words_of(digits.encode(), bytewise)
    assert registers(plc, 200, len(expected) + 1) == [*expected, UNTOUCHED & 0xFFFF]
    back = [int(digits[place : place + 4].ljust(4, "0"), 16) for place in range(0, count, 4)]
    assert registers(plc, 300, len(back) + 1) == [*back, UNTOUCHED & 0xFFFF]
    assert plc["SD20"] == 0


@given(word=WORDS, count=st.integers(1, 300), bytewise=st.booleans())
def test_a_constant_gives_what_it_holds_whatever_the_count(word, count, bytewise):
    plc = ecsim.Plc("EC10")
    plc.load(f"LD SM0\nITA 16#{word:X} D200 {count}\nMOV 16#3146 D0\nATI 16#3146 D300 {count}")
    plc.run()
    plc.set({"SM186": bytewise, "D204": UNTOUCHED, "D301": UNTOUCHED})
    plc.scan()
    expected = words_of(f"{word:04X}"[:count].encode(), bytewise)
    assert registers(plc, 200, len(expected)) == expected
    assert plc["D300:WORD"] == (0xF000 if bytewise or count == 1 else 0xF100)
    assert (plc["D204"], plc["D301"], plc["SD20"]) == (UNTOUCHED, UNTOUCHED, 0)


@pytest.mark.parametrize("count", [0, 257, 32767, -1])
@pytest.mark.parametrize("name", ["ITA", "ATI"])
def test_a_count_outside_1_to_256_is_an_operand_error(running, name, count):
    plc = running(f"LD SM0\n{name} D0 D10 D50", "EC10")
    plc.set({"D0:WORD": 0x3030, "D10": UNTOUCHED, "D11": UNTOUCHED, "D50": count})
    plc.scan()
    assert refused(plc)


@pytest.mark.parametrize(("source", "count"), [("D0", "257"), ("D0", "0"), ("16#3030", "0")])
@pytest.mark.parametrize("name", ["ITA", "ATI"])
def test_a_constant_count_outside_its_range_is_refused(name, source, count):
    with pytest.raises(ecsim.ProgramError, match=f"S2 = {count} is out of range"):
        ecsim.compile(f"LD SM0\n{name} {source} D10 {count}", "EC10")


@pytest.mark.parametrize(
    ("line", "why"),
    [("DTI 32768 D0", "S goes from -32768 to 32767"), ("BCD 10000 D0", "S goes from 0 to 9999"), ("SEG 16 D0", "S goes from 0 to 15")],
)
def test_a_constant_outside_its_range_is_refused(line, why):
    with pytest.raises(ecsim.ProgramError, match=why):
        ecsim.compile(f"LD SM0\n{line}", "EC20")


def test_a_constant_in_base_16_is_held_against_the_range_with_its_sign(running):
    plc = running("LD SM0\nDTI 16#FFFF8000 D10")
    plc.scan()
    assert plc["D10"] == -32768
