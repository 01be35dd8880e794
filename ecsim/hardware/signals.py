"""Signals on an input over time: pulse trains in closed form, recorded or computed edges, bounce.

A signal answers three questions without stepping through its edges: its level at a moment, how many edges of one sense
lie in a stretch of time, and when the n-th of them comes; `edges` steps where that is wanted. Times are whole
microseconds; a stretch (a, b] leaves out its begin. Several edges may fall on one microsecond: they keep their order, and
the level is that behind the last. `end` is the moment from which nothing changes, None for a signal without end.
"""

import itertools
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

from ..errors import EcsimError

PARTS = 1000  # a phase is given in so many parts of a period
STEADY = 3  # so many intervals tell all that a pulse train has


class Signal(Protocol):
    """What an input needs to know of a signal."""

    @property
    def end(self) -> int | None: ...
    @property
    def intervals(self) -> int: ...
    @property
    def hertz(self) -> float: ...
    def level(self, moment: int) -> bool: ...
    def edges(self, after: int) -> Iterator[tuple[int, bool]]: ...
    def count(self, rising: bool, after: int, until: int) -> int: ...
    def time(self, rising: bool, after: int, n: int) -> int | None: ...
    def before(self, moment: int) -> int | None: ...


@dataclass(frozen=True, slots=True)
class Train:
    """Equal pulses: `pulses` of them take `span` us; OFF at first, ON from phase `rise` to phase `fall` of each period."""

    start: int
    span: int
    pulses: int
    total: int | None = None  # all pulses, None without end
    rise: int = PARTS // 4
    fall: int = 3 * PARTS // 4

    @property
    def end(self) -> int | None:
        return None if self.total is None else self._at(self.total - 1, self.fall) if self.total else self.start

    def _at(self, index: int, phase: int) -> int:
        return self.start + (PARTS * index + phase) * self.span // (PARTS * self.pulses)

    def _until(self, phase: int, moment: int) -> int:
        """How many edges of a phase lie at or before a moment."""
        if moment < self.start:
            return 0
        place = ((moment - self.start + 1) * PARTS * self.pulses - 1) // self.span
        n = (place - phase) // PARTS + 1
        return max(0, n if self.total is None else min(n, self.total))

    def level(self, moment: int) -> bool:
        return self._until(self.rise, moment) > self._until(self.fall, moment)

    def edges(self, after: int) -> Iterator[tuple[int, bool]]:
        """Every edge after a moment, as (moment, level)."""
        index = self._until(self.fall, after)
        if self._until(self.rise, after) > index:
            yield self._at(index, self.fall), False
            index += 1
        while index != self.total:
            yield self._at(index, self.rise), True
            yield self._at(index, self.fall), False
            index += 1

    def before(self, moment: int) -> int | None:
        """The last edge at or before a moment."""
        rises, falls = self._until(self.rise, moment), self._until(self.fall, moment)
        if not rises:
            return None
        return self._at(rises - 1, self.rise) if rises > falls else self._at(falls - 1, self.fall)

    def count(self, rising: bool, after: int, until: int) -> int:
        phase = self.rise if rising else self.fall
        return self._until(phase, until) - self._until(phase, after)

    def time(self, rising: bool, after: int, n: int) -> int | None:
        phase = self.rise if rising else self.fall
        index = self._until(phase, after) + n - 1
        return None if self.total is not None and index >= self.total else self._at(index, phase)

    @property
    def intervals(self) -> int:
        """How many intervals, from the last one back, tell all that there is."""
        return STEADY

    @property
    def hertz(self) -> float:
        """Pulses a second."""
        return 1e6 * self.pulses / self.span


@dataclass(frozen=True, slots=True)
class Edges:
    """A recorded or computed signal: it changes at each of `times` (in order of time) and begins at `first`."""

    times: tuple[int, ...]
    first: bool = False

    @property
    def end(self) -> int:
        return self.times[-1] if self.times else 0

    def _from(self, rising: bool) -> int:
        """The index of the first edge of a sense; every second one from there on is of the same."""
        return int(rising is self.first)

    def level(self, moment: int) -> bool:
        return self.first ^ bool(bisect_right(self.times, moment) & 1)

    def edges(self, after: int) -> Iterator[tuple[int, bool]]:
        """Every edge after a moment, as (moment, level)."""
        for place in range(bisect_right(self.times, after), len(self.times)):
            yield self.times[place], self.first ^ (place & 1 == 0)

    def before(self, moment: int) -> int | None:
        place = bisect_right(self.times, moment)
        return self.times[place - 1] if place else None

    def _until(self, rising: bool, moment: int) -> int:
        return max(0, bisect_right(self.times, moment) - self._from(rising) + 1) // 2

    def count(self, rising: bool, after: int, until: int) -> int:
        return self._until(rising, until) - self._until(rising, after)

    def time(self, rising: bool, after: int, n: int) -> int | None:
        place = self._from(rising) + 2 * (self._until(rising, after) + n - 1)
        return self.times[place] if place < len(self.times) else None

    @property
    def intervals(self) -> int:
        return len(self.times) + 1

    @property
    def hertz(self) -> float:
        """The rate of the two rising edges that stand closest."""
        rises = self.times[self._from(True) :: 2]
        gaps = [b - a for a, b in itertools.pairwise(rises)]
        return 1e6 / max(1, min(gaps)) if gaps else 0.0


def quadrature(start: int, span: int, cycles: int, count: int | None, direction: int) -> tuple[Train, Train]:
    """Two trains a quarter period apart: A leads for direction 1, B for -1."""
    lead = Train(start, span, cycles, count, PARTS // 8, 5 * PARTS // 8)
    lag = Train(start, span, cycles, count, 3 * PARTS // 8, 7 * PARTS // 8)
    return (lead, lag) if direction > 0 else (lag, lead)


def changes(points: Iterable[tuple[float, int]], start: int, first: bool) -> Edges:
    """A signal from (ms after `start`, level) points, in order of time; points that change nothing are passed over.

    Raises EcsimError for a point before `start` or before the one in front of it.
    """
    times: list[int] = []
    level, before = first, 0.0
    for ms, value in points:
        if not ms >= before:
            raise EcsimError(f"a signal has a point at {ms!r} ms behind one at {before:g} ms; give its points in order of time, from 0 on")
        before = ms
        if bool(value) != level:
            times.append(start + round(ms * 1000))
            level = bool(value)
    return Edges(tuple(times), first)


def bouncing(signal: Signal, after: int, bounce_us: int, contacts: int = 3) -> Edges:
    """A signal as a worn contact gives it: behind each edge it opens and closes `contacts` times within `bounce_us`."""
    edges = [moment for moment, _ in signal.edges(after)]
    times: list[int] = []
    for place, moment in enumerate(edges):
        times.append(moment)
        room = max(0, min(bounce_us, (edges[place + 1] if place + 1 < len(edges) else moment + bounce_us + 1) - moment - 1))
        # Bounces grow shorter: at the squares of even parts of the time, counted from its end.
        extra = sorted({moment + room - room * k * k // (2 * contacts) ** 2 for k in range(2 * contacts)} - {moment})
        times += extra[: len(extra) // 2 * 2]
    return Edges(tuple(times), signal.level(after))


def steady(signal: Signal, moment: int, least: int) -> bool | None:
    """The newest level that a filter which wants `least` us of rest has let pass by `moment`; None when it has let none."""
    stop = until = moment
    for _ in range(signal.intervals):
        begin = signal.before(until)
        if begin is None:
            return None
        if stop - begin >= least:
            return signal.level(until)
        stop, until = begin, begin - 1
    return None
