"""The pulse outputs, of EC Y0 and Y1 (6.10.9 to 6.10.12, 6.17, 8.3): who owns them, what they put out and what they report.

The first instruction that becomes effective owns an output until its flow goes, also when its pulses are over. SM80/81 ON
stop the pulses; SM82/83 tell that pulses come; SD50 to SD55 count them, SD80 to SD83 follow them while positioning. Which
relays and registers these are, and how many outputs there are, is the model's.
"""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import islice

from ..devices import Device
from ..memory import Memory
from ..models.model import PulseOutput
from ..values import join, split
from .inputs import Inputs
from .interrupts import Interrupts
from .trains import Ramps, Segment, Wave
from .unit import Unit

CLEAR_US = 20_000  # 6.17.6: the clear pulse lasts 20 ms and one scan
KEPT = 4096  # segments that are remembered of an output


@dataclass(frozen=True, slots=True)
class Home:
    """A ZRN on its way: the near-point signal, the creep speed, whether the signal has been seen."""

    dog: Device
    creep: float
    ramps: Ramps
    seen: bool = False


@dataclass(slots=True)
class Axis:
    """One pulse output. `segments` is what is still to come, the present one first."""

    number: int
    claim: int | None = None
    segments: tuple[Segment | Wave, ...] = ()
    done: int = 0  # pulses of the present segment that have been counted
    completes: bool = False  # whether the end of the pulses is reported as an event
    ramps: Ramps | None = None  # of a move that slows down when its flow goes
    home: Home | None = None
    clearing: int = 0  # the end of ZRN's clear pulse, 0 without one
    warning: int = 0  # an error that is reported for as long as the instruction is driven
    total: int = 0  # pulses since the machine was made, which no program can write
    free: int = -1  # when the output was given back: positioning waits for another scan (6.17.4)

    @property
    def busy(self) -> bool:
        """Whether pulses come."""
        return bool(self.segments)

    @property
    def end(self) -> int | None:
        """When the pulses are over."""
        return self.segments[-1].end if self.segments else None


