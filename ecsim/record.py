"""Signals over time: what chosen devices did, scan by scan or between the scans too, kept as changes and drawn as timing diagrams."""

import csv
import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable
from io import BytesIO, StringIO
from itertools import count, islice
from operator import eq, ge, gt, itemgetter, le, lt, ne
from pathlib import Path
from typing import TYPE_CHECKING

from .devices import Device
from .errors import EcsimError
from .hardware.pulses import Wired
from .hardware.unit import Unit
from .hardware.wire import Wire
from .plc import Plc
from .values import BOOL
from .views.svg import tokens

if TYPE_CHECKING:
    import numpy


STEPS = "S"  # the name that stands for all steps of the charts
PIN = 0.01  # of the diagram's width: a shorter pulse gets a pin
HEIGHT = 0.64  # of a signal in its row of a timing diagram
ROOM = 0.018  # of the diagram's width, for each character of a value that is written into it
UNITS = (("min", 60_000, 600_000), ("s", 1000, 10_000), ("ms", 1, 0))  # of a diagram's scale, its ms, and from what length on
LINES, LABELS = 50, 13  # so many scans are marked, and named, in a diagram
KEEP = 200_000  # changes; an hour of a signal that changes in every second scan of 10 ms


class Recording:
    """The values of some devices of a Plc after each scan. `names` may be devices or the program's names; "S" is all steps of the charts.

    Only changes are kept, each with its time: a second in which nothing happens costs nothing. Of very many the oldest go.
    The value of "S" is a number whose bit n tells whether the n-th of `steps` is active.
    """

    def __init__(self, plc: Plc, names: Iterable[str]):
        self.plc = plc
        self.names: list[str] = []
        self.steps: list[str] = []
        self.times: list[int] = []  # us
        self.rows: list[tuple] = []  # a value for each name, None from before it was added
        self._places: list[tuple[str, int]] = []
        self._corners: list[tuple[int, int]] = []  # (us, scan) where scans began to take another time
        self._seen: tuple[int, int] | None = None  # (us, scan) of the last look
        self._generation, self._program = -1, None
        for name in [names] if isinstance(names, str) else names:
            self.add(name)

    def add(self, name: str) -> None:
        """Record one more signal from now on."""
        if name in self.names:
            raise EcsimError(f"{name} is recorded already")
        if name == STEPS and name not in self.plc.names:
            place = (STEPS, -1)
        else:
            device, kind = self.plc.memory.parse(name, self.plc._names)
            if not isinstance(device, Device) or (kind.words == 2 and device.area != "C"):
                raise EcsimError(f"{name} cannot be recorded; name single bits and registers, or {STEPS} for the steps")
            place = f"{device.area}B" if kind is BOOL and device.area in ("T", "C") else device.area, device.number
        self.names.append(name)
        self._places.append(place)
        self.rows = [(*row, None) for row in self.rows]
        self._generation = -1

    def remove(self, name: str) -> None:
        """Record a signal no longer, and forget what was recorded of it."""
        place = self._place(name)
        del self.names[place], self._places[place]
        self.rows = [row[:place] + row[place + 1 :] for row in self.rows]
        self._generation = -1

    def _bind(self) -> None:
        """One getter for each list that is looked at, in the order of the names."""
        self._generation, self._program = self.plc.memory.generation, self.plc.program
        charted = [f"S{device.number}" for device in self.plc.in_use(("S",))] if (STEPS, -1) in self._places else []
        self.steps += [step for step in charted if step not in self.steps]
        of_steps = [("S", int(step[1:])) for step in self.steps]
        groups: dict[str, list[int]] = {}
        for area, number in (*self._places, *of_steps):
            if number >= 0:
                groups.setdefault(area, []).append(number)
        lists = self._lists()
        self._getters = [(itemgetter(*numbers, numbers[0]), lists[area]) for area, numbers in groups.items()]
        flat = [(area, number) for area, numbers in groups.items() for number in (*numbers, numbers[0])]
        charts = [flat.index(step) for step in of_steps]
        self._order = [[flat.index(place)] if place[1] >= 0 else charts for place in self._places]
        self._last: list[tuple] | None = None

    def _lists(self) -> dict[str, list]:
        """Where the values stand, by area."""
        return self.plc.memory.lists

    def sample(self) -> None:
        """Note the present values if they have changed."""
        plc = self.plc
        if self._generation != plc.memory.generation or self._program is not plc.program:
            self._bind()
        self._count()
        values = [getter(values) for getter, values in self._getters]
        if values != self._last:
            self._last = values
            flat = [value for group in values for value in group]
            self.times.append(plc.clock[0])
            self.rows.append(tuple(_together(flat, places) for places in self._order))
            if len(self.times) > KEEP:
                del self.times[: KEEP // 4], self.rows[: KEEP // 4]

    def _count(self) -> None:
        """Note when scans begin to take another time, so that each moment's scan is known."""
        now, scan = self.plc.clock[0], self.plc.scans
        if self._seen is None:
            self._corners.append((now, scan))
        elif scan != self._seen[1]:
            time, number = self._seen
            first_time, first = self._corners[-1]
            if (now - time) * (number - first) != (time - first_time) * (scan - number):
                self._corners.append(self._seen)
                if len(self._corners) > KEEP:
                    del self._corners[: KEEP // 4]
        else:
            return
        self._seen = now, scan

    def scan_at(self, time_us: float) -> int:
        """The scan that had ended last at a moment, by `Plc.scans`; beyond what was seen it goes on in the same pace."""
        if self._seen is None:
            return self.plc.scans
        points = self._corners if self._corners[-1] == self._seen else [*self._corners, self._seen]
        place = min(max(bisect_right(points, time_us, key=itemgetter(0)), 1), len(points) - 1)
        (begin, first), (end, last) = (
            points[place - 1 : place + 1] if len(points) > 1 else (points[0], (points[0][0] + self.plc.period_us, points[0][1] + 1))
        )
        return first + int((time_us - begin) * (last - first) // max(end - begin, 1))

    def forget(self, time_us: int) -> None:
        """Drop what was noted after a moment (after a step back)."""
        known = self._seen is not None and self._corners[0][0] <= time_us
        corner = (time_us, self.scan_at(time_us)) if known else None
        while self.times and self.times[-1] > time_us:
            self.times.pop()
            self.rows.pop()
        self._corners = [point for point in self._corners if known and point[0] < time_us]
        if corner:
            self._corners.append(corner)
        self._seen = corner
        self._generation = -1

    def changes(self, name: str, begin: int | None = None, end: int | None = None) -> list[tuple[int, int]]:
        """The changes of one signal: (time in us, value), the first one its value at the beginning.

        From `begin` to `end` in us, all without them; the first one may then have been noted before `begin`.
        """
        place = self._place(name)
        first = 0 if begin is None else max(0, bisect_right(self.times, begin) - 1)
        last = len(self.times) if end is None else bisect_right(self.times, end)
        found: list[tuple[int, int]] = []
        held = None
        for at in range(first, last):
            value = self.rows[at][place]
            if value != held:
                found.append((self.times[at], value))
                held = value
        return found

    def value(self, name: str, time_us: int) -> int | None:
        """A signal's value at a moment; None before it was recorded."""
        place, at = self._place(name), bisect_right(self.times, time_us) - 1
        return self.rows[at][place] if at >= 0 else None

    def edge(self, time_us: int, forward: bool = True, names: Iterable[str] | None = None) -> int | None:
        """The next moment, or the last one before, in which one of some signals changed (any without `names`); None if there is none."""
        places = [self._place(name) for name in (self.names if names is None else names)]
        at = max(1, bisect_right(self.times, time_us)) if forward else bisect_left(self.times, time_us) - 1
        while 0 < at < len(self.times):
            if any(self.rows[at][place] != self.rows[at - 1][place] for place in places):
                return self.times[at]
            at += 1 if forward else -1
        return None

    def when(self, condition: str) -> list[int]:
        """The moments in us in which a condition came true: "X1 rises", "D0 > 100 and X1", "not M0 and C0 changes".

        Terms are a bit, `not` a bit, a comparison (= <> < <= > >=) with a number, or a name with `rises`, `falls` or `changes`.
        """
        trigger = Trigger(self, condition)
        return [time for time, before, row in zip(self.times[1:], self.rows, self.rows[1:], strict=False) if trigger(before, row)]

    def in_words(self, name: str, value: int | None) -> str:
        """A value as text: the number, the active steps of "S", nothing where nothing was recorded."""
        if value is None:
            return ""
        if self._places[self._place(name)][1] < 0:
            return " ".join(step for place, step in enumerate(self.steps) if value >> place & 1)
        return str(value)

    def kind(self, name: str) -> str:
        """What a signal is: "bit", "word" or "steps"."""
        area, number = self._places[self._place(name)]
        if number < 0:
            return "steps"
        return "bit" if area not in self.plc.model.areas or self.plc.model.areas[area].kind == "bit" else "word"

    def signal(self, name: str) -> "tuple[numpy.ndarray, numpy.ndarray]":
        """One signal as two arrays of equal length: times in seconds and values, each holding until the next."""
        import numpy

        changes = self.changes(name)
        return numpy.array([time for time, _ in changes]) / 1e6, numpy.array([value for _, value in changes])

    # -- files --------------------------------------------------------------------------------------------------

    def save(self, path: str | Path) -> Path:
        """Write everything that was recorded into a file, by its ending: .csv (a row for each change), .vcd (for GTKWave) or .png."""
        path = Path(path)
        form = path.suffix.lower().removeprefix(".")
        path.write_bytes(self.export(form))
        return path

    def export(self, form: str, ms: tuple[float, float] | None = None) -> bytes:
        """What `save` writes: "csv", "vcd" or "png"; the picture alone may show a stretch of time."""
        if form not in ("csv", "vcd", "png"):
            raise EcsimError(f"a recording cannot be written as {form!r}; it can as csv, vcd or png")
        if form == "png":
            return self._png(ms)
        return (self._csv() if form == "csv" else self._vcd()).encode()

    def _csv(self) -> str:
        out = StringIO()
        table = csv.writer(out, lineterminator="\n")
        table.writerow(["time_s", "scan", *self.names])
        for time, row in zip(self.times, self.rows, strict=True):
            values = [self.in_words(name, value) for name, value in zip(self.names, row, strict=True)]
            table.writerow([f"{time / 1e6:.6f}", self.scan_at(time), *values])
        return out.getvalue()

    def _vcd(self) -> str:
        """IEEE 1364 18: bits and steps as wires, registers as integers, in us."""
        codes = (f"{chr(33 + n // 94)}{chr(33 + n % 94)}" for n in count())
        signals: list[tuple[str, str, Callable]] = []  # declaration, identifier, what makes a value of a row
        for place, name in enumerate(self.names):
            kind, spelled = self.kind(name), re.sub(r"\W", "_", name)
            parts = enumerate(self.steps) if kind == "steps" else [(0, spelled)]
            for bit, part in parts:
                width, sort = ("32", "integer") if kind == "word" else ("1", "wire")
                code = next(codes)
                signals.append((f"$var {sort} {width} {code} {part} $end", code, _vcd_value(place, bit, kind)))
        lines = ["$version ecsim $end", "$timescale 1 us $end", f"$scope module {self.plc.model.name} $end"]
        lines += [declaration for declaration, _, _ in signals] + ["$upscope $end", "$enddefinitions $end"]
        held: list[str] = [""] * len(signals)
        said = -1
        for time, row in zip(self.times, self.rows, strict=True):
            now = [make(row) for _, _, make in signals]
            changed = [value + code for value, before, (_, code, _) in zip(now, held, signals, strict=True) if value != before]
            if changed:
                first = not any(held)
                lines += [
                    *([f"#{time}"] if time != said else []),
                    *(["$dumpvars"] if first else []),
                    *changed,
                    *(["$end"] if first else []),
                ]
                said = time
            held = now
        return "\n".join([*lines, *([f"#{self.plc.clock[0]}"] if self.plc.clock[0] > said else []), ""])

    def _png(self, ms: tuple[float, float] | None) -> bytes:
        from matplotlib.figure import Figure

        picture = Figure(figsize=(11, 0.5 * len(self.names) + 0.9), layout="constrained")
        self.plot(picture.add_subplot(), ms)
        out = BytesIO()
        picture.savefig(out, format="png", dpi=150)
        return out.getvalue()

    # -- timing diagrams ----------------------------------------------------------------------------------------

    def plot(self, axes=None, ms: tuple[float, float] | None = None, cursors: tuple[float, float] | None = None):
        """Draw a timing diagram into matplotlib axes, new ones without any given; gives the axes.

        A row for each signal: bits as levels, with a pin for a pulse too short to be seen; registers as steps between their least
        and greatest value; steps as segments. `ms` is the stretch of simulated time to show, all that was recorded without it;
        `cursors` are two moments in ms, drawn as A and B with the time and the scans between them.
        """
        begin, end = ms or ((self.times[0] if self.times else 0) / 1000, self.plc.clock[0] / 1000)
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.subplots(figsize=(9.5, 0.5 * len(self.names) + 0.9), layout="constrained")[1]
        colour, rows = tokens(), len(self.names)
        for place, name in enumerate(self.names):
            self._row(axes, name, rows - 1 - place, begin, end, colour)
        _frame(axes, (begin, end), list(reversed(self.names)), colour)
        if cursors:
            self._cursors(axes, cursors, colour)
        return axes

    def _row(self, axes, name: str, base: float, begin: float, end: float, colour) -> None:
        """One signal of a timing diagram."""
        changes = [(max(begin, time / 1000), value) for time, value in self.changes(name) if time / 1000 <= end and value is not None]
        changes = [change for place, change in enumerate(changes) if place + 1 == len(changes) or changes[place + 1][0] > begin]
        if not changes:
            return
        kind = self.kind(name)
        times, values = [time for time, _ in changes], [value for _, value in changes]
        edges = [*times, end]
        style = {"ha": "center", "va": "center", "fontsize": 8, "clip_on": True}
        if kind == "steps":
            shown = [(time, later, self.in_words(name, value)) for time, later, value in zip(times, edges[1:], values, strict=True)]
            spans = [(time, later - time) for time, later, _ in shown]
            look = {"facecolor": colour["--ec-active-soft"], "edgecolor": colour["--ec-active"], "linewidth": 1.2}
            axes.broken_barh(spans, (base, HEIGHT), **look)
            for time, later, words in shown:
                if later - time > ROOM * (end - begin) * (len(words) + 0.5):
                    axes.text((time + later) / 2, base + HEIGHT / 2, words, color=colour["--ec-active-text"], weight="bold", **style)
            return
        low, high = (0, 1) if kind == "bit" else (min(values), max(values))
        levels = [base + HEIGHT * (value - low) / (high - low) if high > low else base for value in values]
        levels.append(levels[-1])
        if kind == "bit":
            axes.step(edges, levels, where="post", color=colour["--ec-dead"], linewidth=1)
            axes.fill_between(edges, base, levels, step="post", color=colour["--ec-on-soft"], linewidth=0)
            high_parts = [(time, later) for time, later, value in zip(times, edges[1:], values, strict=True) if value]
            if high_parts:
                axes.hlines([base + HEIGHT] * len(high_parts), *zip(*high_parts, strict=True), color=colour["--ec-on"], linewidth=2.2)
            pins = [time for time, later in high_parts if later - time < PIN * (end - begin)]
            if pins:
                axes.vlines(pins, base, base + HEIGHT, color=colour["--ec-on"], linewidth=1.8)
                axes.scatter(
                    pins, [base + HEIGHT] * len(pins), marker="v", s=22, color=colour["--ec-on"], linewidth=0, gid=f"pins of {name}"
                )
            return
        axes.step(edges, levels, where="post", color=colour["--ec-text"], linewidth=1.3)
        for time, later, value, level in zip(times, edges[1:], values, levels[:-1], strict=True):
            if later - time > ROOM * (end - begin) * (len(str(value)) + 0.5):
                style |= {
                    "va": "bottom",
                    "color": colour["--ec-text"],
                    "bbox": {"facecolor": colour["--ec-paper"], "edgecolor": "none", "pad": 0.4},
                }
                axes.text((time + later) / 2, level + 0.03, str(value), **style)

    def _cursors(self, axes, cursors: tuple[float, float], colour) -> None:
        """Two moments and what lies between them."""
        top, select = len(self.names), colour["--ec-select"]
        for letter, at, line in zip("AB", cursors, ("-", (0, (5, 3))), strict=True):
            axes.axvline(at, color=select, linewidth=1.2, linestyle=line)
            axes.annotate(letter, (at, top), (0, 14), textcoords="offset points", ha="center", fontsize=9, weight="bold", color=select)
        first, last = sorted(cursors)
        words = interval(1000 * (last - first), self.scan_at(1000 * last) - self.scan_at(1000 * first))
        middle = ((first + last) / 2, top)
        axes.annotate(words, middle, (0, 14), textcoords="offset points", ha="center", fontsize=9, weight="bold", color=select)

    def _place(self, name: str) -> int:
        if name not in self.names:
            raise EcsimError(f"{name} is not recorded; recorded are {', '.join(self.names)}")
        return self.names.index(name)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<Recording of {', '.join(self.names)}: {len(self)} changes>"


def _frame(axes, span: tuple[float, float], names: list[str], colour) -> None:
    """What all timing diagrams have around their rows, the lowest of them first."""
    from matplotlib import ticker

    unit, ms = next((unit, ms) for unit, ms, least in UNITS if span[1] - span[0] >= least)
    axes.set(xlim=span, ylim=(-0.2, len(names)), xlabel=unit)
    if ms > 1:
        axes.set_xticks([ms * tick for tick in ticker.MaxNLocator(9).tick_values(span[0] / ms, span[1] / ms)])
        axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda time, _: f"{time / ms:g}"))
        axes.set_xlim(span)
    axes.set_yticks([row + HEIGHT / 2 for row in range(len(names))], names)
    axes.tick_params(length=0, colors=colour["--ec-text-2"])
    axes.xaxis.label.set_color(colour["--ec-text-2"])
    axes.grid(axis="x", color=colour["--ec-hair"], linewidth=0.8)
    axes.set_axisbelow(True)
    axes.spines[:].set_visible(False)


def interval(us: float, scans: int) -> str:
    """A stretch of simulated time in words: "2.370 s · 237 scans"."""
    span = f"{us / 1e6:,.3f} s" if us >= 1e6 else f"{us / 1000:,.3f} ms".replace(".000", "")
    return f"{span} · {scans:,} scan{'' if scans == 1 else 's'}"


def _together(flat: list, places: list[int]) -> int:
    """One value, or several bits as one number."""
    return int(flat[places[0]]) if len(places) == 1 else sum(1 << bit for bit, place in enumerate(places) if flat[place])


def _vcd_value(place: int, bit: int, kind: str) -> Callable[[tuple], str]:
    """What writes one signal's value, before its identifier."""
    if kind == "word":
        return lambda row: f"b{row[place] & 0xFFFFFFFF:b} " if row[place] is not None else "bx "
    return lambda row: str(row[place] >> bit & 1) if row[place] is not None else "x"


TERM = re.compile(r"(not\s+)?([\w:]+)(?:\s+(rises|falls|changes)|\s*(<>|<=|>=|=|<|>)\s*(-?\d+))?", re.IGNORECASE)
EDGES: dict[str, Callable] = {"rises": lt, "falls": gt, "changes": ne}  # of the values before and now
COMPARISONS: dict[str, Callable] = {"=": eq, "<>": ne, "<": lt, "<=": le, ">": gt, ">=": ge}


class Trigger:
    """A condition over recorded signals, as `Recording.when` reads it. Called with two rows it tells whether the second makes it true."""

    def __init__(self, recording: Recording, text: str):
        self.text = " ".join(text.split())
        self.edges: list[tuple[int, Callable]] = []
        self.levels: list[tuple[int, Callable, int]] = []
        for term in re.split(r"\s+and\s+", self.text, flags=re.IGNORECASE):
            found = TERM.fullmatch(term)
            if not found or (found[1] and (found[3] or found[4])):
                raise EcsimError(f"{term!r} is no condition; write X1 rises, M0 falls, D0 changes, D0 > 100, X1 or not X1, joined by and")
            _, name, edge, comparison, goal = found.groups()
            spelled = {known.lower(): known for known in recording.names}
            place = recording._place(spelled.get(name.lower(), name))
            if edge:
                self.edges.append((place, EDGES[edge.lower()]))
            else:
                self.levels.append((place, COMPARISONS[comparison] if comparison else eq if found[1] else ne, int(goal or 0)))

    def __call__(self, before: tuple, row: tuple) -> bool:
        if not self._holds(row):
            return False
        if not self.edges:
            return not self._holds(before)
        return all(before[place] is not None and changed(before[place], row[place]) for place, changed in self.edges)

    def _holds(self, row: tuple) -> bool:
        return all(row[place] is not None and compare(row[place], goal) for place, compare, goal in self.levels)


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

    def _count(self) -> None:
        """`look` notes when each scan is executed."""

    def scan_at(self, time_us: float) -> int:
        """How many scans were executed up to a moment since it began to look."""
        return bisect_right(self.scans, time_us)

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

    def plot(self, axes=None, ms: tuple[float, float] | None = None, cursors: tuple[float, float] | None = None):
        """The timing diagram of a Recording; a line marks each scan where there are few, a triangle each run of interrupt programs."""
        axes = super().plot(axes, ms, cursors)
        begin, end = axes.get_xlim()
        colour, top = tokens(), len(self.names)
        scans = [time / 1000 for time in self.scans if begin <= time / 1000 <= end]
        if len(scans) <= LINES:  # more of them would hide the signals
            axes.vlines(scans, -0.2, top, color=colour["--ec-dead"], linewidth=1.1, linestyle=(0, (4, 3)), zorder=0)
        for time in scans if len(scans) <= LABELS else ():
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


def plot_line(wire: Wire, ms: tuple[float, float] | None = None, axes=None):
    """Draw who spoke when on a serial line into matplotlib axes, new ones without any given; gives the axes.

    A row for each end that has spoken, a bar for each message as long as it took, with as many of its bytes as there is room for. `ms` is the
    stretch of the wire's time to show, all of its log without it.
    """
    spans = [(begin / 1000, end / 1000, name, text) for begin, end, name, text in wire.spans]
    begin, end = ms or (min((span[0] for span in spans), default=0), max((span[1] for span in spans), default=1))
    shown = [span for span in spans if span[1] > begin and span[0] < end]
    names = sorted({name for _, _, name, _ in shown})
    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.subplots(figsize=(9.5, 0.5 * len(names) + 0.9), layout="constrained")[1]
    colour = tokens()
    for place, name in enumerate(reversed(names)):
        of_name = [span for span in shown if span[2] == name]
        look = {"facecolor": colour["--ec-active-soft"], "edgecolor": colour["--ec-active"], "linewidth": 1.2}
        axes.hlines(place + HEIGHT / 2, begin, end, color=colour["--ec-dead"], linewidth=1, zorder=0)
        axes.broken_barh([(first, last - first) for first, last, _, _ in of_name], (place, HEIGHT), **look)
        for first, last, _, text in of_name:
            words = bytes.fromhex(text).hex(" ").upper()
            room = int((last - first) / (0.5 * ROOM * (end - begin)))  # the characters that fit; they are narrow
            if len(words) > room:
                words = f"{words[: (room - 1) // 3 * 3]}…"
            if len(words) > 3:
                style = {"ha": "center", "va": "center", "fontsize": 8, "family": "monospace", "clip_on": True}
                axes.text((first + last) / 2, place + HEIGHT / 2, words, color=colour["--ec-active-text"], **style)
    _frame(axes, (begin, end), list(reversed(names)), colour)
    return axes
