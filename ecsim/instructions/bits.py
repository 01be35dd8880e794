"""6.14: bit instructions."""

from ..errors import OPERAND, Fault
from .define import value


@value("ZRST", ">D:BOOL*S~ S:INT=0..32767", steps=5, section="6.14.1", resets=True)
def zrst(s):
    """Turn S bits from D on OFF; of timers and counters the values are cleared too."""
    return [False] * s


@value("ZSET", ">D:BOOL*S~ S:INT=0..32767", steps=5, section="6.14.2")
def zset(s):
    """Turn S bits from D on ON; of timers and counters the contacts alone."""
    return [True] * s


@value("DECO", "S:WORD=0..15 -> D:INT+KnSM+SD", steps=5, section="6.14.3")
def deco(s):
    """D becomes the word in which bit S alone is ON."""
    return 1 << s


@value("ENCO", "S:INT -> D:INT+SD", steps=5, section="6.14.4", faults=(OPERAND,))
def enco(s):
    """D becomes the number of the lowest bit of S that is ON."""
    if not s:
        raise Fault(OPERAND)
    return (s & -s).bit_length() - 1


@value("BITS", "S:INT -> D:INT+KnSM+SD", steps=5, section="6.14.5")
def bits(s):
    """D becomes how many bits of S are ON."""
    return (s & 0xFFFF).bit_count()


@value("DBITS", "S:DWORD -> D:INT+KnSM+SD", steps=6, section="6.14.6")
def dbits(s):
    """D becomes how many bits of S, 32 bits, are ON."""
    return (s & 0xFFFF_FFFF).bit_count()
