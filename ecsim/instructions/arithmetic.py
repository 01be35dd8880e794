"""6.3: arithmetic with 16 and 32 bits."""

from math import isqrt

from ..errors import DIVISION, Fault
from ..values import DINT, INT
from .define import RESULT, value


@value("ADD", "S1:INT S2:INT -> D:INT", steps=7, flags=RESULT, section="6.3.1")
@value("DADD", "S1:DINT S2:DINT -> D:DINT", steps=10, flags=RESULT, section="6.3.10")
def add(s1, s2):
    """D = S1 + S2, wrapped to the width of D."""
    return s1 + s2


@value("SUB", "S1:INT S2:INT -> D:INT", steps=7, flags=RESULT, section="6.3.2")
@value("DSUB", "S1:DINT S2:DINT -> D:DINT", steps=10, flags=RESULT, section="6.3.11")
def sub(s1, s2):
    """D = S1 - S2, wrapped to the width of D."""
    return s1 - s2


@value("MUL", "S1:INT S2:INT -> D:DINT", steps=8, section="6.3.3")
@value("DMUL", "S1:DINT S2:DINT -> D:DINT", steps=10, section="6.3.12")
def mul(s1, s2):
    """D = S1 * S2 with 32 bits; of a longer product the low 32 bits stay."""
    return s1 * s2


def _divided(dividend: int, divisor: int, least: int) -> tuple[list[int], bool]:
    """Quotient, cut toward zero, and remainder, which has the sign of the dividend; whether the quotient did not fit and was wrapped."""
    if divisor == 0:
        raise Fault(DIVISION)
    if divisor == -1 and dividend == least:
        return [least, 0], True
    quotient = int(dividend / divisor)  # exact: a float has room for more than 32 bits
    return [quotient, dividend - quotient * divisor], False


@value("DIV", "S1:INT S2:INT -> D:INT*2 carry", steps=7, section="6.3.4", as_stored=True, faults=(DIVISION,))
def div(s1, s2):
    """D = S1 / S2 cut to a whole number, and the element after D = the remainder, which has the sign of S1.

    The one quotient that does not fit, -32768 / -1, wraps and sets carry.
    """
    return _divided(s1, s2, INT.low)


@value("DDIV", "S1:DINT S2:DINT -> D:DINT*2 carry", steps=10, section="6.3.13", as_stored=True, faults=(DIVISION,))
def ddiv(s1, s2):
    """D = S1 / S2 cut to a whole number, and the element after D = the remainder, which has the sign of S1.

    The one quotient that does not fit, -2147483648 / -1, wraps and sets carry.
    """
    return _divided(s1, s2, DINT.low)


@value("SQT", "S:INT=0..32767 -> D:INT borrow", steps=5, flags=("zero",), section="6.3.5")
@value("DSQT", "S:DINT=0..2147483647 -> D:DINT borrow", steps=7, flags=("zero",), section="6.3.14")
def sqt(s):
    """D = the square root of S cut to a whole number; borrow tells that a fraction was cut off."""
    return isqrt(s), isqrt(s) ** 2 != s


@value("INC", "D:INT -> D", steps=3, section="6.3.6")
@value("DINC", "D:DINT -> D", steps=4, section="6.3.15")
def inc(d):
    """D = D + 1; after the largest number comes the smallest."""
    return d + 1


@value("DEC", "D:INT -> D", steps=3, section="6.3.7")
@value("DDEC", "D:DINT -> D", steps=4, section="6.3.16")
def dec(d):
    """D = D - 1; after the smallest number comes the largest."""
    return d - 1


@value("VABS", "S:INT=-32767..32767 -> D:INT", steps=5, section="6.3.8")
@value("DVABS", "S:DINT=-2147483647..2147483647 -> D:DINT", steps=7, section="6.3.17")
def vabs(s):
    """D = S without its sign; the smallest number has no counterpart and is error 64."""
    return abs(s)


@value("NEG", "S:INT-KnX-KnY-KnM-KnS-KnLM-KnSM=-32767..32767 -> D:INT", steps=5, section="6.3.9")
@value("DNEG", "S:DINT=-2147483647..2147483647 -> D:DINT", steps=7, section="6.3.18")
def neg(s):
    """D = -S; the smallest number has no counterpart and is error 64."""
    return -s


@value("SUM", "S1:INT-const*S2 S2:INT=0..255 -> D:DINT", steps=8, flags=RESULT, section="6.3.19")
@value("DSUM", "S1:DINT-const*S2 S2:INT=0..255 -> D:DINT", steps=9, flags=("zero",), section="6.3.20")
def sum_(s1, s2):
    """D = the sum of the S2 elements from S1 on, 0 when there are none."""
    return sum(s1)
