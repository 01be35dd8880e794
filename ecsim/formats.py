"""How the value of a device is written and read: decimal, hex, binary, octal, float, text. The one place for number formats."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

from .errors import EcsimError
from .values import BOOL, REAL, DataType, join, real_from_words, signed16, single, split, words_from_real, wrap

MARKS = {"2#": 2, "8#": 8, "16#": 16}
SIGNS = str.maketrans({"\N{MINUS SIGN}": "-", "_": None, " ": None, "\N{NO-BREAK SPACE}": None})
THOUSANDS = re.compile(r"(?<=\d),(?=\d{3}(?!\d))")


@dataclass(frozen=True, slots=True)
class Format:
    """A way to write values: `text(value, type)` and back `read(text, type)`, for the types that it `suits`."""

    text: Callable[[int | float, DataType], str]
    read: Callable[[str, DataType], int | float]
    suits: Callable[[DataType], bool]


def _plain(text: str) -> str:
    """Without what only makes numbers readable: spaces between digits, commas between thousands."""
    return THOUSANDS.sub("", text.translate(SIGNS))


def _digits(base: int, per_digit: int) -> Callable[[int | float, DataType], str]:
    mark, spell = {2: ("2#", "b"), 8: ("8#", "o"), 16: ("16#", "X")}[base]

    def text(value: int | float, kind: DataType) -> str:
        return str(value) if kind is BOOL else f"{mark}{value & (1 << kind.bits) - 1:0{-(-kind.bits // per_digit)}{spell}}"

    return text


def _whole(usual: int) -> Callable[[str, DataType], int]:
    def read(text: str, kind: DataType) -> int:
        plain = _plain(text)
        sign, digits = (-1, plain[1:]) if plain.startswith("-") else (1, plain.removeprefix("+"))
        mark = next((mark for mark in MARKS if digits.startswith(mark)), "")
        base, digits = MARKS.get(mark, usual), digits.removeprefix(mark)
        if not re.fullmatch("[0-9A-Fa-f]{1,64}", digits) or any(int(digit, 16) >= base for digit in digits):
            if usual == 10 and re.fullmatch(r"\d*[.,]\d*", digits):
                raise EcsimError(f"{text!r:.40} is no whole number; choose the format float for numbers with a fraction")
            raise EcsimError(f"{text!r:.40} is no {'whole' if base == 10 else f'base {base}'} number; write 100, -5, 16#1F, 8#17 or 2#101")
        value = sign * int(digits, base)
        low, high = (0, 1) if kind is BOOL else (-(1 << kind.bits - 1), (1 << kind.bits) - 1)
        if not low <= value <= high:
            raise EcsimError(f"{text} does not fit into {'one bit' if kind is BOOL else f'{kind.bits} bits'} ({low} to {high})")
        return value if kind is BOOL else wrap(value, kind)

    return read


def _float(value: int | float, kind: DataType) -> str:
    return f"{value if kind is REAL else real_from_words(*split(value)):.7g}"


def _read_float(text: str, kind: DataType) -> int | float:
    try:
        value = single(float(_plain(text)))
    except ValueError:
        raise EcsimError(f"{text!r:.40} is no number; write 12.5, -3 or 1.5e3") from None
    if not math.isfinite(value):
        raise EcsimError(f"{text} does not fit into a REAL (-3.402823e+38 to 3.402823e+38)")
    return value if kind is REAL else wrap(join(*words_from_real(value)), kind)


def _characters(value: int | float, kind: DataType) -> str:
    """Two characters a register, the one in the low byte first, as ASC stores them (6.5.16)."""
    words = range(kind.words)[::-1] if kind.words > 1 else (0,)
    codes = [value >> 16 * word + shift & 0xFF for word in words for shift in (0, 8)]
    return repr("".join(chr(code) if 32 <= code < 127 else "." for code in codes))


def _read_characters(text: str, kind: DataType) -> int:
    """As many characters as fit, with or without quotes; what is left out is 0."""
    plain = text[1:-1] if len(text) >= 2 and text[0] == text[-1] and text[0] in "'\"" else text
    if not plain.isascii() or len(plain) > 2 * kind.words:
        raise EcsimError(f"{text!r:.40} does not fit: {2 * kind.words} ASCII characters do")
    codes = plain.encode().ljust(4, b"\0")
    first, second = (signed16(codes[at] | codes[at + 1] << 8) for at in (0, 2))
    return wrap(join(first, second) if kind.words > 1 else first, kind)


def _is_whole(kind: DataType) -> bool:
    return kind is not REAL


FORMATS = {
    "decimal": Format(lambda value, kind: f"{value:d}", _whole(10), _is_whole),
    "hex": Format(_digits(16, 4), _whole(16), _is_whole),
    "binary": Format(_digits(2, 1), _whole(2), _is_whole),
    "octal": Format(_digits(8, 3), _whole(8), _is_whole),
    "float": Format(_float, _read_float, lambda kind: kind.bits == 32),
    "text": Format(_characters, _read_characters, lambda kind: kind is not REAL and kind.bits >= 16),
}


def usual(kind: DataType) -> str:
    """The format in which a value of this type is shown when none has been chosen."""
    return "float" if kind is REAL else "binary" if kind is BOOL else "decimal"