class PulseOutputs(Unit):
    """All outputs; `trains` keeps what they have put out, to be read as times and as a frequency curve."""

    rank = 1

    def __init__(self, memory: Memory, inputs: Inputs, interrupts: Interrupts, period: Callable[[], int], awake: list[Unit]):
        super().__init__(awake)
        self.memory, self.inputs, self.interrupts, self.model = memory, inputs, interrupts, memory.model
        self.period = period  # how long a scan takes, in us
        self.axes = tuple(Axis(number) for number in range(len(self.model.pulse_outputs)))
        self.history: tuple[deque, ...] = tuple(deque(maxlen=KEPT) for _ in self.axes)
        self._order = slice(None) if self.model.high_word_first else slice(None, None, -1)  # the words of a 32-bit register

    def _map(self, axis: Axis) -> PulseOutput:
        return self.model.pulse_outputs[axis.number]

    def _bits(self) -> list:
        return self.memory.lists[self.model.special_bits]

    def _add(self, number: int, amount: int) -> None:
        self._put(number, self.register(number) + amount)

    def _put(self, number: int, value: int) -> None:
        self.memory.lists[self.model.special_words][number : number + 2] = split(value)[self._order]

    def register(self, number: int) -> int:
        """A 32-bit special register."""
        return join(*self.memory.lists[self.model.special_words][number : number + 2][self._order])

    def position(self, number: int) -> int:
        """Where the axis of an output stands, in pulses."""
        return self.register(self.model.pulse_outputs[number].position)

    # -- what commands ask for ----------------------------------------------------------------------------------

    def owner(self, claim: int, number: int) -> Axis | None:
        """The output if this claim owns it or may take it, None while another one has it or its pulses still come."""
        axis = self.axes[number]
        if axis.claim == claim or (axis.claim is None and not axis.segments and not axis.clearing):
            return axis
        return None

    def open(self, number: int) -> bool:
        """Whether its stop relay lets pulses pass."""
        return not self._bits()[self.model.pulse_outputs[number].stop]

    def start(self, axis: Axis, claim: int, segments: tuple[Segment | Wave, ...], now: int, **rest) -> None:
        """Take an output and begin to put out pulses."""
        axis.claim, axis.done = claim, 0
        axis.completes, axis.ramps, axis.home, axis.warning = False, None, None, 0
        for name, value in rest.items():
            setattr(axis, name, value)
        axis.segments = segments if self.open(axis.number) else ()
        self._show(axis, now)
        self.wake()
        if self.inputs.signals:
            self.inputs.follow(now)
            self.inputs.check()

    def refrain(self, axis: Axis, claim: int, now: int) -> None:
        """An operand has become illegal: no pulses, the output is free."""
        if axis.claim == claim:
            self._halt(axis, now)
            axis.claim = None

    def replace(self, axis: Axis, following: tuple[Segment, ...], now: int) -> None:
        """Go on with other segments behind the pulse that is on its way; the first of them is told its begin."""
        running = axis.segments[0]
        cut = running.cut(now)
        begin = cut.end if cut.pulses else now
        if cut.pulses:
            axis.segments = (cut, replace(following[0], start=begin), *following[1:])
        else:
            axis.segments, axis.done = (replace(following[0], start=begin), *following[1:]), 0
        self.inputs.check()

    def release(self, claim: int, now: int) -> None:
        for axis in self.axes:
            if axis.claim == claim:
                axis.claim, axis.completes, axis.warning, axis.free = None, False, 0, now
                self._tell(False)
                axis.home = None
                if axis.ramps is not None and axis.segments:
                    self._slow(axis, axis.ramps, axis.ramps.base, now)
                else:
                    self._halt(axis, now)

    def _slow(self, axis: Axis, ramps: Ramps, hertz: float, now: int) -> None:
        """Slow down; a move that is slowing down already does so to its end."""
        self.advance(now)
        if not axis.segments or (axis.segments[0].slope < 0 and len(axis.segments) == 1):
            return
        running = axis.segments[0]
        following = [segment.pulses for segment in axis.segments]
        room = None if following[-1] is None else sum(following) - running.started(now)
        axis.segments = ramps.slowed(running, now, room, min(hertz, running.frequency(now)))
        self._show(axis, now)

    def _halt(self, axis: Axis, now: int) -> None:
        """Stop at once; the output goes OFF."""
        if axis.segments:
            self._remember(axis, axis.segments[0], now)
            axis.segments = ()
        axis.home, axis.done = None, 0
        self._show(axis, now)
        self._rest()

    def _rest(self) -> None:
        self.wake(any(axis.claim is not None or axis.segments or axis.clearing for axis in self.axes))

    def restart(self, now: int) -> None:
        for axis in self.axes:
            axis.claim, axis.home, axis.clearing, axis.free = None, None, 0, -1
            if axis.segments:  # otherwise its terminal is an output like others
                self._halt(axis, now)

    # -- time ---------------------------------------------------------------------------------------------------

    def look(self, now: int) -> None:
        for axis in self.axes:
            if axis.segments and not self.open(axis.number):
                self._halt(axis, now)
            if axis.home is not None and axis.segments and axis.home.dog.area != "X":
                self._dog(axis, self.memory.bits(axis.home.dog.area)[axis.home.dog.number], now)

    def next(self, until: int) -> int | None:
        first = None
        for axis in self.axes:
            moments = [axis.end, axis.clearing or None]
            if axis.home is not None and axis.home.dog.area == "X":
                signal = self.inputs.signals.get(axis.home.dog.number)
                moments += [moment for moment, _ in islice(signal.edges(self.inputs.time), 1)] if signal is not None else []
            for moment in moments:
                if moment is not None and moment <= until and (first is None or moment < first):
                    first = moment
        return first

    def advance(self, now: int) -> None:
        outputs = self.memory.lists["Y"]
        for axis in self.axes:
            if not axis.segments:
                if axis.claim is not None:
                    outputs[axis.number] = False  # nothing else may use the output of an effective instruction (8.3.2)
                continue
            while True:
                segment = axis.segments[0]
                counted = segment.counted(now)
                if counted > axis.done:
                    self._note(axis, segment, counted - axis.done)
                    axis.done = counted
                if len(axis.segments) == 1 or segment.end > now:
                    break
                self._remember(axis, segment, now)
                axis.segments, axis.done = axis.segments[1:], 0
                self._segment(axis)
            outputs[axis.number] = segment.level(now)

    def _note(self, axis: Axis, segment: Segment, pulses: int) -> None:
        axis.total += pulses
        self._add(self.model.registers["pulses of all"], pulses)
        if not segment.direction or self._map(axis).pulses != self._map(axis).position:
            self._add(self._map(axis).pulses, pulses)
        if segment.direction:
            self._add(self._map(axis).position, pulses * segment.direction)

    def _segment(self, axis: Axis) -> None:
        if self._map(axis).segment is not None:
            self.memory.lists[self.model.special_words][self._map(axis).segment] = axis.segments[0].number if axis.segments else 0

    def _show(self, axis: Axis, now: int) -> None:
        self._bits()[self._map(axis).busy] = bool(axis.segments)
        self.memory.lists["Y"][axis.number] = bool(axis.segments) and axis.segments[0].level(now)
        self._segment(axis)

    def act(self, now: int) -> None:
        for axis in self.axes:
            if axis.home is not None and axis.home.dog.area == "X":
                self._dog(axis, self.inputs.terminals[axis.home.dog.number], now)
            if axis.clearing and axis.clearing <= now:
                axis.clearing = 0
                self.memory.lists["Y"][self._map(axis).clear] = False
                self._rest()
            if axis.segments and axis.end is not None and axis.end <= now:
                self._halt(axis, now)
                if axis.completes:
                    self._complete(axis)

    def _tell(self, complete: bool) -> None:
        """Where a relay tells of the end of pulses, it does so until the flow of their instruction goes."""
        relay = self.model.relays.get("complete")
        if relay is not None:
            self._bits()[relay] = complete

    def sense(self, axis: Axis, now: int) -> None:
        """A ZRN has begun: it may stand on its near-point switch already."""
        dog = axis.home.dog if axis.home is not None else None
        if dog is not None and axis.segments:
            on = self.inputs.terminals[dog.number] if dog.area == "X" else self.memory.bits(dog.area)[dog.number]
            self._dog(axis, on, now)

    # -- return to the origin -----------------------------------------------------------------------------------

    def edge(self, number: int, level: bool, now: int) -> None:
        for axis in self.axes:
            if axis.home is not None and axis.home.dog.area == "X" and axis.home.dog.number == number:
                self._dog(axis, level, now)

    def _dog(self, axis: Axis, on: bool, now: int) -> None:
        """6.17.7: the near-point signal ON slows down to the creep speed, OFF again is the origin."""
        home = axis.home
        if on and not home.seen:
            axis.home = replace(home, seen=True)
            self._slow(axis, home.ramps, home.creep, now)
            axis.segments = (*axis.segments, Segment(axis.segments[-1].end if axis.segments else now, home.creep, None, direction=-1))
        elif not on and home.seen:
            self._halt(axis, now)
            axis.completes = False
            self._put(self._map(axis).position, 0)
            if self._map(axis).clear is not None and self._bits()[self.model.relays["clear signal"]]:
                axis.clearing = now + CLEAR_US + self.period()
                self.memory.lists["Y"][self._map(axis).clear] = True
                self.wake()
            self._complete(axis)

    def _complete(self, axis: Axis) -> None:
        """The pulses of a command, or a return to the origin, are over."""
        self._tell(True)
        self.interrupts.fire(self._map(axis).event)

    # -- what was put out ---------------------------------------------------------------------------------------

    def _remember(self, axis: Axis, segment: Segment | Wave, now: int) -> None:
        if isinstance(segment, Segment):
            segment = segment.stopped(now)
            if segment.pulses:
                self.history[axis.number].append(segment)
        else:
            self.history[axis.number].append((segment, now))

    def trains(self, number: int, now: int) -> list[Segment]:
        """The segments that an output has put out up to now, in order of time (those of PWM are left out)."""
        kept = [segment for segment in self.history[number] if isinstance(segment, Segment) and segment.start <= now]
        return kept + [s.stopped(now) for s in self.axes[number].segments[:1] if isinstance(s, Segment) and s.counted(now)]

    def times(self, number: int, now: int) -> list[tuple[int, int]]:
        """(ON, OFF) of every pulse in microseconds."""
        return [(s.edge(True, place), s.edge(False, place)) for s in self.trains(number, now) for place in range(s.pulses)]

    def frequency(self, number: int, now: int) -> list[tuple[float, float]]:
        """The corners of the frequency curve as (ms, Hz); a pause is 0 Hz."""
        curve: list[tuple[float, float]] = []
        for segment in self.trains(number, now):
            begin, end = segment.start / 1000, segment.end / 1000
            if curve and curve[-1][0] < begin:
                curve.append((curve[-1][0], 0.0))
            if not curve or curve[-1][1] == 0.0:
                curve.append((begin, 0.0))
            curve += [(begin, segment.hertz), (end, segment.frequency(segment.end))]
        return [*curve, (curve[-1][0], 0.0)] if curve and not self.axes[number].busy else curve

    def snapshot(self) -> tuple:
        return tuple(replace(axis) for axis in self.axes), tuple(tuple(kept) for kept in self.history)

    def restore(self, snapshot: tuple) -> None:
        axes, history = snapshot
        for axis, kept in zip(self.axes, axes, strict=True):
            for name in Axis.__slots__:
                setattr(axis, name, getattr(kept, name))
        for trains, kept in zip(self.history, history, strict=True):
            trains.clear()
            trains.extend(kept)
        self._rest()


