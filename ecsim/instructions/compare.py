"""6.16: compare contacts. There are 54 of them: six comparisons, three types, three ways to join the flow."""

from .define import contact


def equal(s1, s2):
    """Closed while S1 = S2."""
    return s1 == s2


def greater(s1, s2):
    """Closed while S1 > S2."""
    return s1 > s2


def at_least(s1, s2):
    """Closed while S1 >= S2."""
    return s1 >= s2


def less(s1, s2):
    """Closed while S1 < S2."""
    return s1 < s2


def at_most(s1, s2):
    """Closed while S1 <= S2."""
    return s1 <= s2


def different(s1, s2):
    """Closed while S1 and S2 differ."""
    return s1 != s2


COMPARISONS = {"=": equal, ">": greater, ">=": at_least, "<": less, "<=": at_most, "<>": different}
_JOINS = ("LD", "AND", "OR")
_WIDTHS = (("", "INT", 5), ("D", "DINT", 7), ("R", "REAL", 7))

for _row, (_width, _type, _steps) in enumerate(_WIDTHS):
    for _column, _join in enumerate(_JOINS):
        for _sign, _function in COMPARISONS.items():
            _name = f"{_join}{_width}{_sign}"
            contact(_name, f"S1:{_type} S2:{_type}", join=_join, steps=_steps, section=f"6.16.{3 * _row + _column + 1}")(_function)
