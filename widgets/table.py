"""Devices chosen to be watched: each with the format of its value, in the order that was asked for. It outlives the program that is loaded."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import count
from math import isnan, nan
from typing import Any, NamedTuple

from ecsim.devices import Bits, Device, number_text
from ecsim.errors import EcsimError
from ecsim.formats import FORMATS, usual
from ecsim.hardware.analog import Channel
from ecsim.values import BOOL, INT, REAL, DataType, join, words_from_real

MOST = 20_000  # rows of a table
OFFERED = 8  # completions at a time
OFFERED_ROWS = 200  # rows of a program that nobody has chosen
WAYS = ("decimal", "hex", "binary", "octal", "text")
_RANGE = re.compile(r"(?P<first>[^:]+?)\s*(?:-|\N{EN DASH}|\.\.)\s*(?P<last>[^:]+?)(?::(?P<type>\w+))?")
_BETWEEN = re.compile(r"[,;\s]+")


@cache
def looks(types: tuple[DataType, ...]) -> dict[str, tuple[DataType, str]]:
    """How a device that can be had as these types can be looked at, the usual way first: what it is called -> type and format."""
    found: dict[str, tuple[DataType, str]] = {}
    for kind in types:
        tail = " 32" if kind.bits == 32 and types[0] is INT else ""
        if kind is BOOL:
            found["bit" if types[0] is BOOL else "contact"] = kind, usual(kind)
        elif kind is REAL:
            found["real"] = kind, usual(kind)
        elif kind.signed:
            found |= {f"{fmt}{tail}": (kind, fmt) for fmt in WAYS}
        else:
            found[f"unsigned{tail}"] = kind, "decimal"
    return found


def menu_of(types: tuple[DataType, ...]) -> str:
    """A name for the ways in which devices of these types can be looked at."""
    return " ".join(kind.name for kind in types)


def menus(plc: Any) -> dict[str, list[str]]:
    """All the ways in which devices of this PLC can be looked at, by the name of their kind."""
    memory, areas = plc.memory, plc.model.areas.values()
    devices = [Device(area.name, number) for area in areas for number in (0, area.count - 1)] + [Bits(n, "M", 0) for n in (1, 8)]
    kinds = {memory.types(device) for device in devices}
    return {menu_of(types): list(looks(types)) for types in kinds}


def row_of(plc: Any, name: str) -> Row | Signal:
    """The row of a device, a name of the program or an analog terminal ("AI0:V"); raises EcsimError."""
    signal = _signal(plc, name)
    return Row(plc, *plc.memory.parse(name, plc._names)) if signal is None else signal


def signals(plc: Any) -> list[tuple[str, Channel]]:
    """The analog terminals by their names, one for each kind of signal: "AI1.0:V", "AI1.0:mA"."""
    return [(f"{channel.terminal}:{unit}", channel) for channel in plc.analog_channels for unit in channel.units]


def _signal(plc: Any, name: str) -> Signal | None:
    """The row of an analog terminal, in whatever case its name is written; None for other names. Raises EcsimError for one that is not there."""
    found = next((Signal(plc, known, channel) for known, channel in signals(plc) if known.casefold() == name.strip().casefold()), None)
    if found is None and plc.analog_point(name.strip()) is not None:
        raise EcsimError(f"{name} is no terminal of this PLC")
    return found


class Row:
    """One device, and as what it is looked at. The value is that of now."""

    def __init__(self, plc: Any, device: Device | Bits, kind: DataType, look: str | None = None):
        self.plc, self.device = plc, device
        self.types = plc.memory.types(device)
        if kind not in self.types:
            raise EcsimError(f"{device} cannot be had as {kind}; it is {', '.join(map(str, self.types))}")
        self._looks = looks(self.types)
        self.look = look or next(name for name, (its, fmt) in self._looks.items() if its is kind and fmt == usual(kind))
        self.kind, self.fmt = self._looks[self.look]

    @property
    def menu(self) -> str:
        """The name of the ways in which it can be looked at."""
        return menu_of(self.types)

    @property
    def name(self) -> str:
        """The device, with its type where that is not the usual one: "D0", "D0:REAL", "T0:BOOL"."""
        return str(self.device) if self.kind is self.types[0] else f"{self.device}:{self.kind}"

    def look_as(self, look: str) -> None:
        """Look at it in another way; raises EcsimError for one that does not suit it."""
        if look not in self._looks:
            raise EcsimError(f"{self.device} cannot be shown as {look!r}; choose {', '.join(self._looks)}")
        kind, fmt = self._looks[look]
        self.plc.memory.parse(f"{self.device}:{kind}")  # two registers: is there a second one?
        self.look, self.kind, self.fmt = look, kind, fmt

    @property
    def value(self) -> int | float:
        return self.plc.memory.get(self.device, self.kind)

    def text(self, value: int | float | None = None) -> str:
        """The value, or another one, as it is written."""
        return FORMATS[self.fmt].text(self.value if value is None else value, self.kind)

    def read(self, text: str) -> int | float:
        """The value that a text stands for; raises EcsimError in words."""
        return self.plc.memory.fitting(self.device, self.kind, FORMATS[self.fmt].read(text, self.kind))

    def bits(self, value: int | float | None = None) -> int:
        """The value, or another one, as the bits that make it up."""
        value = self.value if value is None else value
        return (join(*words_from_real(value)) if self.kind is REAL else value) & (1 << self.width) - 1

    @property
    def width(self) -> int:
        """How many bits it has."""
        return min(4 * self.device.digits, self.kind.bits) if isinstance(self.device, Bits) else self.kind.bits

    def forced(self, forces: dict[str, dict[int, int]]) -> bool:
        """Whether a part of it is forced; `forces` is what `Memory.forces` tells."""
        if not forces:
            return False
        name, numbers = self.plc.memory.span(self.device, self.kind)
        return not forces.get(name, {}).keys().isdisjoint(numbers)


class Terminal(NamedTuple):
    """An analog terminal as a device: "AI1.0"."""

    area: str
    number: tuple[int, int]  # the module's place, -1 for the base unit, and the channel
    words: str

    def __str__(self) -> str:
        return self.words


class Signal:
    """An analog terminal and one kind of signal on it, in volts, milliamperes or degrees. It is a row like that of a device."""

    kind, width = REAL, 0  # a number with a fraction, without bits

    def __init__(self, plc: Any, name: str, channel: Channel):
        self.plc, self.name = plc, name
        self.look = self.menu = name.partition(":")[2]
        self.device = Terminal(channel.terminal[:2], (channel.place, channel.number), channel.terminal)

    def look_as(self, look: str) -> None:
        """It has one look; raises EcsimError for another."""
        if look != self.look:
            raise EcsimError(f"{self.name} cannot be shown as {look!r}; add {self.device} in another unit as a row of its own")

    @property
    def value(self) -> float:
        """The signal; not a number where there is none of this kind, or no module any more."""
        try:
            found = self.plc[self.name]
        except EcsimError:
            return nan
        return nan if found is None else found

    def text(self, value: float | None = None) -> str:
        """The signal, or another one, as it is written."""
        value = self.value if value is None else value
        return "none" if isnan(value) else f"{value:.6g}"

    def read(self, text: str) -> float | None:
        """The signal that a text stands for, None for "none"; raises EcsimError in words."""
        if text.strip().casefold() in ("", "none"):
            return None
        value = float(f"{FORMATS['float'].read(text, REAL):.7g}")  # the digits that were typed, not the nearest REAL
        self.plc.analog_point(self.name).check(value)
        return value

    def bits(self, value: float | None = None) -> int:
        return 0

    def forced(self, forces: dict[str, dict[int, int]]) -> bool:
        return False


class Table:
    """The rows by their number, which a row keeps; found, sorted and filtered as asked."""

    def __init__(self, plc: Any, about: Callable[[str], tuple[str, str]]):
        self.plc, self.about = plc, about
        self.rows: dict[int, Row | Signal] = {}
        self._numbers = count(1)
        self._there: dict[str, int] = {}
        self.find, self.sort, self.down, self.only = "", "", False, ""
        self._chosen = False
        self._order: list[int] | None = None
        self._before: dict[int, int | float] = {}  # values since when changes are told
        self._changed: set[int] = set()
        self._taken: dict[int, Row | Signal] = {}  # what was cleared away last

    # -- rows ---------------------------------------------------------------------------------------------------

    def follow_program(self) -> None:
        """As long as nobody has chosen, the table has what the program names, or else what it uses."""
        if not self._chosen:
            self.remove(list(self.rows))
            plc = self.plc
            names = list(plc.names) or [str(device) for device in plc.in_use([area for area in plc.model.areas if area != "S"])]
            for name in names[:OFFERED_ROWS]:
                self._take_up([Row(plc, *plc.memory.parse(name))])

    def add(self, text: str) -> list[int]:
        """Add devices, names and ranges, as in "Start D0 D100-D120:REAL"; gives their rows, also those that were there.

        Raises EcsimError when one of them cannot be added; then none is.
        """
        found = [row for part in filter(None, _BETWEEN.split(text.strip())) for row in self._part(part)]
        if not found:
            raise EcsimError("name a device, such as D0, a range, such as D0-D99, or a name of the program")
        new = {row.name for row in found}.difference(self._there)
        if len(self.rows) + len(new) > MOST:
            raise EcsimError(f"a table holds {MOST:,} devices; {text!r:.40} would make it {len(self.rows) + len(new):,}")
        self._chosen = True
        self._take_up(found)
        return [self._there[row.name] for row in found]

    def _take_up(self, rows: list[Row | Signal]) -> None:
        for row in rows:
            if row.name not in self._there:
                number = self._there[row.name] = next(self._numbers)
                self.rows[number] = row
        self._order = None

    def _part(self, text: str) -> Iterator[Row | Signal]:
        signal = _signal(self.plc, text)
        if signal is not None:
            yield signal
            return
        spread = _RANGE.fullmatch(text)
        if spread is None:
            yield Row(self.plc, *self._parse(text))
            return
        tail = f":{spread['type']}" if spread["type"] else ""
        first, kind = self._parse(spread["first"] + tail)
        last, _ = self._parse((spread["last"] if not spread["last"].isdigit() else f"{first.area}{spread['last']}") + tail)
        if isinstance(first, Bits) or isinstance(last, Bits) or first.area != last.area or last.number < first.number:
            raise EcsimError(f"{text!r:.40} is no range; write D0-D99 or X0-X17")
        step = kind.words if kind.words == 2 and self.plc.model.areas[first.area].kind == "word" else 1
        for number in range(first.number, last.number + 1, step):
            device = Device(first.area, number)
            yield Row(self.plc, device, kind if spread["type"] else self.plc.memory.types(device)[0])

    def _parse(self, name: str) -> tuple[Device | Bits, DataType]:
        return self.plc.memory.parse(name, self.plc._names)

    def remove(self, numbers: Iterable[int]) -> None:
        """Take rows out."""
        for number in numbers:
            row = self.rows.pop(number, None)
            if row is not None:
                del self._there[row.name]
        self._order = None

    def clear(self) -> None:
        """Take all rows out; `put_back` brings them again."""
        self._taken = dict(self.rows)
        self._chosen = True
        self.remove(list(self.rows))

    @property
    def can_put_back(self) -> bool:
        return bool(self._taken) and not self.rows

    def put_back(self) -> None:
        """Undo `clear`."""
        if self.can_put_back:
            self.rows, self._taken = self._taken, {}
            self._there = {row.name: number for number, row in self.rows.items()}
            self._order = None

    def look_as(self, number: int, look: str) -> None:
        """Show a row in another format; raises EcsimError for one that does not suit it."""
        row = self.rows[number]
        before = row.name
        row.look_as(look)
        self._there.pop(before, None)
        self._there[row.name] = number
        self._order = None

    # -- order --------------------------------------------------------------------------------------------------

    def arrange(self, find: str = "", sort: str = "", down: bool = False, only: str = "") -> None:
        """Show rows that have `find` in device, name or comment, by "device", "name" or "value" (of this moment), "" as added.

        `only` is "changed", since now, "forced" or "" for all.
        """
        if only == "changed" and self.only != "changed":
            self._before = {number: row.value for number, row in self.rows.items()}
            self._changed = set()
        self.find, self.sort, self.down, self.only = find, sort, down, only
        self._order = None

    def order(self) -> list[int]:
        """The numbers of the rows that are shown."""
        if self._order is None:
            self._order = self._arranged()
        return self._order

    def look_again(self) -> None:
        """See what has changed or is forced by now, if only that is shown."""
        if self.only == "changed":
            values = self._before
            changed = {number for number, row in self.rows.items() if _differ(values.setdefault(number, row.value), row.value)}
            if not changed <= self._changed:
                self._changed |= changed
                self._order = None
        elif self.only == "forced":
            self._order = None

    def _arranged(self) -> list[int]:
        rows: list[tuple[int, Row | Signal]] = list(self.rows.items())
        if self.only == "changed":
            rows = [(number, row) for number, row in rows if number in self._changed]
        elif self.only == "forced":
            forces = self.plc.memory.forces()
            rows = [(number, row) for number, row in rows if row.forced(forces)]
        if self.find:
            sought = self.find.casefold()
            rows = [(number, row) for number, row in rows if sought in " ".join((str(row.device), *self.about(str(row.device)))).casefold()]
        if self.sort:
            rows.sort(key=lambda pair: self._rank(pair[1]), reverse=self.down)
        return [number for number, _ in rows]

    def _rank(self, row: Row | Signal) -> tuple:
        device = row.device
        place = device.area, isinstance(device, Bits), device.number
        if self.sort == "value":
            return (float("-inf") if row.value != row.value else row.value), place
        name = self.about(str(device))[0] if self.sort == "name" else ""
        return not name, name.casefold(), place

    # -- completion ---------------------------------------------------------------------------------------------

    def offers(self, text: str) -> list[tuple[str, str, str]]:
        """What the last word of a text may become: (what is added, its device or "", what it is)."""
        word = _BETWEEN.split(text)[-1]
        if not word:
            return []
        found: dict[str, tuple[str, str, str]] = {}
        begins = word.casefold()
        for device, name in self.plc.names.items():
            if name.casefold().startswith(begins):
                found.setdefault(name, (name, device, self.about(device)[1]))
        for device in map(str, self.plc.in_use(tuple(self.plc.model.areas))):
            if device.casefold().startswith(begins):
                found.setdefault(device, (device, *self.about(device)))
        for signal, channel in signals(self.plc):
            if signal.casefold().startswith(begins):
                found.setdefault(
                    signal, (signal, "", self.about(channel.terminal)[0] or f"analog {'output' if channel.output else 'input'}")
                )
        for offer in (self._itself(word), self._area(word)):
            if offer is not None:
                found.setdefault(offer[0], offer)
        return list(found.values())[:OFFERED]

    def _itself(self, word: str) -> tuple[str, str, str] | None:
        try:
            rows = list(self._part(word))
        except EcsimError:
            return None
        name, what = self.about(str(rows[0].device))
        return (rows[0].name, name, what) if len(rows) == 1 else (word.upper(), "", f"{len(rows):,} devices")

    def _area(self, word: str) -> tuple[str, str, str] | None:
        area = self.plc.model.areas.get(word.upper())
        if area is None:
            return None
        count = area.end(0)  # of M those that come before a hole
        return f"{area.name}0-{area.name}{number_text(area.name, count - 1)}", "", f"all {count:,} of them"


def _differ(one: float, other: float) -> bool:
    """Whether two values differ; no signal is as good as no signal."""
    return one != other and not (one != one and other != other)
