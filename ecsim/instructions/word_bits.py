"""6.15: contacts and coils on single bits of words."""

from .define import always, contact, value

for _join, _open, _closed, _at in (("LD", "BLD", "BLDI", 1), ("AND", "BAND", "BANI", 3), ("OR", "BOR", "BORI", 5)):

    @contact(_open, "S1:WORD-const S2:INT=0..15", join=_join, steps=5, section=f"6.15.{_at}")
    def bit_on(s1, s2):
        """A contact that is closed while bit S2 of S1 is ON."""
        return s1 >> s2 & 1 == 1

    @contact(_closed, "S1:WORD-const S2:INT=0..15", join=_join, steps=5, section=f"6.15.{_at + 1}")
    def bit_off(s1, s2):
        """A contact that is closed while bit S2 of S1 is OFF."""
        return s1 >> s2 & 1 == 0


@always("BOUT", "D:WORD S:INT=0..15 -> D", steps=5, section="6.15.7", cleared=True)
def bout(flow, d, s):
    """A coil in a word: bit S of D takes the state of the flow in every scan."""
    return d | 1 << s if flow else d & ~(1 << s)


@value("BSET", "D:WORD S:INT=0..15 -> D", steps=5, section="6.15.8")
def bset(d, s):
    """Turn bit S of D ON while the flow is ON, and leave it so."""
    return d | 1 << s


@value("BRST", "D:WORD S:INT=0..15 -> D", steps=5, section="6.15.9")
def brst(d, s):
    """Turn bit S of D OFF while the flow is ON, and leave it so."""
    return d & ~(1 << s)
