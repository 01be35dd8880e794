"""FNC 20 to 23, 29, 48 and 49: arithmetic of H1U and H2U where its results, flags or operands are not those of the other family."""

from ..errors import DIVISION, Fault
from .arithmetic import sqt
from .conversion import real
from .define import FX, H2U, RESULT, value


def add(s1, s2):
    """D = S1 + S2; a sum beyond the range goes on from 0 with the sign of the limit that was passed, so that 32767 + 2 gives 1."""
    return s1 + s2


def sub(s1, s2):
    """D = S1 - S2; a difference beyond the range goes on from 0 with the sign of the limit that was passed, so that -32768 - 2 gives -1."""
    return s1 - s2


for _name, _number, _function in (("ADD", 20, add), ("SUB", 21, sub)):
    for _width, _type, _steps in (("", "INT", 7), ("D", "DINT", 13)):
        value(
            f"FX:{_width}{_name}", f"S1:{_type} S2:{_type} -> D:{_type}", steps=_steps, section=f"FNC {_number}", models=FX, flags=RESULT,
            restarts=True,
        )(_function)  # fmt: skip


@value("FX:DMUL", "S1:DINT S2:DINT -> D:DINT*2'", steps=13, section="FNC 22", models=FX)
def dmul(s1, s2):
    """D to D+3 = S1 * S2 with 64 bits, the lowest word in D; a Kn string takes the low 32 bits."""
    return [s1 * s2, s1 * s2 >> 32]


@value("FX:DIV", "S1:INT S2:INT -> D:INT*2'", steps=7, section="FNC 23", models=FX, faults=(DIVISION,))
@value("FX:DDIV", "S1:DINT S2:DINT -> D:DINT*2'", steps=13, section="FNC 23", models=FX, faults=(DIVISION,))
def div(s1, s2):
    """D = S1 / S2 cut to a whole number, the number behind it = the remainder, with the sign of S1; a Kn string takes the quotient only."""
    if s2 == 0:
        raise Fault(DIVISION)
    quotient = int(s1 / s2)  # exact: a float has room for more than 32 bits
    return [quotient, s1 - quotient * s2]


@value("FX:NEG", "D:INT -> D", steps=3, section="FNC 29", models=H2U)
@value("FX:DNEG", "D:DINT -> D", steps=5, section="FNC 29", models=H2U)
def neg(d):
    """D = -D; the smallest number stays, it has no counterpart."""
    return -d


for _name, _type, _most, _steps in (("SQR", "INT", 32767, 5), ("DSQR", "DINT", 2147483647, 9)):
    _signature = f"S:{_type}[const D]=0..{_most} -> D:{_type}[D] borrow"
    value(f"FX:{_name}", _signature, steps=_steps, section="FNC 48", models=H2U, flags=("zero",))(sqt)
for _name, _type, _steps in (("FLT", "INT", 5), ("DFLT", "DINT", 9)):
    value(f"FX:{_name}", f"S:{_type}[D] -> D:REAL[D]", steps=_steps, section="FNC 49", models=H2U)(real)
