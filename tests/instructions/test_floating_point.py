"""REAL arithmetic against numpy's singles."""

import math
import operator

import numpy
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

SINGLES = st.floats(width=32)
FINITE = st.floats(width=32, allow_nan=False, allow_infinity=False)
LIMIT = 2.0**127  # 1.701412E+38
UNTOUCHED = -2.5
ZERO, CARRY = "SM180", "SM181"


def words(plc, first):
    return plc[f"D{first}:WORD"], plc[f"D{first + 1}:WORD"]


def single_words(number):
    """High and low word of a single, by numpy."""
    raw = int(numpy.float32(number).view(numpy.uint32))
    return raw >> 16, raw & 0xFFFF


def same(plc, number):
    """Whether D10 holds the single nearest to a number, bit for bit; any quiet pattern will do for what is no number."""
    return math.isnan(plc["D10:REAL"]) if math.isnan(number) else words(plc, 10) == single_words(number)


def computed(plc, **operands):
    plc.set({"D10:REAL": UNTOUCHED, **{f"{name}:REAL": value for name, value in operands.items()}})
    plc.scan()


def refused(plc, code):
    """Whether the last scan ended in an error that left D10 alone."""
    return (plc["SD20"], plc["SM20"], plc["D10:REAL"]) == (code, 1, UNTOUCHED)


@pytest.mark.parametrize(("name", "meaning"), [("RADD", operator.add), ("RSUB", operator.sub), ("RMUL", operator.mul)])
@given(first=SINGLES, second=SINGLES)
@example(first=0.1, second=0.2)
@example(first=LIMIT, second=1.0)
@example(first=3e38, second=3e38)
def test_two_reals_give_the_nearest_single_and_its_flags(running, name, meaning, first, second):
    plc = running(f"LD SM0\n{name} D0 D2 D10")
    computed(plc, D0=first, D2=second)
    with numpy.errstate(all="ignore"):
        expected = float(meaning(numpy.float32(first), numpy.float32(second)))
    assert same(plc, expected)
    assert (plc[ZERO], plc[CARRY]) == (expected == 0, not abs(expected) <= LIMIT)


@given(first=SINGLES, second=SINGLES)
@example(first=1.0, second=3.0)
@example(first=1.0, second=-0.0)
def test_a_quotient_is_the_nearest_single_and_zero_no_divisor(running, first, second):
    plc = running("LD SM0\nRDIV D0 D2 D10")
    computed(plc, D0=first, D2=second)
    if second == 0:
        assert refused(plc, 69)
        return
    with numpy.errstate(all="ignore"):
        expected = float(numpy.float32(first) / numpy.float32(second))
    assert same(plc, expected)
    assert (plc[ZERO], plc[CARRY]) == (expected == 0, not abs(expected) <= LIMIT)


@given(number=SINGLES)
def test_a_root_is_the_nearest_single(running, number):
    plc = running("LD SM0\nRSQT D0 D10")
    computed(plc, D0=number)
    if number < 0:
        assert refused(plc, 64)
    else:
        assert same(plc, float(numpy.sqrt(numpy.float32(number))))
        assert plc[ZERO] == (number == 0)


@pytest.mark.parametrize(("name", "meaning"), [("RVABS", abs), ("RNEG", operator.neg)])
@given(number=FINITE)
def test_a_sign_is_taken_off_or_turned(running, name, meaning, number):
    plc = running(f"LD SM0\n{name} D0 D10")
    computed(plc, D0=number)
    assert same(plc, meaning(number))


@given(raw=st.integers(0, 0xFFFF_FFFF))
def test_a_move_copies_registers_whatever_they_hold(running, raw):
    plc = running("LD SM0\nRMOV D0 D10")
    plc["D0:DWORD"] = raw
    plc.scan()
    assert plc["D10:DWORD"] == raw


