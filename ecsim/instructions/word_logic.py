"""6.6: logic of words, bit by bit."""

from .define import value


@value("WAND", "S1:WORD S2:WORD -> D:WORD", steps=7, section="6.6.1", as_stored=True)
@value("DWAND", "S1:DWORD S2:DWORD -> D:DWORD", steps=10, section="6.6.5", as_stored=True)
def wand(s1, s2):
    """Each bit of D is ON where both S1 and S2 have it ON."""
    return s1 & s2


@value("WOR", "S1:WORD S2:WORD -> D:WORD", steps=7, section="6.6.2", as_stored=True)
@value("DWOR", "S1:DWORD S2:DWORD -> D:DWORD", steps=10, section="6.6.6", as_stored=True)
def wor(s1, s2):
    """Each bit of D is ON where S1 or S2 has it ON."""
    return s1 | s2


@value("WXOR", "S1:WORD S2:WORD -> D:WORD", steps=7, section="6.6.3", as_stored=True)
@value("DWXOR", "S1:DWORD S2:DWORD -> D:DWORD", steps=10, section="6.6.7", as_stored=True)
def wxor(s1, s2):
    """Each bit of D is ON where S1 and S2 differ."""
    return s1 ^ s2


@value("WINV", "S:WORD -> D:WORD", steps=5, section="6.6.4", as_stored=True)
@value("DWINV", "S:DWORD -> D:DWORD", steps=7, section="6.6.8", as_stored=True)
def winv(s):
    """Each bit of D is ON where S has it OFF."""
    return ~s
