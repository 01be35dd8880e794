"""6.14: bit instructions."""

from .define import value


@value("ZRST", ">D:BOOL*S~ S:INT", steps=5, section="6.14.1", resets=True)
def zrst(s):
    """Turn S bits from D on OFF; of timers and counters the values are cleared too."""
    return [False] * s
