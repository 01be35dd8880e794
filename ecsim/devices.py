"""Names of devices and constants: text to operand and back (3.2, 3.3)."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field

OCTAL_AREAS = frozenset("XY")


def number_text(area: str, number: int) -> str:
    """The number of a device as it is written: octal for X and Y, decimal for all others."""
    return f"{number:o}" if area in OCTAL_AREAS else str(number)


@dataclass(frozen=True, slots=True)
class Device:
    """One device, or the first of those an operand spans; `number` counts from 0 also where the name is octal."""

    area: str
    number: int
    index: int | None = None
    index_area: str = "Z"

    def __str__(self) -> str:
        tail = "" if self.index is None else f"{self.index_area}{self.index}"
        return f"{self.area}{number_text(self.area, self.number)}{tail}"


@dataclass(frozen=True, slots=True)
class Bits:
    """Kn addressing (3.2.1): 4 * `digits` bit devices from `number` taken as one number, the first one lowest."""

    digits: int
    area: str
    number: int
    index: int | None = None
    index_area: str = "Z"

    def __str__(self) -> str:
        return f"K{self.digits}{Device(self.area, self.number, self.index, self.index_area)}"


@dataclass(frozen=True, slots=True)
class Constant:
    """A number in the program; `unsigned` when it was written in base 2, 8 or 16 and so has no sign of its own."""

    value: int | float
    text: str
    unsigned: bool = False

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Pointer(Constant):
    """A place in the program or a level of it by number: P10, N0, I101; `letter` says of what kind."""

    letter: str = ""


@dataclass(frozen=True, slots=True)
class IndexedConstant:
    """A constant and what an index register holds, added: K30V0."""

    value: int
    text: str
    index: int
    index_area: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Name:
    """The name of a subroutine."""

    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Text:
    """Characters as they stand in the program (ASC)."""

    text: str

    def __str__(self) -> str:
        return self.text


Operand = Device | Bits | Constant | IndexedConstant | Name | Text


class OperandError(ValueError):
    """The text is no operand; the message says why, `hint` what to write."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(message)
        self.hint = hint


_EC_CONSTANT = re.compile(
    r"(?P<decimal>[+-]?\d+)|(?P<real>[+-]?(?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][+-]?\d+)?)|(?P<base>16|8|2)#(?P<digits>[0-9A-Fa-f]+)"
)


def ec_constant(text: str) -> Constant | None:
    """A constant as table 3-4 writes it (100, -5, 16#1F, 8#17, 2#101, 3.14E+3), or None when `text` is none."""
    match = _EC_CONSTANT.fullmatch(text)
    if match is None:
        return None
    if match["decimal"] is not None:
        if len(text) > 24:
            raise OperandError(f"the constant {text[:12]}... is too long", "at most 32 bits fit")
        return Constant(int(text), text)
    if match["real"] is not None:
        return Constant(float(text), text)
    base, digits = int(match["base"]), match["digits"]
    if len(digits) > 40:
        raise OperandError(f"the constant {text[:12]}... is too long", "at most 32 bits fit")
    try:
        return Constant(int(digits, base), text, unsigned=True)
    except ValueError:
        raise OperandError(
            f"{digits} is no number of base {base}", f"base {base} has the digits 0 to {'F' if base == 16 else base - 1}"
        ) from None


_POINTER = re.compile(r"([A-Z])(\d{1,4})")
_INDEXED = re.compile(r"(.+)([A-Z])(\d{1,4})")
_DEVICE = re.compile(r"(?:[kK](?P<digits>\d+))?(?P<area>[A-Za-z]+)(?P<number>\d+)(?:(?P<ia>[A-Za-z])(?P<index>\d+))?")


@dataclass(frozen=True)
class Syntax:
    """How a family of PLCs writes operands: its areas, which of them are bits, its index registers and its constants."""

    areas: frozenset[str]
    bit_areas: frozenset[str]
    index_areas: frozenset[str] = frozenset("Z")
    constant: Callable[[str], Constant | None] = ec_constant
    pointers: dict[str, str] = field(default_factory=dict)  # kind of operand -> the letter of its pointers: LABEL -> P
    end_label: int | None = None  # the label that stands for the end of the program
    indexed_constants: bool = False
    signed_decimals: bool = False  # 32767 is the greatest of 16 bits; what is above is written in hexadecimal
    _known: dict[str, Operand] = field(default_factory=dict, compare=False, repr=False)

    def parse(self, text: str) -> Operand | None:
        """The operand that `text` spells, None when it has not the form of one (a symbol, say); raises OperandError when it is malformed."""
        operand = self._known.get(text)
        if operand is None:
            if len(text) > 64:
                return None
            operand = self.constant(text) or self._pointer(text) or self._indexed_constant(text) or self._device(text)
            if operand is not None and len(self._known) < 100_000:
                self._known[text] = operand
        return operand

    def _pointer(self, text: str) -> Pointer | None:
        match = _POINTER.fullmatch(text.upper()) if self.pointers else None
        return Pointer(int(match[2]), text, letter=match[1]) if match and match[1] in self.pointers.values() else None

    def _indexed_constant(self, text: str) -> IndexedConstant | None:
        match = _INDEXED.fullmatch(text.upper()) if self.indexed_constants else None
        constant = self.constant(match[1]) if match and match[2] in self.index_areas else None
        if constant is None or isinstance(constant.value, float):
            return None
        return IndexedConstant(constant.value, text, int(match[3]), match[2])

    def _device(self, text: str) -> Operand | None:
        match = _DEVICE.fullmatch(text)
        if match is None or not text.isascii():
            return None
        area = match["area"].upper()
        if area not in self.areas or len(match["number"]) > 9:
            return None
        try:
            number = int(match["number"], 8 if area in OCTAL_AREAS else 10)
        except ValueError:
            raise OperandError(f"{text} is no device", f"{area} devices are numbered in octal, without the digits 8 and 9") from None
        index, index_area = None, "Z"
        if match["index"] is not None:
            index_area = match["ia"].upper()
            if index_area not in self.index_areas:
                return None
            index = int(match["index"])
        if match["digits"] is None:
            return Device(area, number, index, index_area)
        digits = int(match["digits"])
        if area not in self.bit_areas:
            raise OperandError(f"{text}: Kn groups bit devices, {area} holds none", "write K4M0 or K2X0, for example")
        if not 1 <= digits <= 8:
            raise OperandError(f"{text}: K{digits} is out of range", "K1 to K4 stand for 4 to 16 bits, K5 to K8 for 20 to 32")
        return Bits(digits, area, number, index, index_area)
