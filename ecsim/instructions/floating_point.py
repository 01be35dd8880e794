"""6.4: floating-point arithmetic. Each result is rounded to a single once; zero and carry tell about the rounded one.

A result beyond the largest single is an infinity, and carry is set already from 2**127 on. A number outside a function's
domain is error 64.
"""

import math

from ..errors import DIVISION, OPERAND, Fault
from ..values import REAL_LIMIT, single
from .define import value

OVERFLOW = ("zero", "carry")


@value("RADD", "S1:REAL S2:REAL -> D:REAL", steps=10, flags=OVERFLOW, section="6.4.1")
def radd(s1, s2):
    """D = S1 + S2."""
    return s1 + s2


@value("RSUB", "S1:REAL S2:REAL -> D:REAL", steps=10, flags=OVERFLOW, section="6.4.2")
def rsub(s1, s2):
    """D = S1 - S2."""
    return s1 - s2


@value("RMUL", "S1:REAL S2:REAL -> D:REAL", steps=10, flags=OVERFLOW, section="6.4.3")
def rmul(s1, s2):
    """D = S1 * S2."""
    return s1 * s2


@value("RDIV", "S1:REAL S2:REAL -> D:REAL", steps=10, flags=OVERFLOW, section="6.4.4", faults=(DIVISION,))
def rdiv(s1, s2):
    """D = S1 / S2; division by 0 is error 69."""
    if s2 == 0:
        raise Fault(DIVISION)
    return s1 / s2


@value("RSQT", "S:REAL -> D:REAL", steps=7, flags=("zero",), section="6.4.5", faults=(OPERAND,))
def rsqt(s):
    """D = the square root of S; a negative S is error 64."""
    if s < 0:
        raise Fault(OPERAND)
    return math.sqrt(s)


@value("RVABS", "S:REAL -> D:REAL", steps=7, section="6.4.6")
def rvabs(s):
    """D = S without its sign."""
    return abs(s)


@value("RNEG", "S:REAL -> D:REAL", steps=7, section="6.4.7")
def rneg(s):
    """D = -S."""
    return -s


@value("SIN", "S:REAL -> D:REAL", steps=7, flags=("zero",), section="6.4.8", faults=(OPERAND,))
def sin(s):
    """D = the sine of S, an angle in radians."""
    return math.sin(_finite(s))


@value("COS", "S:REAL -> D:REAL", steps=7, flags=("zero",), section="6.4.9", faults=(OPERAND,))
def cos(s):
    """D = the cosine of S, an angle in radians."""
    return math.cos(_finite(s))


@value("TAN", "S:REAL -> D:REAL", steps=7, flags=OVERFLOW, section="6.4.10", faults=(OPERAND,))
def tan(s):
    """D = the tangent of S, an angle in radians."""
    return math.tan(_finite(s))


@value("POWER", "S1:REAL S2:REAL -> D:REAL", steps=10, flags=OVERFLOW, section="6.4.11", faults=(OPERAND,))
def power(s1, s2):
    """D = S1 to the power of S2.

    Error 64: S1 is 0 and S2 not above 0, or S1 is negative and S2 has a fraction.
    """
    if (s1 == 0 and s2 <= 0) or (s1 < 0 and s2 % 1):
        raise Fault(OPERAND)
    try:
        return math.pow(s1, s2)
    except OverflowError:
        return -math.inf if s1 < 0 and s2 % 2 else math.inf


@value("LN", "S:REAL -> D:REAL", steps=7, flags=OVERFLOW, section="6.4.12", faults=(OPERAND,))
def ln(s):
    """D = the natural logarithm of S; an S not above 0 is error 64."""
    if s <= 0:
        raise Fault(OPERAND)
    return math.log(s)


@value("EXP", "S:REAL -> D:REAL", steps=7, flags=OVERFLOW, section="6.4.13")
def exp(s):
    """D = e to the power of S."""
    try:
        return math.exp(s)
    except OverflowError:
        return math.inf


@value("RSUM", "S1:REAL-const*S2 S2:INT-SD-C-T-Z=0..255 -> D:REAL", steps=9, section="6.4.14")
def rsum(s1, s2):
    """D = the sum of the S2 numbers from S1 on, rounded at each step; it ends with the first partial sum beyond the limit of carry."""
    total = 0.0
    for number in s1:
        total = single(total + number)
        if not -REAL_LIMIT <= total <= REAL_LIMIT:
            break
    return total


def _finite(angle: float) -> float:
    """The angle; an infinity has no sine."""
    if math.isinf(angle):
        raise Fault(OPERAND)
    return angle
