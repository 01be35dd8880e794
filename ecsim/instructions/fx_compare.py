"""FNC 10, 11, 110, 111, 160 and 161: comparisons that turn one of three bits ON. Without flow the bits stay as they are."""

from ..errors import OPERAND
from .clock import seconds_of
from .define import FX, H2U, value

_BITS = "D:BOOL[Y M S]*3~"
_TIME = "INT[T C D]*3"


@value("FX:CMP", f"S1:INT S2:INT -> {_BITS}", steps=7, section="FNC 10", models=FX)
@value("FX:DCMP", f"S1:DINT S2:DINT -> {_BITS}", steps=13, section="FNC 10", models=FX)
@value("FX:ECMP", f"S1:REAL[const D] S2:REAL[const D] -> {_BITS}", steps=13, section="FNC 110", models=H2U)
def cmp(s1, s2):
    """D is ON when S1 is above S2, D+1 when they are equal, D+2 when S1 is below S2; the other two go OFF."""
    return [s1 > s2, s1 == s2, s1 < s2]


@value("FX:ZCP", f"S1:INT S2:INT S:INT -> {_BITS}", steps=9, section="FNC 11", models=FX)
@value("FX:DZCP", f"S1:DINT S2:DINT S:DINT -> {_BITS}", steps=17, section="FNC 11", models=FX)
@value("FX:EZCP", f"S1:REAL[const D] S2:REAL[const D] S:REAL[const D] -> {_BITS}", steps=17, section="FNC 111", models=H2U)
def zcp(s1, s2, s):
    """D is ON when S is below S1, D+1 when it is from S1 to S2, D+2 when it is above S2; an S2 below S1 counts as S1."""
    return [s < s1, s1 <= s <= max(s1, s2), s > max(s1, s2)]


@value("FX:TCMP", f"S1:INT S2:INT S3:INT S:{_TIME} -> {_BITS}", steps=11, section="FNC 160", models=FX, faults=(OPERAND,))
def tcmp(s1, s2, s3, s):
    """D is ON when the time of day S1 h S2 min S3 s is after the one from S on, D+1 when they are equal, D+2 when it is before."""
    return cmp(seconds_of([s1, s2, s3]), seconds_of(s))


@value("FX:TZCP", f"S1:{_TIME} S2:{_TIME} S:{_TIME} -> {_BITS}", steps=9, section="FNC 161", models=FX, faults=(OPERAND,))
def tzcp(s1, s2, s):
    """D is ON when the time of day from S on is before that from S1 on, D+1 when it is from S1 to S2, D+2 when it is after S2."""
    first, last, time = seconds_of(s1), seconds_of(s2), seconds_of(s)
    return zcp(first, last, time)
