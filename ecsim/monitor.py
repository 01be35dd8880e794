"""The device monitor (2.4.6): chosen devices with type, format, value and whether they are forced, read when they are looked at."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from .devices import Bits, Device
from .errors import EcsimError
from .formats import FORMATS, usual
from .values import DataType

if TYPE_CHECKING:
    from .plc import Plc


@dataclass
class Row:
    """One device of a monitor. `fmt` may be changed; value, text and forced are those of now."""

    plc: Plc
    asked: str
    device: Device | Bits
    type: DataType
    chosen: str

    @property
    def fmt(self) -> str:
        """How the value is written: decimal, hex, binary, octal, float or text."""
        return self.chosen

    @fmt.setter
    def fmt(self, name: str) -> None:
        if name not in FORMATS or not FORMATS[name].suits(self.type):
            suits = [each for each, format_ in FORMATS.items() if format_.suits(self.type)]
            raise EcsimError(f"{self.asked} is {self.type.name} and cannot be shown as {name!r}; choose {', '.join(suits)}")
        self.chosen = name

    @property
    def symbol(self) -> str:
        """The name that the program gives the device, "" for none."""
        return self.plc.names.get(str(self.device), "")

    @property
    def comment(self) -> str:
        """What the program's variable table says of it."""
        return next((v.comment for v in self.plc.program.variables.values() if v.name == self.symbol), "")

    @property
    def value(self) -> int | float:
        return self.plc.memory.get(self.device, self.type)

    @property
    def text(self) -> str:
        """The value in the row's format."""
        return FORMATS[self.fmt].text(self.value, self.type)

    @property
    def forced(self) -> bool:
        """Whether one of its bits or registers is forced."""
        name, numbers = self.plc.memory.span(self.device, self.type)
        return not self.plc.memory.forces().get(name, {}).keys().isdisjoint(numbers)

    @property
    def cells(self) -> tuple[str, ...]:
        """The row in words: device, name, type, format, value, forced, comment."""
        forced = "forced" if self.forced else ""
        return str(self.device), self.symbol, self.type.name, self.fmt, self.text, forced, self.comment


class Monitor:
    """A table of devices; iterate over its rows, or take one by name. Printed or shown it has the values of that moment."""

    HEADINGS = ("device", "name", "type", "format", "value", "forced", "comment")
    face: ClassVar[Callable[[Monitor], str] | None] = None  # its HTML for a notebook; the views stand above and are named here

    def __init__(self, plc: Plc, names: tuple[str, ...], fmt: str | dict[str, str] | None):
        self.plc = plc
        self.rows: list[Row] = []
        chosen = fmt if isinstance(fmt, dict) else dict.fromkeys(names, fmt) if fmt is not None else {}
        unknown = [name for name in chosen if name not in names]
        if unknown:
            raise EcsimError(f"fmt names {unknown[0]!r}, which is not in the table; it has {', '.join(names) or 'no rows'}")
        for name in names:
            self.add(name, chosen.get(name))

    def add(self, name: str, fmt: str | None = None) -> Row:
        """One more row."""
        device, kind = self.plc.memory.parse(name, self.plc._names)
        row = Row(self.plc, name, device, kind, usual(kind))
        if fmt is not None:
            row.fmt = fmt
        self.rows.append(row)
        return row

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, name: str) -> Row:
        for row in self.rows:
            if name.casefold() in (row.asked.casefold(), str(row.device).casefold(), row.symbol.casefold()):
                return row
        raise EcsimError(f"{name!r} is not in the table; it has {', '.join(row.asked for row in self.rows) or 'no rows'}")

    def _repr_html_(self) -> str | None:
        return self.face() if self.face else None

    def __repr__(self) -> str:
        lines = [self.HEADINGS, *(row.cells for row in self.rows)]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines)
