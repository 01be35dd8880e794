"""Integer arithmetic against Python's whole numbers, whose width has no end."""

import math
import operator

import pytest
from hypothesis import given
from hypothesis import strategies as st

UNTOUCHED = -321
ZERO, CARRY, BORROW = FLAGS = ("SM180", "SM181", "SM182")
WIDTHS = [pytest.param("", "INT", 16, id="16 bits"), pytest.param("D", "DINT", 32, id="32 bits")]


def numbers(bits):
    """Numbers of a width, those at its ends and around zero more often."""
    low, high = -(2 ** (bits - 1)), 2 ** (bits - 1) - 1
    return st.one_of(st.integers(low, high), st.integers(low, low + 3), st.integers(high - 3, high), st.integers(-3, 3))


def wrapped(number, bits):
    """The low bits of a number in two's complement."""
    return (number + 2 ** (bits - 1)) % 2**bits - 2 ** (bits - 1)


def flags(plc):
    return tuple(plc[name] for name in FLAGS)


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
@pytest.mark.parametrize(("name", "meaning"), [("ADD", operator.add), ("SUB", operator.sub)])
@given(data=st.data())
def test_a_sum_or_difference_wraps_and_tells_zero_carry_and_borrow(running, name, meaning, prefix, kind, bits, data):
    first, second = data.draw(numbers(bits)), data.draw(numbers(bits))
    plc = running(f"LD SM0\n{prefix}{name} D0 D2 D10")
    plc.set({f"D0:{kind}": first, f"D2:{kind}": second})
    plc.scan()
    exact = meaning(first, second)
    assert plc[f"D10:{kind}"] == wrapped(exact, bits)
    assert flags(plc) == (exact == 0, exact >= 2 ** (bits - 1), exact < -(2 ** (bits - 1)))


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
@given(data=st.data())
def test_a_product_has_32_bits_and_no_flags(running, prefix, kind, bits, data):
    first, second = data.draw(numbers(bits)), data.draw(numbers(bits))
    before = data.draw(st.tuples(*[st.integers(0, 1)] * 3))
    plc = running(f"LD SM0\n{prefix}MUL D0 D2 D10")
    plc.set({f"D0:{kind}": first, f"D2:{kind}": second, **dict(zip(FLAGS, before, strict=True))})
    plc.scan()
    assert plc["D10:DINT"] == wrapped(first * second, 32)
    assert flags(plc) == before


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
@given(data=st.data())
def test_quotient_and_remainder_make_up_the_dividend(running, prefix, kind, bits, data):
    dividend, divisor = data.draw(numbers(bits)), data.draw(numbers(bits).filter(bool))
    plc = running(f"LD SM0\n{prefix}DIV D0 D2 D10")
    plc.set({f"D0:{kind}": dividend, f"D2:{kind}": divisor})
    plc.scan()
    quotient, remainder = plc[f"D10:{kind}"], plc["D11" if bits == 16 else "D12:DINT"]
    exact = abs(dividend) // abs(divisor) * (1 if (dividend < 0) == (divisor < 0) else -1)  # toward zero
    assert quotient == wrapped(exact, bits)
    assert plc[CARRY] == (exact != quotient)
    assert remainder == dividend - exact * divisor
    assert abs(remainder) < abs(divisor)
    assert remainder == 0 or (remainder < 0) == (dividend < 0)


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
def test_a_division_by_zero_is_error_69_and_writes_nothing(running, prefix, kind, bits):
    plc = running(f"LD SM0\n{prefix}DIV D0 D2 D10")
    plc.set({f"D0:{kind}": 7, f"D2:{kind}": 0, **{f"D1{n}": UNTOUCHED for n in range(4)}})
    plc.scan()
    assert (plc["SD20"], plc["SM20"]) == (69, 1)
    assert [plc[f"D1{n}"] for n in range(4)] == [UNTOUCHED] * 4


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
@given(data=st.data())
def test_a_root_is_cut_and_borrow_tells_of_the_rest(running, prefix, kind, bits, data):
    number = data.draw(st.one_of(numbers(bits), st.integers(0, math.isqrt(2 ** (bits - 1) - 1)).map(lambda root: root * root)))
    plc = running(f"LD SM0\n{prefix}SQT D0 D10")
    plc.set({f"D0:{kind}": number, f"D10:{kind}": UNTOUCHED})
    plc.scan()
    if number < 0:
        assert (plc["SD20"], plc["SM20"], plc[f"D10:{kind}"]) == (64, 1, UNTOUCHED)
    else:
        root = plc[f"D10:{kind}"]
        assert root**2 <= number < (root + 1) ** 2
        assert (plc[ZERO], plc[BORROW]) == (root == 0, root**2 != number)


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
@pytest.mark.parametrize(("name", "step"), [("INC", 1), ("DEC", -1)])
@given(data=st.data())
def test_counting_goes_round(running, name, step, prefix, kind, bits, data):
    number = data.draw(numbers(bits))
    plc = running(f"LD SM0\n{prefix}{name} D0")
    plc[f"D0:{kind}"] = number
    plc.scan()
    assert plc[f"D0:{kind}"] == wrapped(number + step, bits)


@pytest.mark.parametrize(("prefix", "kind", "bits"), WIDTHS)
@pytest.mark.parametrize(("name", "meaning"), [("VABS", abs), ("NEG", operator.neg)])
@given(data=st.data())
def test_the_smallest_number_has_no_counterpart(running, name, meaning, prefix, kind, bits, data):
    number = data.draw(numbers(bits))
    plc = running(f"LD SM0\n{prefix}{name} D0 D10")
    plc.set({f"D0:{kind}": number, f"D10:{kind}": UNTOUCHED})
    plc.scan()
    if number == -(2 ** (bits - 1)):
        assert (plc["SD20"], plc["SM20"], plc[f"D10:{kind}"]) == (64, 1, UNTOUCHED)
    else:
        assert (plc["SM20"], plc[f"D10:{kind}"]) == (0, meaning(number))


@given(values=st.lists(numbers(16), max_size=255))
def test_a_sum_of_integers_needs_no_more_than_32_bits(running, values):
    plc = running("LD SM0\nSUM D1000 D0 D10")
    plc.set({"D0": len(values), **{f"D{1000 + place}": value for place, value in enumerate(values)}})
    plc.set(dict.fromkeys(FLAGS, 1))
    plc.scan()
    assert plc["D10:DINT"] == sum(values)
    assert flags(plc) == (sum(values) == 0, 0, 0)


@given(values=st.lists(numbers(32), max_size=255))
def test_a_sum_of_long_integers_wraps(running, values):
    plc = running("LD SM0\nDSUM D1000 D0 D10")
    plc.set({"D0": len(values), **{f"D{1000 + 2 * place}:DINT": value for place, value in enumerate(values)}})
    plc.scan()
    assert plc["D10:DINT"] == wrapped(sum(values), 32)
    assert plc[ZERO] == (sum(values) == 0)


@given(first=numbers(16), bits=st.integers(0, 0xFFFF))
def test_a_kn_string_counts_like_the_register_with_the_same_bits(running, first, bits):
    plc = running("LD SM0\nADD D0 K4M0 D10\nADD D0 D1 D11\nMOV D10 K4Y0")
    plc.set({"D0": first, "D1:WORD": bits, "K4M0:WORD": bits})
    plc.scan()
    assert plc["D10"] == plc["D11"] == plc["K4Y0"]
