"""The six data types of 3.3.1 and how numbers fit into 16-bit registers."""

import math
import struct
import sys
from array import array
from dataclasses import dataclass
from functools import cache


@dataclass(frozen=True, slots=True)
class DataType:
    """A data type: `bits` wide, `low` to `high` (REAL has no integer range), `words` registers long."""

    name: str
    bits: int
    low: int
    high: int

    @property
    def words(self) -> int:
        """How many 16-bit registers a value takes (0 for BOOL)."""
        return self.bits // 16

    @property
    def signed(self) -> bool:
        return self.low < 0

    @property
    def stored(self) -> "DataType":
        """The type of the same width that registers hold as it stands."""
        return {16: INT, 32: DINT}.get(self.bits, self)

    def __repr__(self) -> str:
        return self.name


BOOL = DataType("BOOL", 1, 0, 1)
INT = DataType("INT", 16, -0x8000, 0x7FFF)
WORD = DataType("WORD", 16, 0, 0xFFFF)
DINT = DataType("DINT", 32, -0x8000_0000, 0x7FFF_FFFF)
DWORD = DataType("DWORD", 32, 0, 0xFFFF_FFFF)
REAL = DataType("REAL", 32, 0, 0)
TYPES = {kind.name: kind for kind in (BOOL, INT, WORD, DINT, DWORD, REAL)}

REAL_MAX = 3.4028234663852886e38
REAL_LIMIT = 2.0**127  # beyond it a REAL result sets the carry flag (6.4: 1.701412E+38)


def wrap(value: int, kind: DataType) -> int:
    """`value` in two's complement of the width of `kind`."""
    if kind.low <= value <= kind.high:
        return value
    value &= (1 << kind.bits) - 1
    return value - (1 << kind.bits) if value > kind.high else value


def signed16(value: int) -> int:
    """The low 16 bits of `value` as a register holds them: -32768 to 32767."""
    return ((value + 0x8000) & 0xFFFF) - 0x8000


def split(value: int) -> tuple[int, int]:
    """A 32-bit value as (high word, low word), each as a register holds it."""
    return signed16(value >> 16), signed16(value)


def join(high: int, low: int) -> int:
    """Two registers as a signed 32-bit value."""
    return high << 16 | low & 0xFFFF


_FLOAT = struct.Struct(">f")
_PAIR = struct.Struct(">hh")


def single(value: float) -> float:
    """`value` rounded to single precision; beyond the largest single it is an infinity of its sign."""
    try:
        return _FLOAT.unpack(_FLOAT.pack(value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)


def real_from_words(high: int, low: int) -> float:
    """Two registers as an IEEE single."""
    return _FLOAT.unpack(_PAIR.pack(high, low))[0]


@cache
def singles() -> list[tuple[int, int, float]]:
    """High word, low word and value of each 16-bit integer as a REAL; the negative ones at their negative index."""
    numbers = array("f", (*range(0x8000), *range(-0x8000, 0)))
    words = memoryview(numbers).cast("B").cast("h").tolist()
    first, second = words[::2], words[1::2]
    high, low = (second, first) if sys.byteorder == "little" else (first, second)
    return list(zip(high, low, numbers, strict=True))


def words_from_real(value: float) -> tuple[int, int]:
    """`value` rounded to single precision as (high word, low word); an infinity beyond the largest single."""
    try:
        return _PAIR.unpack(_FLOAT.pack(value))
    except OverflowError:
        return _PAIR.unpack(_FLOAT.pack(math.copysign(math.inf, value)))
