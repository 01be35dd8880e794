"""Signals over time: what chosen devices did, scan by scan or between the scans too, kept as changes and drawn as timing diagrams."""

from collections.abc import Iterable
from itertools import islice
from operator import itemgetter
from typing import TYPE_CHECKING

from .devices import Device
from .errors import EcsimError
from .hardware.pulses import Wired
from .hardware.unit import Unit
from .plc import Plc
from .values import BOOL
from .views.svg import tokens

if TYPE_CHECKING:
    import numpy


HEIGHT = 0.64  # of a signal in its row of a timing diagram
ROOM = 0.018  # of the diagram's width, for each character of a value that is written into it
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
        lists = self._lists()
        self._getters = [(itemgetter(*numbers, numbers[0]), lists[area]) for area, numbers in groups.items()]
        flat = [(area, number) for area, numbers in groups.items() for number in (*numbers, numbers[0])]
        self._order = [flat.index(place) for place in self._places]
        self._last: list[tuple] | None = None

    def _lists(self) -> dict[str, list]:
        """Where the values stand, by area."""
        return self.plc.memory.lists

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

    def plot(self, axes=None, ms: tuple[float, float] | None = None):
        """Draw a timing diagram into matplotlib axes, new ones without any given; gives the axes.

        A row for each device: bits as levels, registers as steps between their least and greatest value. `ms` is the stretch of
        simulated time to show, all that was recorded without it.
        """
        from matplotlib import pyplot

        begin, end = ms or ((self.times[0] if self.times else 0) / 1000, self.plc.clock[0] / 1000)
        if axes is None:
            axes = pyplot.subplots(figsize=(9.5, 0.5 * len(self.names) + 0.9), layout="constrained")[1]
        colour, rows = tokens(), len(self.names)
        for place, name in enumerate(self.names):
            self._row(axes, name, rows - 1 - place, begin, end, colour)
        ink, hair = colour["--ec-text-2"], colour["--ec-hair"]
        axes.set(xlim=(begin, end), ylim=(-0.2, rows), xlabel="ms")
        axes.set_yticks([row + HEIGHT / 2 for row in range(rows)], reversed(self.names))
        axes.tick_params(length=0, colors=ink)
        axes.xaxis.label.set_color(ink)
        axes.grid(axis="x", color=hair, linewidth=0.8)
        axes.set_axisbelow(True)
        axes.spines[:].set_visible(False)
        return axes

    def _row(self, axes, name: str, base: float, begin: float, end: float, colour) -> None:
        """One signal of a timing diagram."""
        changes = [(max(begin, time / 1000), value) for time, value in self.changes(name) if time / 1000 <= end]
        changes = [change for place, change in enumerate(changes) if place + 1 == len(changes) or changes[place + 1][0] > begin]
        if not changes:
            return
        times, values = [time for time, _ in changes], [value for _, value in changes]
        area, _ = self._places[self._place(name)]
        bit = area not in self.plc.model.areas or self.plc.model.areas[area].kind == "bit"
        low, high = (0, 1) if bit else (min(values), max(values))
        levels = [base + HEIGHT * (value - low) / (high - low) if high > low else base for value in values]
        line = colour["--ec-on"] if bit else colour["--ec-active"]
        soft = colour["--ec-on-soft"] if bit else colour["--ec-active-soft"]
        edges, levels = [*times, end], [*levels, levels[-1]]
        axes.fill_between(edges, base, levels, step="post", color=soft, linewidth=0)
        axes.step(edges, levels, where="post", color=line, linewidth=1.3)
        if not bit:
            for time, later, value, level in zip(times, edges[1:], values, levels[:-1], strict=True):
                if later - time > ROOM * (end - begin) * (len(str(value)) + 0.5):
                    style = {"ha": "center", "va": "bottom", "fontsize": 8, "color": colour["--ec-active-text"], "clip_on": True}
                    style["bbox"] = {"facecolor": colour["--ec-paper"], "edgecolor": "none", "pad": 0.4}
                    axes.text((time + later) / 2, level + 0.03, str(value), **style)

    def _place(self, name: str) -> int:
        if name not in self.names:
            raise EcsimError(f"{name} is not recorded; recorded are {', '.join(self.names)}")
        return self.names.index(name)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<Recording of {', '.join(self.names)}: {len(self)} changes>"


class LogicAnalyser(Recording, Unit):
    """A Recording that also looks between two scans: at each edge of an input and of a pulse output and behind each event, to the microsecond.

    X is what the terminals hold, not the image that the program sees. It works from its making to `stop` and slows the
    simulation down: nothing is skipped any longer.
    """

    rank = 9  # behind all other units of a moment

    def __init__(self, plc: Plc, names: Iterable[str]):
        Recording.__init__(self, plc, names)
        Unit.__init__(self, plc._awake)
        self.scans: list[int] = []  # when main programs were executed, in us
        self.interrupts: list[int] = []  # when interrupt programs were
        self._scan = -1
        self._outputs = [Wired(plc.outputs, axis.number) for axis in plc.outputs.axes]
        self.wake()
        self.sample()

    def _lists(self) -> dict[str, list]:
        return {**self.plc.memory.lists, "X": self.plc.inputs.terminals}

    def look(self, now: int) -> None:
        (self.interrupts if self._scan == self.plc.scans else self.scans).append(now)
        self._scan = self.plc.scans

    def next(self, until: int) -> int | None:
        self.sample()
        signals = [*self.plc.inputs.signals.values(), *self._outputs]
        due = min((moment for signal in signals for moment, _ in islice(signal.edges(self.plc.clock[0]), 1)), default=until + 1)
        return due if due <= until else None

    def stop(self) -> None:
        """Look no longer; what was recorded stays."""
        self.sample()
        self.wake(False)

    def plot(self, axes=None, ms: tuple[float, float] | None = None):
        """The timing diagram of a Recording; a line marks each scan, a triangle each run of interrupt programs."""
        axes = super().plot(axes, ms)
        begin, end = axes.get_xlim()
        colour, top = tokens(), len(self.names)
        scans = [time / 1000 for time in self.scans if begin <= time / 1000 <= end]
        axes.vlines(scans, -0.2, top, color=colour["--ec-dead"], linewidth=1.1, linestyle=(0, (4, 3)), zorder=0)
        for time in scans:
            axes.annotate("scan", (time, top), (0, 3), textcoords="offset points", ha="center", fontsize=8, color=colour["--ec-text-2"])
        calls = [time / 1000 for time in self.interrupts if begin <= time / 1000 <= end]
        axes.plot(calls, [top - 0.08] * len(calls), "v", color=colour["--ec-fault"], markersize=5, clip_on=False)
        return axes


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

            axes = pyplot.subplots(figsize=(9.5, 2.8), layout="constrained")[1]
        colour = tokens()
        times, hertz = self.frequency
        axes.fill_between(times, hertz, color=colour["--ec-on-soft"], linewidth=0)
        axes.plot(times, hertz, label=self.name, color=colour["--ec-on"], linewidth=1.5)
        axes.set(xlabel="s", ylabel="Hz", ylim=(0, None))
        axes.grid(color=colour["--ec-hair"], linewidth=0.8)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.spines[["left", "bottom"]].set_color(colour["--ec-dead"])
        axes.tick_params(color=colour["--ec-dead"], labelcolor=colour["--ec-text-2"])
        return axes

    def __repr__(self) -> str:
        return f"<PulseTrain of {self.name}: {len(self)} pulses>"
