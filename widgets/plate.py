"""The plate of a device: what it holds, and writing and forcing it. One for the unit, the ladder and the device table."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ecsim.devices import Device
from ecsim.errors import EcsimError
from ecsim.formats import FORMATS
from ecsim.values import BOOL

from .panel import Part
from .rig import Rig
from .table import Row, Signal, row_of

MOST = 8  # plates that may be open at a time; a page that went away leaves its own behind
EQUALS = ("decimal", "hex", "binary", "text")


class Plate:
    """A plate that is open: of what, what has been typed into it, and what became of the last thing that was asked."""

    def __init__(self, row: Row | Signal):
        self.row = row
        self.typed: str | None = None
        self.done = 0  # the number of the last request that was answered
        self.refused = ""

    def attempt(self, n: int, action: Callable[[], object]) -> None:
        """Do what request `n` asks for; what refuses it is told on the plate. A step back repeats actions and answers nobody."""
        try:
            action()
            refused = ""
        except EcsimError as error:
            refused = str(error)
        if n > self.done:
            self.done, self.refused = n, refused


class Plated(Part):
    """A part whose devices have plates. A frame has an entry "plate.<id>" for each one that is open; the page chooses the ids."""

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self._plates: dict[str, Plate] = {}

    def receive(self, verb, values):
        """Between two scans, since a frame may be made at any other moment."""
        with self.rig.session.held():
            return super().receive(verb, values)

    # -- what the page may do -----------------------------------------------------------------------------------

    def on_look(self, plate, device, look=None):
        """Open a plate for a device, "D0" or "T0:BOOL"; `look` is how its value is written."""
        row = row_of(self.rig.plc, device)
        if look is not None:
            row.look_as(look)
        self._plates.pop(plate, None)
        while len(self._plates) >= MOST:
            del self._plates[next(iter(self._plates))]
        self._plates[plate] = Plate(row)

    def on_leave(self, plate):
        """Close a plate."""
        self._plates.pop(plate, None)

    def on_typed(self, plate, text):
        """Something was typed: the plate tells what it would be, or why it cannot be read."""
        if shown := self._plates.get(plate):
            shown.typed = text
            shown.refused = ""

    def on_write(self, plate, n, text):
        """Write what was typed; an input that the machine drives is taken over."""
        if shown := self._plates.get(plate):
            shown.attempt(n, lambda: self._write(shown.row, shown.row.read(text)))

    def _write(self, row: Row | Signal, value: int | float | None) -> None:
        if isinstance(row, Signal):
            self.rig.signal(row.name, value)
        elif _is_input(row):
            self.rig.put(str(row.device), int(value))
        else:
            self.rig.session.set(row.name, value)

    def on_force(self, plate, n, text):
        """Force what was typed, whatever program and terminal say."""
        if shown := self._plates.get(plate):
            self._change(shown, n, lambda plc: self._force(plc, shown.row, text))

    def _force(self, plc: Any, row: Row | Signal, text: str) -> None:
        if isinstance(row, Signal):
            raise EcsimError(f"{row.name} is a terminal and cannot be forced; write the signal, or force the register that has its number")
        plc.force(row.name, row.read(text))

    def on_unforce(self, plate, n):
        """End forcing the device."""
        if shown := self._plates.get(plate):
            self._change(shown, n, lambda plc: plc.unforce(shown.row.name))

    def _change(self, shown: Plate, n: int, action: Callable[[Any], object]) -> None:
        self.rig.session.post(lambda plc: shown.attempt(n, lambda: action(plc)))

    # -- what a plate shows -------------------------------------------------------------------------------------

    def plates(self) -> dict[str, dict[str, Any]]:
        """The entries of the plates that are open."""
        return {f"plate.{key}": self._plate(shown) for key, shown in self._plates.items()}

    def _plate(self, shown: Plate) -> dict[str, Any]:
        row = shown.row
        name, what = self.rig.point(str(row.device))
        forced = self._forced(row)
        bit = row.kind is BOOL
        entry = {
            "device": str(row.device), "name": name, "what": what, "bit": bit, "look": row.look, "text": row.text(),
            "rows": self._lines(row, forced), "forced": forced, "done": shown.done, "refused": shown.refused, "equals": [],
        }  # fmt: skip
        if not bit:
            try:
                entry["equals"] = self._equals(row, row.value if shown.typed is None else row.read(shown.typed))
            except EcsimError as error:
                entry["refused"] = str(error)
        return entry

    def _forced(self, row: Row | Signal) -> str | None:
        """What the device itself is forced to, None when it is not."""
        if not isinstance(row, Row) or not isinstance(row.device, Device):
            return None
        name, numbers = self.rig.plc.memory.span(row.device, row.kind)
        forced = self.rig.plc.memory.forces().get(name, {})
        return row.text() if numbers[0] in forced and len(numbers) == 1 else None

    def _lines(self, row: Row | Signal, forced: str | None) -> list[list[str]]:
        """What the device holds, and where on its way: words and value, "F" before what is forced."""
        plc, shown = self.rig.plc, row.text() if forced is None else f"F {forced}"
        if isinstance(row, Signal):
            return [["at the terminal", f"{shown} {row.look}" if shown != "none" else "no signal"]]
        if _is_input(row):
            number = row.device.number
            own = plc.memory.send("X", number, 1)[0]
            return [
                ["at the terminal", str(int(plc.inputs.terminals[number]))],
                ["after the filter", str(int(own))],
                ["seen by the program", shown],
            ]
        words = {"Y": "at the output", "T": "contact" if row.kind is BOOL else "value", "C": "contact" if row.kind is BOOL else "value"}
        lines = [[words.get(row.device.area, "value"), shown]]
        if forced is not None:
            name, numbers = plc.memory.span(row.device, row.kind)
            own = plc.memory.send(name, numbers[0], 1)[0]
            lines.insert(0, ["the program says", row.text(int(own) if row.kind.signed or row.kind is BOOL else own & row.kind.high)])
        return lines

    def _equals(self, row: Row | Signal, value: int | float | None) -> list[list[str]]:
        """The same value in the other formats; a signal has none."""
        if isinstance(row, Signal):
            return []
        shapes = EQUALS if FORMATS["decimal"].suits(row.kind) else ("hex",)
        bits = row.bits(value)
        return [[fmt, FORMATS[fmt].text(value if fmt == "decimal" else bits, row.kind.stored)] for fmt in shapes]


def _is_input(row: Row | Signal) -> bool:
    return isinstance(row.device, Device) and row.device.area == "X"
