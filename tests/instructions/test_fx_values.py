"""Instructions of H2U on values against Python's own arithmetic: sums, products, rotations, queues, digits, characters."""

import math
import struct
from collections import deque
from datetime import timedelta
from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

ON = "LD M8000\n"
CORNERS = (0, 1, -1, 32767, -32768, 65535, 65536, 2147483647, -2147483648)
SHORT = st.sampled_from([n for n in CORNERS if -32768 <= n <= 32767]) | st.integers(-32768, 32767)
LONG = st.sampled_from(CORNERS) | st.integers(-2147483648, 2147483647)
WIDTHS = {"": (SHORT, 16, "INT"), "D": (LONG, 32, "DINT")}
QUICK = settings(max_examples=20)
both_widths = pytest.mark.parametrize("wide", ["", "D"])


def low_word_first(plc, first, count):
    """Registers from D(first) on as one number without sign."""
    return sum((plc[f"D{first + place}"] & 0xFFFF) << 16 * place for place in range(count))


def signed(number, bits):
    """A number of so many bits as two's complement."""
    return number - (1 << bits) if number >> bits - 1 & 1 else number


# -- sums --------------------------------------------------------------------------------------------------------------


def restarted(exact, bits):
    """A sum as FNC 20 stores it: beyond a limit it goes on from 0 with the sign of the limit."""
    top = 2 ** (bits - 1) - 1
    if exact > top:
        return exact - top - 1
    return exact + top + 2 if exact < -top - 1 else exact


@both_widths
@pytest.mark.parametrize("name", ["ADD", "SUB"])
@QUICK
@given(data=st.data())
def test_a_sum_and_its_flags(running, wide, name, data):
    numbers, bits, kind = WIDTHS[wide]
    first, second = data.draw(numbers), data.draw(numbers)
    plc = running(f"{ON}{wide}{name} D0 D2 D4", "H2U")
    plc.set({f"D0:{kind}": first, f"D2:{kind}": second})
    plc.scan()
    exact = first + second if name == "ADD" else first - second
    stored = restarted(exact, bits)
    assert plc[f"D4:{kind}"] == stored
    half = 2 ** (bits - 1)
    assert [plc["M8020"], plc["M8021"], plc["M8022"]] == [stored == 0, exact < -half, exact >= half]


