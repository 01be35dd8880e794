"""Pulse trains that outputs put out, as values: segments of constant or evenly changing frequency, and the plans of PLSR, PLS and positioning.

A pulse is OFF for the first half of its period, then ON; it counts when it turns ON. All times are whole microseconds.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import sqrt

HALF_US = 5_000_000  # half a period of 0.1 Hz


@dataclass(frozen=True, slots=True)
class Segment:
    """`pulses` pulses (None without end) from `start` on, at `hertz` first, changing by `slope` Hz a second; a constant
    frequency is rounded to 0.1 Hz.
    """

    start: int
    hertz: float
    pulses: int | None
    slope: float = 0.0
    direction: int = 0  # of a positioning instruction: the position goes with every pulse
    number: int = 0  # of an envelope's step, from 1

    def point(self, halves: int) -> int:
        """When so many half pulses are over, from the start on."""
        if self.slope:
            root = sqrt(max(0.0, self.hertz * self.hertz + self.slope * halves))
            return int(1e6 * halves / (self.hertz + root))
        return halves * HALF_US // round(10 * self.hertz)

    def _points(self, half: int, elapsed: int) -> int:
        """Of how many pulses the begin (0), the rising edge (1) or the falling edge (2) lies in the first `elapsed` us."""
        if elapsed < 0:
            return 0
        if not self.slope:
            n = (((elapsed + 1) * round(10 * self.hertz) - 1) // HALF_US - half) // 2 + 1
        else:
            seconds = elapsed / 1e6
            if self.slope < 0:
                seconds = min(seconds, -self.hertz / self.slope)
            n = int(self.hertz * seconds + self.slope * seconds * seconds / 2 + 1 - half / 2)
            while n > 0 and self.point(2 * (n - 1) + half) > elapsed:
                n -= 1
            while (self.pulses is None or n < self.pulses) and self.point(2 * n + half) <= elapsed:
                n += 1
        return max(0, n if self.pulses is None else min(n, self.pulses))

    def started(self, moment: int) -> int:
        """Pulses whose period has begun by a moment."""
        return self._points(0, moment - self.start)

    def counted(self, moment: int) -> int:
        """Pulses that have turned ON by a moment."""
        return self._points(1, moment - self.start)

    def completed(self, moment: int) -> int:
        """Pulses that have turned OFF again."""
        return self._points(2, moment - self.start)

    def level(self, moment: int) -> bool:
        return self.counted(moment) > self.completed(moment)

    @property
    def end(self) -> int | None:
        return None if self.pulses is None else self.start + self.point(2 * self.pulses)

    def frequency(self, moment: int) -> float:
        """Hz at a moment within the segment."""
        return max(0.0, self.hertz + self.slope * (moment - self.start) / 1e6)

    def edge(self, rising: bool, index: int) -> int:
        """The time of the index-th edge of one sense, from 0."""
        return self.start + self.point(2 * index + (1 if rising else 2))

    def cut(self, moment: int) -> "Segment":
        """The segment up to the end of the pulse that is on its way."""
        return replace(self, pulses=self.started(moment))

    def stopped(self, moment: int) -> "Segment":
        """The segment without the pulses that have not been counted."""
        return replace(self, pulses=self.counted(moment))


@dataclass(frozen=True, slots=True)
class Wave:
    """PWM: ON for `width` us of every `period` us; it has no end and its pulses are not counted."""

    start: int
    width: int
    period: int
    pulses: None = None
    direction: int = 0
    number: int = 0
    end: None = None

    def started(self, moment: int) -> int:
        """Pulses that have turned ON by a moment: one for good where there is no pause."""
        if not self.width or moment < self.start:
            return 0
        return 1 if self.width == self.period else (moment - self.start) // self.period + 1

    def ended(self, moment: int) -> int:
        """Pulses that have turned OFF again."""
        return 0 if self.width == self.period else self.started(moment - self.width)

    def most(self, rising: bool) -> int | None:
        """How many edges of a sense there can be, None for no limit."""
        return None if 0 < self.width < self.period else int(rising and self.width > 0)

    def counted(self, moment: int) -> int:
        return 0

    def level(self, moment: int) -> bool:
        return (moment - self.start) % self.period < self.width

    def frequency(self, moment: int) -> float:
        return 1e6 / self.period

    def edge(self, rising: bool, index: int) -> int:
        return self.start + index * self.period + (0 if rising else self.width)

    def changed(self, width: int, period: int, moment: int) -> "Wave":
        """Another width or period from now on; the present period keeps its begin unless the new one would be over."""
        begin = moment - (moment - self.start) % self.period
        return Wave(moment if moment - begin >= period else begin, width, period)


def chained(start: int, steps: Iterable[Segment]) -> tuple[Segment, ...]:
    """Segments one after the other; those without pulses are left out."""
    plan = []
    for step in steps:
        if step.pulses != 0:
            plan.append(replace(step, start=start))
            start = plan[-1].end
    return tuple(plan)


def _ramp(low: float, high: float, pulses: int, **rest) -> Segment:
    """So many pulses from one frequency to another."""
    return Segment(0, low, pulses, (high * high - low * low) / (2 * pulses) if pulses and low != high else 0.0, **rest)


def stepped(start: int, hertz: int, pulses: int, work: int) -> tuple[Segment, ...]:
    """PLSR: ten steps of a tenth of the frequency up and down; `work` is frequency times ramp time (Hz ms)."""
    up = [Segment(0, hertz * step / 10, step * work // 100_000) for step in range(1, 11)]
    rest = pulses - 2 * sum(step.pulses for step in up)
    return chained(start, [*up, Segment(0, hertz, rest), *reversed(up)])


def least_pulses(low: int, high: int, first: int, second: int, ms: int) -> float:
    """6.10.11: the pulses that a change of speed takes, with the ramp time that belongs to it."""
    return (first + second) * abs(first - second) * ms / (2000 * (high - low))


def envelope(start: int, steps: list[tuple[int, int]], low: int, high: int, up_ms: int, down_ms: int) -> tuple[Segment, ...] | None:
    """PLS: (frequency, pulses) step by step, each beginning with its change of speed, the last one ending at the least speed.

    None when a rule of 6.10.11 is broken: the four least numbers of pulses, the bounds of the speeds, 999,999 pulses in all.
    """
    if not 0 < low < high or min(up_ms, down_ms) < 0 or sum(pulses for _, pulses in steps) > 999_999:
        return None
    plan: list[Segment] = []
    before = low
    for number, (speed, pulses) in enumerate(steps, 1):
        last = number == len(steps)
        ms = up_ms if speed > before else down_ms
        least = least_pulses(low, high, speed, before, up_ms + down_ms if last else ms)
        if not low <= speed <= high or pulses < least or pulses < 1:
            return None
        change = int(least_pulses(low, high, speed, before, ms))
        stop = min(int(least_pulses(low, high, speed, low, down_ms)), pulses - change) if last else 0
        plan += [_ramp(before, speed, change, number=number), Segment(0, speed, pulses - change - stop, number=number)]
        if stop:
            plan.append(_ramp(speed, low, stop, number=number))
        before = speed
    return chained(start, plan)


def least_hertz(top: int, ramp_ms: int) -> float:
    """6.17.4: no positioning instruction puts out less than sqrt(top * 500 / T)."""
    return sqrt(top * 500 / ramp_ms) if ramp_ms > 0 else 0.0


@dataclass(frozen=True, slots=True)
class Ramps:
    """How positioning accelerates: from `base` Hz on (never below `least`), `slope` Hz a second (0: at once)."""

    base: float
    slope: float

    def between(self, low: float, high: float) -> int:
        """Pulses of a change of speed."""
        return int(abs(high * high - low * low) / (2 * self.slope)) if self.slope else 0

    def move(self, start: int, pulses: int, hertz: float, direction: int) -> tuple[Segment, ...]:
        """So many pulses, speeding up at the beginning and slowing down at the end; short moves do not reach the speed."""
        first = min(self.base, hertz)
        change = min(self.between(first, hertz), pulses // 2)
        top = min(hertz, sqrt(first * first + 2 * self.slope * change)) if change else hertz if not self.slope else first
        if change == self.between(first, hertz):
            top = hertz
        return chained(
            start,
            [
                _ramp(first, top, change, direction=direction),
                Segment(0, top, pulses - 2 * change, direction=direction),
                _ramp(top, first, change, direction=direction),
            ],
        )

    def slowed(self, running: Segment, moment: int, room: int | None, hertz: float) -> tuple[Segment, ...]:
        """What is left of a running segment when it slows down to `hertz` from now on, within `room` pulses; the last pulse is finished."""
        cut = running.cut(moment)
        speed = running.frequency(moment)
        change = self.between(hertz, speed) if speed > hertz else 0
        change = change if room is None else min(change, room)
        parts = (cut,) if cut.pulses else ()
        if change:
            parts += (replace(_ramp(speed, hertz, change, direction=running.direction), start=cut.end),)
        return parts
