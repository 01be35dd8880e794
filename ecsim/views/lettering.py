"""How wide words are: in a drawing, estimated as fonts differ, and in a terminal, where wide signs take two columns."""

from functools import lru_cache
from unicodedata import combining, east_asian_width

_NARROW, _WIDE = frozenset("iljtfrI.,:;'|!()[]/ "), frozenset("mwMW@%")
MONO = 0.605


def columns(words: str) -> int:
    """How many columns of a terminal some words take."""
    if words.isascii():
        return len(words)
    return sum(0 if combining(sign) else 2 if east_asian_width(sign) in "WF" else 1 for sign in words)


def padded(words: str, width: int, align: str = "<") -> str:
    """Words filled up with blanks to `width` columns, at the left, right or middle ("<", ">", "^")."""
    free = max(0, width - columns(words))
    left = {"<": 0, ">": free, "^": free // 2}[align]
    return " " * left + words + " " * (free - left)


@lru_cache(4096)
def width(words: str, size: float = 12, mono: bool = False) -> float:
    """About how wide words are drawn, in px; a little more than most fonts need."""
    return size * sum(_share(sign, mono) for sign in words)


def _share(sign: str, mono: bool) -> float:
    if not sign.isascii() and east_asian_width(sign) in "WF":
        return 1.0
    if mono:
        return MONO
    if sign in _NARROW:
        return 0.34
    if sign in _WIDE:
        return 0.92
    return 0.7 if sign.isupper() else 0.6


@lru_cache(4096)
def cut(words: str, room: float, size: float = 12, mono: bool = False) -> str:
    """Words that fit into `room` px; what does not ends in an ellipsis."""
    if width(words, size, mono) <= room:
        return words
    while words and width(words + "…", size, mono) > room:
        words = words[:-1]
    return words.rstrip() + "…"


def cut_columns(words: str, room: int) -> str:
    """Words that fit into `room` columns of a terminal."""
    if columns(words) <= room:
        return words
    while words and columns(words) > room - 1:
        words = words[:-1]
    return words + "…"