@pytest.mark.parametrize("name", ["SIN", "COS", "TAN"])
@given(angle=FINITE)
def test_angles_are_radians(running, name, angle):
    plc = running(f"LD SM0\n{name} D0 D10")
    computed(plc, D0=angle)
    expected = float(numpy.float32(getattr(numpy, name.lower())(numpy.float64(numpy.float32(angle)))))
    assert math.isclose(plc["D10:REAL"], expected, rel_tol=2e-7, abs_tol=1e-45)
    assert plc[ZERO] == (plc["D10:REAL"] == 0)


@pytest.mark.parametrize("name", ["SIN", "COS", "TAN"])
@pytest.mark.parametrize("angle", [math.inf, -math.inf])
def test_an_infinite_angle_is_error_64(running, name, angle):
    plc = running(f"LD SM0\n{name} D0 D10")
    computed(plc, D0=angle)
    assert refused(plc, 64)


@given(number=FINITE)
@example(number=0.0)
def test_a_logarithm_wants_a_positive_number(running, number):
    plc = running("LD SM0\nLN D0 D10")
    computed(plc, D0=number)
    if number <= 0:
        assert refused(plc, 64)
    else:
        assert math.isclose(plc["D10:REAL"], float(numpy.log(numpy.float64(number))), rel_tol=2e-7, abs_tol=1e-45)


@given(exponent=FINITE)
@example(exponent=88.1)
@example(exponent=-104.0)
def test_an_exponential_becomes_an_infinity_beyond_the_singles(running, exponent):
    plc = running("LD SM0\nEXP D0 D10")
    computed(plc, D0=exponent)
    with numpy.errstate(all="ignore"):
        expected = float(numpy.float32(numpy.exp(numpy.float64(numpy.float32(exponent)))))
    assert math.isclose(plc["D10:REAL"], expected, rel_tol=2e-7, abs_tol=2e-45)
    assert (plc[ZERO], plc[CARRY]) == (plc["D10:REAL"] == 0, plc["D10:REAL"] > LIMIT)


@given(base=FINITE, exponent=st.one_of(FINITE, st.integers(-50, 50).map(float)))
@example(base=-10.0, exponent=999999.0)
@example(base=-10.0, exponent=999998.0)
@example(base=0.0, exponent=0.0)
def test_a_power_has_the_domain_of_the_manual(running, base, exponent):
    plc = running("LD SM0\nPOWER D0 D2 D10")
    computed(plc, D0=base, D2=exponent)
    if (base == 0 and exponent <= 0) or (base < 0 and not float(exponent).is_integer()):
        assert refused(plc, 64)
        return
    with numpy.errstate(all="ignore"):
        expected = float(numpy.float32(numpy.power(numpy.float64(base), numpy.float64(exponent))))
    assert math.isclose(plc["D10:REAL"], expected, rel_tol=2e-7, abs_tol=2e-45)
    assert plc[CARRY] == (abs(plc["D10:REAL"]) > LIMIT)


@given(values=st.lists(FINITE, max_size=60))
def test_a_sum_is_rounded_at_each_step_and_ends_beyond_the_limit(running, values):
    plc = running("LD SM0\nRSUM D1000 D0 D10")
    plc.set({"D0": len(values), **{f"D{1000 + 2 * place}:REAL": value for place, value in enumerate(values)}})
    plc.scan()
    total = numpy.float32(0)
    with numpy.errstate(all="ignore"):
        for value in values:
            total = total + numpy.float32(value)
            if abs(total) > LIMIT:
                break
    assert same(plc, float(total))


def test_a_chain_of_reals_is_rounded_at_every_link(running):
    plc = running("LD SM0\nRADD D0 1.0 D2\nRSUB D2 D0 D4\nRMUL D4 3.0 D6\nRDIV D6 D4 D8\nRADD D8 D2 D10")
    computed(plc, D0=16777216.0, D4=9.0)
    assert plc["D2:REAL"] == 16777216.0  # 16777217 is no single
    assert plc["D4:REAL"] == 0.0
    assert plc["D6:REAL"] == 0.0
    assert (plc["D8:REAL"], plc["SD20"]) == (0.0, 69)  # 0 / 0
    assert plc["D10:REAL"] == 16777216.0
    assert plc["SM20"] == 0  # the last instruction was executed correctly
