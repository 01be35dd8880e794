"""FNC 118 to 132: floating-point numbers as mantissa and exponent to the base 10, and functions with operands of their own."""

import math
from decimal import ROUND_DOWN, Context, Decimal

from ..errors import OPERAND, Fault
from .conversion import dint, int_
from .define import H2U, value
from .floating_point import OVERFLOW, cos, sin, tan

_FOUR = Context(prec=4, rounding=ROUND_DOWN)
LEAST, MOST = -41, 35  # the exponents


@value("FX:EBCD", "S:REAL[D] -> D:INT[D]*2", steps=9, section="FNC 118", models=H2U, faults=(OPERAND,))
def ebcd(s):
    """D and D+1 = S as a mantissa of four digits, 1000 to 9999 with sign or 0, and the exponent to the base 10 that goes with it."""
    if not math.isfinite(s):
        raise Fault(OPERAND)
    sign, digits, exponent = _FOUR.create_decimal(Decimal(s)).normalize(_FOUR).as_tuple()
    shift = 4 - len(digits)
    if not s or exponent - shift < LEAST:
        return [0, 0]
    mantissa = int("".join(map(str, digits))) * 10**shift
    return [-mantissa if sign else mantissa, exponent - shift]


@value("FX:EBIN", "S:INT[D]*2 -> D:REAL[D]", steps=9, section="FNC 119", models=H2U, faults=(OPERAND,))
def ebin(s):
    """D = the number whose mantissa stands in S, 1000 to 9999 with sign or 0, and whose exponent to the base 10 in S+1, -41 to 35."""
    mantissa, exponent = s
    if mantissa and not (1000 <= abs(mantissa) <= 9999 and LEAST <= exponent <= MOST):
        raise Fault(OPERAND)
    return float(f"{mantissa}e{exponent}")


_WHOLE = "zero carry borrow"
value("FX:INT", f"S:REAL[D] -> D:INT {_WHOLE}", steps=5, section="FNC 129", models=H2U, faults=(OPERAND,))(int_)
value("FX:DINT", f"S:REAL[D] -> D:DINT {_WHOLE}", steps=9, section="FNC 129", models=H2U, faults=(OPERAND,))(dint)
for _name, _number, _function, _flags in (("SIN", 130, sin, ("zero",)), ("COS", 131, cos, ("zero",)), ("TAN", 132, tan, OVERFLOW)):
    value(f"FX:{_name}", "S:REAL[D] -> D:REAL[D]", steps=9, section=f"FNC {_number}", models=H2U, flags=_flags, faults=(OPERAND,))(
        _function
    )