@both_widths
@QUICK
@given(data=st.data())
def test_a_product_has_twice_the_width(running, wide, data):
    numbers, bits, kind = WIDTHS[wide]
    first, second = data.draw(numbers), data.draw(numbers)
    plc = running(f"{ON}{wide}MUL D0 D2 D4", "H2U")
    plc.set({f"D0:{kind}": first, f"D2:{kind}": second})
    plc.scan()
    assert signed(low_word_first(plc, 4, bits // 8), 2 * bits) == first * second


@both_widths
@QUICK
@given(data=st.data())
def test_quotient_times_divisor_and_remainder_are_the_dividend(running, wide, data):
    numbers, bits, kind = WIDTHS[wide]
    first, second = data.draw(numbers), data.draw(numbers.filter(bool))
    plc = running(f"{ON}{wide}DIV D0 D2 D4", "H2U")
    plc.set({f"D0:{kind}": first, f"D2:{kind}": second})
    plc.scan()
    quotient, remainder = plc[f"D4:{kind}"], plc[f"D{4 + bits // 16}:{kind}"]
    if (first, second) == (-(2 ** (bits - 1)), -1):
        assert (quotient, remainder) == (first, 0)
    else:
        assert quotient * second + remainder == first
        assert abs(remainder) < abs(second)
        assert remainder * first >= 0


@both_widths
@QUICK
@given(data=st.data())
def test_turned_over_twice_a_number_is_itself(running, wide, data):
    numbers, bits, kind = WIDTHS[wide]
    number = data.draw(numbers)
    plc = running(f"{ON}{wide}NEG D0", "H2U")
    plc.set({f"D0:{kind}": number})
    plc.scan()
    assert (plc[f"D0:{kind}"] + number) % 2**bits == 0
    plc.scan()
    assert plc[f"D0:{kind}"] == number


@both_widths
@QUICK
@given(data=st.data())
def test_the_mean_lies_beside_the_exact_one(running, wide, data):
    numbers, _, kind = WIDTHS[wide]
    values = data.draw(st.lists(numbers, min_size=5, max_size=5))
    plc = running(f"{ON}{wide}MEAN D0 D20 K5", "H2U")
    plc.set({f"D{place * (2 if wide else 1)}:{kind}": value for place, value in enumerate(values)})
    plc.scan()
    assert plc[f"D20:{kind}"] == math.trunc(Decimal(sum(values)) / 5)


# -- comparing ---------------------------------------------------------------------------------------------------------


@both_widths
@QUICK
@given(data=st.data())
def test_one_of_three_bits_tells_how_two_numbers_compare(running, wide, data):
    numbers, _, kind = WIDTHS[wide]
    low, high, number = data.draw(numbers), data.draw(numbers), data.draw(numbers)
    plc = running(f"{ON}{wide}CMP D0 D2 M0\n{wide}ZCP D0 D2 D4 M10", "H2U")
    plc.set({f"D0:{kind}": low, f"D2:{kind}": high, f"D4:{kind}": number})
    plc.scan()
    assert [plc[f"M{n}"] for n in range(3)].index(1) == [low > high, low == high, low < high].index(True)
    assert sum(plc[f"M{n}"] for n in range(3)) == 1
    high = max(low, high)
    assert [plc[f"M{n}"] for n in (10, 11, 12)] == [number < low, low <= number <= high, number > high]


# -- rotating, queues ----------------------------------------------------------------------------------------------------


@both_widths
@pytest.mark.parametrize("name", ["ROR", "ROL", "RCR", "RCL"])
@pytest.mark.parametrize("count", [1, 13])
@QUICK
@given(data=st.data())
def test_a_word_turns_in_place(running, wide, name, count, data):
    numbers, bits, kind = WIDTHS[wide]
    number, carry = data.draw(numbers), data.draw(st.integers(0, 1))
    plc = running(f"{ON}{wide}{name} D0 K{count}", "H2U")
    plc.set({f"D0:{kind}": number, "M8022": carry})
    ring = deque(number >> place & 1 for place in range(bits))
    steps = -1 if name.endswith("R") else 1
    if name.startswith("RC"):
        ring.append(carry)
        ring.rotate(steps * count)
        carry = ring.pop()
    else:
        ring.rotate(steps * count)
        carry = ring[-1] if name == "ROR" else ring[0]
    plc.scan()
    assert plc[f"D0:{kind}"] == signed(sum(bit << place for place, bit in enumerate(ring)), bits)
    assert plc["M8022"] == carry


@QUICK
@given(st.lists(st.one_of(st.none(), SHORT), max_size=30))
def test_a_queue_gives_what_went_in_first(running, actions):
    plc = running("LD X0\nSFWRP D0 D10 K5\nLD X1\nSFRDP D10 D1 K5", "H2U")
    plc.set({f"D{n}": 0 for n in range(20)})
    queue = deque()
    for number in actions:
        plc.set({"X0": 0, "X1": 0})
        plc.scan()
        plc.set({"X1": 1} if number is None else {"X0": 1, "D0": number})
        plc.scan()
        if number is not None:
            assert plc["M8022"] == (len(queue) == 4)
            if len(queue) < 4:
                queue.append(number)
        else:
            assert plc["M8020"] == (not queue)
            if queue:
                assert plc["D1"] == queue.popleft()
        assert plc["D10"] == len(queue)
        assert [plc[f"D{11 + place}"] for place in range(len(queue))] == list(queue)


# -- bits ------------------------------------------------------------------------------------------------------------------


@QUICK
@given(st.integers(0, 2**16 - 1), st.integers(0, 15))
def test_bits_are_counted_found_and_set(running, word, number):
    plc = running(f"{ON}SUM D0 D1\nBON D0 M0 K7\nDECO D2 D3 K4\nDECO D2 M20 K4\nENCO D3 D4 K4\nENCO M20 D5 K4", "H2U")
    plc.set({"D0:WORD": word, "D2": number})
    plc.scan()
    assert [plc["D1"], plc["M0"]] == [word.bit_count(), word >> 7 & 1]
    assert plc["D3:WORD"] == 2**number
    assert [plc[f"M{20 + place}"] for place in range(16)] == [place == number for place in range(16)]
    assert [plc["D4"], plc["D5"]] == [number, number]


@QUICK
@given(st.integers(1, 2**16 - 1))
def test_the_highest_bit_counts(running, word):
    plc = running(f"{ON}ENCO D0 D1 K4", "H2U")
    plc.set({"D0:WORD": word})
    plc.scan()
    assert plc["D1"] == math.floor(math.log2(word))


# -- digits and characters ---------------------------------------------------------------------------------------------------


@QUICK
@given(st.integers(0, 9999), st.integers(0, 99999999))
def test_bcd_and_back(running, short, wide):
    plc = running(f"{ON}BCD D0 D1\nBIN D1 D2\nDBCD D10 D12\nDBIN D12 D14", "H2U")
    plc.set({"D0": short, "D10:DINT": wide})
    plc.scan()
    assert [f"{plc['D1:WORD']:X}", f"{plc['D12:DWORD']:X}"] == [str(short), str(wide)]
    assert [plc["D2"], plc["D14:DINT"]] == [short, wide]


@QUICK
@given(st.data(), st.integers(1, 4), st.integers(0, 9999), st.integers(0, 9999))
def test_digits_move_as_in_a_text(running, data, digit, source, target):
    count = data.draw(st.integers(1, digit))
    place = data.draw(st.integers(count, 4))
    plc = running(f"{ON}SMOV D0 K{digit} K{count} D1 K{place}", "H2U")
    plc.set({"D0": source, "D1": target})
    plc.scan()
    old, new = f"{source:04}", list(f"{target:04}")
    new[4 - place : 4 - place + count] = old[4 - digit : 4 - digit + count]
    assert plc["D1"] == int("".join(new))


@pytest.mark.parametrize("bytewise", [0, 1])
@QUICK
@given(st.integers(0, 2**48 - 1), st.integers(1, 12))
def test_characters_of_digits_and_back(running, bytewise, number, count):
    plc = running(f"{ON}ASCI D0 D10 D8\nHEX D10 D40 D8\nCCD D10 D50 D8", "H2U")
    plc.set({f"D{n}": 0 for n in range(10, 60)} | {"M8161": bytewise, "D8": count})
    plc.set({f"D{place}:WORD": number >> 16 * place & 0xFFFF for place in range(3)})
    plc.scan()
    text = f"{number:012X}"[-count:].encode()
    if bytewise:
        words = [plc[f"D{10 + place}"] for place in range(count)]
    else:
        words = list(struct.pack(f"<{-(-count // 2)}H", *(plc[f"D{10 + place}:WORD"] for place in range(-(-count // 2)))))[:count]
    assert bytes(words) == text
    assert low_word_first(plc, 40, 3) == int(text, 16)
    parity = 0
    for octet in text:
        parity ^= octet
    assert [plc["D50"], plc["D51"]] == [sum(text), parity]


@QUICK
@given(st.integers(1000, 9999), st.sampled_from([1, -1]), st.integers(-40, 34))
def test_a_mantissa_and_its_exponent_come_back_within_a_digit(running, mantissa, sign, exponent):
    plc = running(f"{ON}DEBIN D0 D2\nDEBCD D2 D4", "H2U")
    plc.set({"D0": sign * mantissa, "D1": exponent})
    plc.scan()
    assert plc["D2:REAL"] == struct.unpack("<f", struct.pack("<f", sign * float(f"{mantissa}e{exponent}")))[0]
    found = Decimal(plc["D4"]).scaleb(plc["D5"])
    exact = Decimal(plc["D2:REAL"])
    assert abs(found) <= abs(exact) < abs(found) + Decimal(1).scaleb(plc["D5"])
    assert 1000 <= abs(plc["D4"]) <= 9999
    assert plc["D4"] * sign > 0


# -- times --------------------------------------------------------------------------------------------------------------------

TIME = st.tuples(st.integers(0, 23), st.integers(0, 59), st.integers(0, 59))
DAY = timedelta(days=1)


def length(time):
    """A time of day as the time since midnight."""
    return timedelta(hours=time[0], minutes=time[1], seconds=time[2])


@QUICK
@given(TIME, TIME)
def test_times_add_subtract_and_compare(running, first, second):
    plc = running(f"{ON}TADD D0 D3 D10\nOUT M0\nLD M8022\nOUT M1\n{ON}TSUB D0 D3 D13\nLD M8021\nOUT M2\n{ON}TCMP D0 D1 D2 D3 M10", "H2U")
    plc.set({f"D{n}": value for n, value in enumerate((*first, *second))})
    plc.scan()
    total, difference = length(first) + length(second), length(first) - length(second)
    assert length([plc[f"D{n}"] for n in (10, 11, 12)]) == total % DAY
    assert length([plc[f"D{n}"] for n in (13, 14, 15)]) == difference % DAY
    assert [plc["M1"], plc["M2"]] == [total >= DAY, difference < timedelta(0)]
    assert [plc[f"M{n}"] for n in (10, 11, 12)] == [first > second, first == second, first < second]


# -- potentiometers --------------------------------------------------------------------------------------------------


def test_vrsc_takes_the_nearest_of_eleven_marks(running):
    plc = running(f"{ON}VRSC K7 D0\nVRRD K7 D1", "H2U")
    plc.pots.values = [0] * 8  # the base unit has none of its own
    for stands in range(256):
        plc.pots[7] = stands
        plc.scan()
        assert (plc["D0"], plc["D1"]) == (min(range(11), key=lambda mark: abs(mark * 255 - stands * 10)), stands)
