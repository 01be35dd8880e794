"""Signals over time: what chosen devices did, scan by scan, kept as changes."""

from collections.abc import Iterable
from operator import itemgetter
from typing import TYPE_CHECKING

from .devices import Device
from .errors import EcsimError
from .plc import Plc
from .values import BOOL

if TYPE_CHECKING:
    import numpy


class Recording:
    """The values of some devices of a Plc after each scan. `names` may be devices or the program's names.

    Only changes are kept, each with its time: a second in which nothing happens costs nothing.
    """

    def __init__(self, plc: Plc, names: Iterable[str]):
        self.plc = plc
        self.names = list(names)
        self._places: list[tuple[str, int]] = []
        for name in self.names:
            device, kind = plc.memory.parse(name, plc._names)
            if not isinstance(device, Device) or (kind.words == 2 and device.area != "C"):
                raise EcsimError(f"{name} cannot be recorded; name single bits and registers")
            self._places.append((f"{device.area}B" if kind is BOOL and device.area in ("T", "C") else device.area, device.number))
        self._generation = -1
        self.times: list[int] = []  # us
        self.rows: list[tuple] = []

    def _bind(self) -> None:
        """One getter for each list that is looked at, in the order of the names."""
        self._generation = self.plc.memory.generation
        groups: dict[str, list[int]] = {}
        for area, number in self._places:
            groups.setdefault(area, []).append(number)
        lists = self.plc.memory.lists
        self._getters = [(itemgetter(*numbers, numbers[0]), lists[area]) for area, numbers in groups.items()]
        flat = [(area, number) for area, numbers in groups.items() for number in (*numbers, numbers[0])]
        self._order = [flat.index(place) for place in self._places]
        self._last: list[tuple] | None = None

    def sample(self) -> None:
        """Note the present values if they have changed."""
        if self._generation != self.plc.memory.generation:
            self._bind()
        values = [getter(values) for getter, values in self._getters]
        if values != self._last:
            self._last = values
            flat = [value for group in values for value in group]
            self.times.append(self.plc.clock[0])
            self.rows.append(tuple(int(flat[place]) for place in self._order))

    def forget(self, time_us: int) -> None:
        """Drop what was noted after a moment (after a step back)."""
        while self.times and self.times[-1] > time_us:
            self.times.pop()
            self.rows.pop()
        self._generation = -1

    def changes(self, name: str) -> list[tuple[int, int]]:
        """The changes of one signal: (time in us, value), the first one its value at the beginning."""
        place = self._place(name)
        found: list[tuple[int, int]] = []
        for time, row in zip(self.times, self.rows, strict=True):
            if not found or found[-1][1] != row[place]:
                found.append((time, row[place]))
        return found

    def signal(self, name: str) -> "tuple[numpy.ndarray, numpy.ndarray]":
        """One signal as two arrays of equal length: times in seconds and values, each holding until the next."""
        import numpy

        changes = self.changes(name)
        return numpy.array([time for time, _ in changes]) / 1e6, numpy.array([value for _, value in changes])

    def _place(self, name: str) -> int:
        if name not in self.names:
            raise EcsimError(f"{name} is not recorded; recorded are {', '.join(self.names)}")
        return self.names.index(name)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<Recording of {', '.join(self.names)}: {len(self)} changes>"