class Wired:
    """A pulse output as the signal of an input that is connected to it (a `Signal`, without end)."""

    end = None
    intervals = 3

    def __init__(self, outputs: PulseOutputs, number: int):
        self.outputs, self.number = outputs, number

    def link(self) -> int:
        """What tells this signal from others in a file: its output."""
        return self.number

    def _parts(self, moment: int) -> list[tuple[Segment | Wave, int | None]]:
        """The segments that have a part after a moment, each with the number of its pulses; what is remembered comes first."""
        kept = []
        for segment in reversed(self.outputs.history[self.number]):
            part, pulses = (segment, segment.pulses) if isinstance(segment, Segment) else (segment[0], segment[0].started(segment[1]))
            if part.start + part.point(2 * pulses) < moment if isinstance(part, Segment) else segment[1] < moment:
                break
            kept.append((part, pulses))
        return [*reversed(kept), *((segment, segment.pulses) for segment in self.outputs.axes[self.number].segments)]

    @staticmethod
    def _passed(part: Segment | Wave, pulses: int | None, rising: bool, moment: int) -> int:
        if isinstance(part, Segment):
            n = part.counted(moment) if rising else part.completed(moment)
        else:
            n = part.started(moment) if rising else part.ended(moment)
        return n if pulses is None else min(n, pulses)

    def count(self, rising: bool, after: int, until: int) -> int:
        return sum(self._passed(*part, rising, until) - self._passed(*part, rising, after) for part in self._parts(after))

    def time(self, rising: bool, after: int, n: int) -> int | None:
        for part, pulses in self._parts(after):
            passed = self._passed(part, pulses, rising, after)
            pulses = part.most(rising) if pulses is None and isinstance(part, Wave) else pulses
            if pulses is None or passed + n <= pulses:
                return part.edge(rising, passed + n - 1)
            n -= pulses - passed
        return None

    def edges(self, after: int) -> Iterator[tuple[int, bool]]:
        """Every edge after a moment, as (moment, level)."""
        rising = not self.level(after)
        while (moment := self.time(rising, after, 1)) is not None:
            yield moment, rising
            after, rising = (moment, False) if rising else (moment, True)

    def before(self, moment: int) -> int | None:
        last = None
        for part, pulses in self._parts(0):
            for rising in (True, False):
                passed = self._passed(part, pulses, rising, moment)
                if passed:
                    edge = part.edge(rising, passed - 1)
                    last = edge if last is None else max(last, edge)
        return last

    def level(self, moment: int) -> bool:
        return any(self._passed(*part, True, moment) > self._passed(*part, False, moment) for part in self._parts(moment))

    @property
    def hertz(self) -> float:
        segments = self.outputs.axes[self.number].segments
        return max((segment.frequency(segment.start) for segment in segments), default=0.0)
