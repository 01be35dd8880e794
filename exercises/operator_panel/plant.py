"""An operator's panel at the terminals of a PLC: what TKY, HKY, DSW, SEGL, ARWS, MTR and PR of H2U read and lead.

Each part has its terminals; a panel has the parts that it is made with. Keys are pressed one after the other as by a finger:

    panel = OperatorPanel(("keypad", "display"))
    panel.press("2057")  # four keys, 0.2 s each
    panel.turn(1234)  # the thumbwheels
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from operator import itemgetter
from typing import ClassVar, NamedTuple

from ecsim import EcsimError

from ..plant import INSTANT, Machine, Point

PRESS_S, PAUSE_S = 0.2, 0.2  # a key of `press` is down so long, and up so long before the next one
ROWS, COLUMNS = 3, 8  # of the switches
DIGITS = 4  # of a display, and of a set of thumbwheels
HEXADECIMAL = "0123456789ABCDEF"
ARROWS = ("down", "up", "right", "left")  # in the order in which ARWS has them
RETURN = "\r\n"


class Part(NamedTuple):
    """A part of the panel: its first terminals, and the points on them."""

    inputs: int  # X
    outputs: int  # Y
    says: tuple[Point, ...] = ()
    led: tuple[Point, ...] = ()


def _points(count: int, name: str, what: str) -> tuple[Point, ...]:
    return tuple(Point(f"{name}{place}", what.format(place)) for place in range(count))


PARTS = {
    "keys": Part(0o0, 0, _points(10, "Key", "single key {}")),
    "arrows": Part(0o14, 0, tuple(Point(f"Key{arrow.title()}", f"arrow key {arrow}") for arrow in ARROWS)),
    "keypad": Part(0o20, 0o14, _points(4, "PadCol", "keypad, column {}"), _points(4, "PadRow", "keypad, row {}")),
    "wheels": Part(0o30, 0o24, _points(8, "Wheel", "thumbwheels, bit {}"), _points(DIGITS, "WheelSt", "thumbwheels, strobe of digit {}")),
    "switches": Part(0o40, 0o20, _points(COLUMNS, "SwCol", "switches, column {}"), _points(ROWS, "SwRow", "switches, row {}")),
    "display": Part(
        0,
        0o0,
        led=(
            *_points(4, "Bit", "display, bit {} of the digit"),
            *_points(DIGITS, "Latch", "display, strobe of digit {}"),
            *_points(4, "SecBit", "second display, bit {} of the digit"),
        ),
    ),
    "printer": Part(
        0,
        0o30,
        led=(
            *_points(8, "Print", "printer, bit {} of the character"),
            Point("Strobe", "printer, takes the character"),
            Point("Busy", "at work"),
        ),
    ),
}


@dataclass
class OperatorPanel(Machine):
    """The panel, with the named parts: keys, arrows, keypad, wheels, switches, display, printer.

    `sets` is how many sets of four thumbwheels and how many displays there are, 1 or 2. `logic` is how the display wants its
    levels, as SEGL and ARWS count it: 1 strobes turned round, 2 bits turned round, 3 both.
    """

    DRIVES: ClassVar[tuple[str, ...]] = tuple(f"Y{part.outputs + place:o}" for part in PARTS.values() for place in range(len(part.led)))
    FAULTS: ClassVar[dict[str, str]] = {"no paper": "the printer prints nothing"}

    parts: tuple[str, ...] = tuple(PARTS)
    sets: int = 1
    logic: int = 0

    numbers: tuple[int, ...] = field(default=(0, 0), init=False)  # on the thumbwheels, a number for each set
    switches: tuple[bool, ...] = field(default=(False,) * (ROWS * COLUMNS), init=False)  # row after row
    pressed: frozenset[str] = field(default=frozenset(), init=False)  # the keys that are down: "keypad 7", "arrows up"
    digits: tuple[int | None, ...] = field(default=(None,) * (2 * DIGITS), init=False)  # latched, the units first; None is dark
    printed: str = field(default="", init=False)

    _held: frozenset[str] = field(default=frozenset(), init=False, repr=False)
    _ahead: tuple[tuple[float, float, str], ...] = field(default=(), init=False, repr=False)  # down from, up at, key
    _strobed: bool = field(default=False, init=False, repr=False)

    def __post_init__(self):
        self.parts = (self.parts,) if isinstance(self.parts, str) else tuple(self.parts)
        unknown = [part for part in self.parts if part not in PARTS]
        if unknown or not self.parts:
            raise EcsimError(f"parts {unknown}: a panel is made of one or more of {', '.join(PARTS)}")
        if self.sets not in (1, 2):
            raise EcsimError(f"{self.sets!r} sets of thumbwheels and displays; there can be 1 or 2")
        if self.logic not in range(4):
            raise EcsimError(f"logic {self.logic!r}; it is 0 to 3: 1 turns the strobes round, 2 the bits")
        self.wiring, self._said, self._led = {}, {}, {}
        for part in self.parts:
            inputs, outputs, says, led = PARTS[part]
            if self.sets == 1:
                says, led = says[: 4 if part == "wheels" else None], led[: 8 if part == "display" else None]
            self._said[part] = [f"X{inputs + place:o}" for place in range(len(says))]
            first = sum(device.startswith("Y") for device in self.wiring)
            self._led[part] = slice(first, first + len(led))
            self.wiring |= dict(zip(self._said[part], says, strict=True))
            self.wiring |= {f"Y{outputs + place:o}": point for place, point in enumerate(led)}
        self.DRIVES = tuple(device for device in self.wiring if device.startswith("Y"))
        self._driven = itemgetter(*self.DRIVES) if self.DRIVES else lambda outputs: ()
        super().__post_init__()

    # -- the operator -------------------------------------------------------------------------------------------

    def press(self, keys: str | Sequence[str], seconds: float = PRESS_S) -> None:
        """Press keys one after the other, each for so many seconds, behind those that are still to be pressed.

        "2057" and "1A" are keys of the keypad, or the single keys where there is no keypad; others are named: "up",
        "keys 7", ["left", "up"]. Raises EcsimError for a key that is not there.
        """
        if not isinstance(keys, (str, list, tuple)):
            raise EcsimError(f"{keys!r} is no text of keys; give '2057' or a list of names")
        several = [keys] if isinstance(keys, str) and (" " in keys or keys in ARROWS) else keys
        names = [self._key(key) for key in several]
        if not seconds > 0:
            raise EcsimError(f"a key is pressed for {seconds!r} s; it takes more than 0")
        start = max(self.seconds, self._ahead[-1][1] + PAUSE_S) if self._ahead else self.seconds
        turns = [(start + place * (seconds + PAUSE_S), name) for place, name in enumerate(names)]
        self._ahead += tuple((begin, begin + seconds, name) for begin, name in turns)
        self._settle()

    def hold(self, key: str) -> None:
        """Put a finger on a key until `release`; a switch ("switches 1 3") turns over, a wheel ("wheels 0 2 up") goes on by one.

        Raises EcsimError for a key that is not there.
        """
        part, *places = key.split() or [""]
        try:
            if part == "switches":
                return self.switch(*map(int, places))
            if part == "wheels":
                number, digit, way = int(places[0]), int(places[1]), {"up": 1, "down": -1}[places[2]]
                shown = self.numbers[number] // 10**digit % 10
                return self.turn(self.numbers[number] + ((shown + way) % 10 - shown) * 10**digit, number)
        except (ValueError, IndexError, KeyError, TypeError):
            raise EcsimError(f"the panel has no {key!r}; it is 'switches ROW COLUMN' or 'wheels SET DIGIT up'") from None
        self._held |= {self._key(key)}
        self._settle()

    def release(self, key: str) -> None:
        """Take the finger off a key; nothing happens where there was none."""
        if not key.startswith(("switches ", "wheels ")):
            self._held -= {self._key(key)}
            self._settle()

    def switch(self, row: int, column: int, on: bool | None = None) -> None:
        """Put a switch of the matrix, row 0 to 2 and column 0 to 7, on or off; without `on` it turns over."""
        self._need("switches")
        if row not in range(ROWS) or column not in range(COLUMNS):
            raise EcsimError(f"switch {row}, {column}; rows are 0 to {ROWS - 1}, columns 0 to {COLUMNS - 1}")
        place = COLUMNS * int(row) + int(column)
        level = not self.switches[place] if on is None else bool(on)
        self.switches = (*self.switches[:place], level, *self.switches[place + 1 :])
        self._settle()

    def turn(self, number: int, wheels: int = 0) -> None:
        """Turn the four thumbwheels of a set to a number, 0 to 9999."""
        self._need("wheels")
        if wheels not in range(self.sets) or not isinstance(wheels, int):
            raise EcsimError(f"set {wheels!r} of thumbwheels; the panel has {self.sets}, counted from 0")
        if not isinstance(number, int) or number not in range(10**DIGITS):
            raise EcsimError(f"{number!r} on four thumbwheels; they show 0 to 9999")
        self.numbers = (*self.numbers[:wheels], number, *self.numbers[wheels + 1 :])
        self._settle()

    def _need(self, part: str) -> None:
        if part not in self.parts:
            raise EcsimError(f"this panel has no {part}; it has {', '.join(self.parts)}")

    def _key(self, key: str) -> str:
        """The whole name of a key: its part and what stands on it."""
        part, _, name = str(key).rpartition(" ")
        for each, caps in (("keypad", HEXADECIMAL), ("keys", HEXADECIMAL[:10]), ("arrows", ARROWS)):
            if each in self.parts and part in ("", each) and name in tuple(caps):
                return f"{each} {name}"
        raise EcsimError(f"this panel has no key {key!r}; it has the parts {', '.join(self.parts)}")

    # -- what is seen -------------------------------------------------------------------------------------------

    def shown(self, display: int = 0) -> str:
        """The four places of a display as they are seen: a digit, or a space for what is dark."""
        places = self.digits[DIGITS * display : DIGITS * (display + 1)]
        return "".join(" " if digit is None or digit > 9 else str(digit) for digit in reversed(places))

    # -- the panel ----------------------------------------------------------------------------------------------

    def _plan(self):
        now = self.seconds + INSTANT
        self._ahead = tuple(each for each in self._ahead if each[1] > now)
        self.pressed = self._held | {key for begin, _, key in self._ahead if begin <= now}
        led = {part: self._outputs[places] for part, places in self._led.items()}
        if "display" in led:
            self._latch(led["display"])
        if "printer" in led:
            self._print(led["printer"])
        self.inputs = {
            device: level for part, devices in self._said.items() for device, level in zip(devices, self._say(part, led[part]), strict=True)
        }
        return min((at - self.seconds for begin, end, _ in self._ahead for at in (begin, end) if at > now), default=inf)

    def _say(self, part, led):
        """The levels of a part's inputs under its outputs."""
        if part == "keys":
            return [int(f"keys {key}" in self.pressed) for key in HEXADECIMAL[:10]]
        if part == "arrows":
            return [int(f"arrows {key}" in self.pressed) for key in ARROWS]
        if part == "keypad":
            return [
                int(any(led[row] and f"keypad {HEXADECIMAL[4 * row + column]}" in self.pressed for row in range(4))) for column in range(4)
            ]
        if part == "switches":
            return [int(any(led[row] and self.switches[COLUMNS * row + column] for row in range(ROWS))) for column in range(COLUMNS)]
        if part == "wheels":
            answers = [0] * self.sets
            for digit, strobe in enumerate(led):
                if strobe:
                    answers = [answer | number // 10**digit % 10 for answer, number in zip(answers, self.numbers, strict=False)]
            return [answer >> bit & 1 for answer in answers for bit in range(4)]
        return []

    def _latch(self, led):
        """A digit whose strobe is there shows the bits, and keeps them."""
        bits, strobes = (led[:4], led[8:]), led[4:8]
        shown = list(self.digits)
        for display in range(self.sets):
            digit = sum((bit ^ (self.logic >> 1)) << place for place, bit in enumerate(bits[display]))
            for place, strobe in enumerate(strobes):
                if strobe ^ (self.logic & 1):
                    shown[DIGITS * display + place] = digit
        self.digits = tuple(shown)

    def _print(self, led):
        """The character goes onto the paper as the strobe rises."""
        *bits, strobe, _ = led
        if strobe and not self._strobed and "no paper" not in self.faults:
            self.printed += bytes((sum(bit << place for place, bit in enumerate(bits)),)).decode("latin-1")
        self._strobed = bool(strobe)

    def lines(self) -> list[str]:
        """What is printed, line after line: a return or a line feed ends one."""
        return self.printed.replace(RETURN, "\n").replace("\r", "\n").split("\n")
