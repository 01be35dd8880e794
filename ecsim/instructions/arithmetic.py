"""6.3: arithmetic with 16 and 32 bits."""

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
