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


KEEP = 200_000  # changes; an hour of a signal that changes in every second scan of 10 ms


class Recording:
    """The values of some devices of a Plc after each scan. `names` may be devices or the program's names.

    Only changes are kept, each with its time: a second in which nothing happens costs nothing. Of very many the oldest go.
    """

    def __init__(self, plc: Plc, names: Iterable[str]):
        self.plc = plc
        self.names = [names] if isinstance(names, str) else list(names)
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
            if len(self.times) > KEEP:
                del self.times[: KEEP // 4], self.rows[: KEEP // 4]

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


class PulseTrain:
    """What a pulse output, "Y0" or "Y1", has put out so far: the time of every pulse and the frequency as a curve.

    The last 4,096 segments of even speed or even acceleration are kept; PWM is no train of counted pulses and not among them.
    """

    def __init__(self, plc: Plc, name: str):
        device, _ = plc.memory.parse(name, plc._names)
        if not isinstance(device, Device) or device.area != "Y" or device.number >= len(plc.outputs.axes):
            raise EcsimError(f"{name} is no pulse output; Y0 and Y1 are")
        self.name, self._outputs, self._number, self._clock = name, plc.outputs, device.number, plc.clock

    def __len__(self) -> int:
        return sum(segment.pulses for segment in self._outputs.trains(self._number, self._clock[0]))

    @property
    def times(self) -> "tuple[numpy.ndarray, numpy.ndarray]":
        """When each pulse turned ON and OFF, in seconds: two arrays of equal length."""
        import numpy

        pulses = numpy.array(self._outputs.times(self._number, self._clock[0]), dtype=float).reshape(-1, 2) / 1e6
        return pulses[:, 0], pulses[:, 1]

    @property
    def frequency(self) -> "tuple[numpy.ndarray, numpy.ndarray]":
        """The corners of the frequency curve: times in seconds and Hz, to be joined by straight lines."""
        import numpy

        curve = numpy.array(self._outputs.frequency(self._number, self._clock[0]), dtype=float).reshape(-1, 2)
        return curve[:, 0] / 1000, curve[:, 1]

    def plot(self, axes=None):
        """Draw the frequency over time into matplotlib axes, new ones without any given; gives the axes."""
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.subplots()[1]
        axes.plot(*self.frequency, label=self.name)
        axes.set(xlabel="s", ylabel="Hz", ylim=(0, None))
        return axes

    def __repr__(self) -> str:
        return f"<PulseTrain of {self.name}: {len(self)} pulses>"
