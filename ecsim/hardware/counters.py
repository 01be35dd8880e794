"""High-speed counters C236 to C255 and their comparisons (6.10.1 to 6.10.7, 8.1): every edge at its own time, none of them stepped through without need.

What a counter counts is looked at as a run: all edges of one sense of one signal, each worth +1 or -1. Then the value at
any moment and the moment of any value follow from the signal in closed form. Where both counting inputs move on
their own, the edges are merged one by one.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from ..devices import Device
from ..errors import RANGE
from ..memory import Memory
from ..models.model import FastCounter
from ..values import join, signed16, split
from .faults import Faults
from .inputs import Inputs
from .interrupts import Interrupts
from .signals import Signal, Train
from .unit import Unit

AT_ONCE = 6  # 6.10.2: so many comparisons may be driven at one time
MODULUS = 1 << 32
LOW, HIGH = -(1 << 31), (1 << 31) - 1
APART = 8  # us: below this period two phases may fall on one microsecond
WORTH = {  # what an edge counts: [of the second input?][its level][state of the other input]
    "up/down": (((0, 0), (1, 1)), ((0, 0), (-1, -1))),
    "phases": (((0, 0), (0, 0)), ((0, -1), (0, 1))),  # 8.1.1: with A ON, B turning ON counts up and B turning OFF counts down
    "fourfold": (((-1, 1), (1, -1)), ((1, -1), (-1, 1))),  # each edge of both
}


@dataclass(frozen=True, slots=True)
class Comparison:
    """One driven DHSCS, DHSCR, DHSCI, DHSZ, DHST or DHSP: what it looks for and what it does."""

    kind: str  # "set", "reset", "event", "zone", "outputs" (DHST) or "data" (DHSP)
    counter: int
    low: int = 0
    high: int = 0
    target: Device | None = None
    event: int = 0
    table: int = 0
    records: int = 0
    record: int = 0  # from 0
    over: bool = False  # a DHSP whose last record was 0


def _wrapped(value: int) -> int:
    return value if LOW <= value <= HIGH else (value - LOW) % MODULUS + LOW


class Counters(Unit):
    """All high-speed counters. Values and contacts stand in the memory's C and CB and are true at every moment that a program sees."""

    def __init__(self, memory: Memory, inputs: Inputs, interrupts: Interrupts, faults: Faults, awake: list[Unit]):
        super().__init__(awake)
        self.memory, self.inputs, self.interrupts, self.faults = memory, inputs, interrupts, faults
        self.model = memory.model
        self.time = 0  # up to which edges have been counted
        self.claims: dict[int, tuple[int, int]] = {}  # HCNT: claim -> counter, preset
        self.comparisons: dict[int, Comparison] = {}  # in the order in which they became effective
        self.presets: dict[int, int] = {}  # of the driven counters

    # -- commands -----------------------------------------------------------------------------------------------

    def drive(self, claim: int, number: int, preset: int, now: int) -> None:
        """HCNT: the counter counts for as long as the claim is held."""
        if self.claims.get(claim) == (number, preset):
            return
        if not self.claims:
            self.time = now
        begins = number not in self.presets
        self.claims[claim] = (number, preset)
        self.presets[number] = preset
        if begins:
            self.wake()
            self._control(number, now)
            self.inputs.check()

    def compare(self, claim: int, comparison: Comparison) -> None:
        """One of the comparison instructions is driven; beyond six it has to wait (6.10.2, rule 3)."""
        known = self.comparisons.get(claim)
        if known is None:
            tabular = comparison.kind in ("outputs", "data")
            if sum(not c.over for c in self.comparisons.values()) >= AT_ONCE:
                return
            if tabular and any(c.kind in ("outputs", "data") for c in self.comparisons.values()):
                return
            if tabular:
                if not 0 <= comparison.table <= self.model.areas["D"].count - 4 * comparison.records:
                    self.faults.note(RANGE)
                    return
                self._bits()[self.model.relays["table done"]] = False
            self.comparisons[claim] = comparison
            if tabular:
                self._show(comparison)
            self.inputs.check()
        elif known.kind in ("outputs", "data"):
            if not known.over:
                self._show(known)
        elif known != comparison:
            self.comparisons[claim] = comparison

    def release(self, claim: int, now: int) -> None:
        if self.comparisons.pop(claim, None) is None and claim in self.claims:
            number, _ = self.claims.pop(claim)
            left = [preset for other, preset in self.claims.values() if other == number]
            if left:
                self.presets[number] = left[-1]
            else:
                del self.presets[number]
            self.wake(bool(self.claims))

    def restart(self, now: int) -> None:
        self.claims.clear()
        self.comparisons.clear()
        self.presets.clear()
        self.time = now
        self.wake(False)

    # -- inputs -------------------------------------------------------------------------------------------------

    def _bits(self) -> list:
        return self.memory.lists[self.model.special_bits]

    def _open(self, counter: FastCounter) -> bool:
        """Whether reset and start inputs let the counter count at the present moment."""
        terminals = self.inputs.terminals
        return not (counter.reset is not None and terminals[counter.reset]) and (counter.start is None or terminals[counter.start])

    def _control(self, number: int, now: int) -> None:
        """Look at the reset input: while it is ON, be it for less than a microsecond, value and contact are cleared (6.10.4)."""
        reset = self.model.fast_counters[number].reset
        if reset is None:
            return
        signal = self.inputs.signals.get(reset)
        if self.inputs.terminals[reset] or (signal is not None and signal.count(True, now - 1, now)):
            self.memory.lists["C"][number] = 0
            self.memory.lists["CB"][number] = False

    def edge(self, number: int, level: bool, now: int) -> None:
        for counter in self.presets:
            fast = self.model.fast_counters[counter]
            if number in fast.inputs:
                other = fast.inputs[number == fast.inputs[0]] if fast.mode != "single" else number
                delta = self._worth(counter, fast, number, level, self.inputs.terminals[other])
                if delta and self._open(fast):
                    self._count(counter, delta, 1)
            elif number in (fast.reset, fast.start):
                self._control(counter, now)

    def _mode(self, number: int, fast: FastCounter) -> str:
        """How a counter counts at present: where the model has a relay for it, both phases may count with each edge."""
        fourfold = self.model.relays.get("fourfold") if fast.mode == "phases" else None
        return "fourfold" if fourfold is not None and self._bits()[fourfold + number] else fast.mode

    def _worth(self, number: int, fast: FastCounter, source: int, level: bool, other: bool) -> int:
        """What one edge counts; `other` is the state of the other phase."""
        if fast.mode == "single":
            return (-1 if self._bits()[self.model.relays["counter direction"] + number] else 1) if level else 0
        return WORTH[self._mode(number, fast)][source != fast.inputs[0]][level][other]

    # -- runs ---------------------------------------------------------------------------------------------------

    def _run(self, number: int) -> tuple[Signal, bool, int] | Callable | None:
        """What the counter counts from now on: (signal, sense, worth), None for nothing, or the edges one by one."""
        fast, signals = self.model.fast_counters[number], self.inputs.signals
        if not self._open(fast):
            return None
        first = signals.get(fast.inputs[0])
        if fast.mode == "single":
            return None if first is None else (first, True, self._worth(number, fast, fast.inputs[0], True, True))
        second = signals.get(fast.inputs[1])
        if fast.mode == "up/down":
            if first is None or second is None:
                return (first, True, 1) if first is not None else (second, True, -1) if second is not None else None
            return self._merged
        if self._mode(number, fast) == "fourfold":
            return self._merged if first is not None or second is not None else None
        if second is None or (first is None and not self.inputs.terminals[fast.inputs[0]]):
            return None
        if isinstance(first, Train) and isinstance(second, Train):
            same = (first.start, first.span, first.pulses, first.total) == (second.start, second.span, second.pulses, second.total)
            if same and first.span >= APART * first.pulses:
                if first.rise < second.rise < first.fall < second.fall:
                    return second, True, 1
                if second.rise < first.rise < second.fall < first.fall:
                    return second, False, -1
        return self._merged

    def _merged(self, number: int, after: int, until: int) -> Iterator[tuple[int, int]]:
        """(moment, worth) of each counting edge in (after, until], where both inputs move."""
        fast, signals = self.model.fast_counters[number], self.inputs.signals
        first, second = (signals[source].edges(after) if source in signals else iter(()) for source in fast.inputs)
        a, b = (signals[n].level(after) if n in signals else self.inputs.terminals[n] for n in fast.inputs)
        of_first, of_second = WORTH[self._mode(number, fast)]
        over = until + 1, False
        one, two = next(first, over), next(second, over)
        while True:
            if one[0] <= two[0]:
                moment, level = one
                if moment > until:
                    return
                worth = of_first[level][b]
                a, one = level, next(first, over)
            else:
                moment, level = two
                if moment > until:
                    return
                worth = of_second[level][a]
                b, two = level, next(second, over)
            if worth:
                yield moment, worth

    # -- time ---------------------------------------------------------------------------------------------------

    def next(self, until: int) -> int | None:
        first = None
        for number in self.presets:
            run = self._run(number)
            limit = until if first is None else first
            moment = self._controls(self.model.fast_counters[number], limit)
            limit = limit if moment is None else moment
            hit = None
            comparisons = self._looking(number) if run is not None else ()
            if comparisons:
                if isinstance(run, tuple):
                    signal, rising, worth = run
                    value = self.memory.lists["C"][number]
                    hit = signal.time(rising, self.time, min(self._distance(c, value, worth) for c in comparisons))
                else:
                    hit = self._met(number, run(number, self.time, limit), comparisons)
            for found in (moment, hit):
                if found is not None and found <= until and (first is None or found < first):
                    first = found
        return first

    def _controls(self, fast: FastCounter, until: int) -> int | None:
        """The next edge of the counter's reset or start input."""
        found = None
        for source in (fast.reset, fast.start):
            signal = self.inputs.signals.get(source) if source is not None else None
            edge = next(signal.edges(self.time), None) if signal is not None else None
            if edge is not None and edge[0] <= until and (found is None or edge[0] < found):
                found = edge[0]
        return found

    def _wanted(self, comparison: Comparison) -> int:
        """The value that a table's present record waits for."""
        place = comparison.table + 4 * comparison.record
        words = self.memory.lists["D"]
        return join(words[place], words[place + 1])

    def _distance(self, comparison: Comparison, value: int, worth: int) -> int:
        """After how many counts of one direction the comparison has something to do."""
        if comparison.kind == "zone":
            following = _wrapped(value + worth)
            if self._zone(comparison, following) != self._shown(comparison):
                return 1
            borders = (comparison.low, comparison.high + 1) if worth > 0 else (comparison.low - 1, comparison.high)
        else:
            borders = (self._wanted(comparison) if comparison.kind in ("outputs", "data") else comparison.low,)
        return min((border - value) * worth % MODULUS or MODULUS for border in borders)

    def _met(self, number: int, edges: Iterator[tuple[int, int]], comparisons: list[Comparison]) -> int | None:
        """The first edge after which a comparison has something to do."""
        value = self.memory.lists["C"][number]
        for moment, worth in edges:
            if any(self._distance(c, value, worth) == 1 for c in comparisons):
                return moment
            value = _wrapped(value + worth)
        return None

    def advance(self, now: int) -> None:
        if now <= self.time:
            return
        since, self.time = self.time, now
        for number in tuple(self.presets):
            # The terminals still hold the state before `now`: edges of the reset and start inputs are events, so none lies between.
            run = self._run(number)
            if isinstance(run, tuple):
                signal, rising, worth = run
                n = signal.count(rising, since, now)
                if n:
                    (self._counts if self.comparisons else self._count)(number, worth, n)
            elif run is not None:
                for _, worth in run(number, since, now):
                    self._count(number, worth, 1)

    def act(self, now: int) -> None:
        for number in self.presets:
            self._control(number, now)

    # -- counting -----------------------------------------------------------------------------------------------

    def _counts(self, number: int, worth: int, n: int) -> None:
        """`n` edges of the same worth. More than one can be needed to the next comparison only if they fall on one microsecond."""
        while n:
            met = [self._distance(c, self.memory.lists["C"][number], worth) for c in self._looking(number)]
            step = min([n, *met])
            self._count(number, worth, step)
            n -= step

    def _looking(self, number: int) -> list[Comparison]:
        """The comparisons that a count of this counter may meet."""
        return [c for c in self.comparisons.values() if c.counter == number and not c.over]

    def _count(self, number: int, worth: int, n: int) -> None:
        """`n` edges of the same worth; a comparison is met by the last one at most."""
        values = self.memory.lists["C"]
        exact = values[number] + worth * n
        value = values[number] = _wrapped(exact)
        contacts, preset = self.memory.lists["CB"], self.presets[number]
        if worth > 0:
            if value >= preset or exact != value:
                contacts[number] = True
        elif value <= preset or exact != value:
            contacts[number] = False
        if self.model.fast_counters[number].mode != "single":
            self._bits()[self.model.relays["counter direction"] + number] = worth < 0
        if self.comparisons:
            for claim, comparison in tuple(self.comparisons.items()):
                if comparison.counter == number and not comparison.over:
                    self._decide(claim, comparison, value)

    def _decide(self, claim: int, comparison: Comparison, value: int) -> None:
        kind = comparison.kind
        if kind == "zone":
            self._write(comparison.target, self._zone(comparison, value))
        elif kind in ("outputs", "data"):
            if value == self._wanted(comparison):
                self._record(claim, comparison)
        elif value == comparison.low:
            if kind == "event":
                self.interrupts.fire(comparison.event)
            elif comparison.target.area == "C":  # DHSCR of the counter itself, as RST does it (5.1.17)
                self.memory.lists["C"][comparison.counter] = 0
                self.memory.lists["CB"][comparison.counter] = False
            else:
                self._write(comparison.target, [kind == "set"])

    @staticmethod
    def _zone(comparison: Comparison, value: int) -> list[bool]:
        return [value < comparison.low, comparison.low <= value <= comparison.high, value > comparison.high]

    def _shown(self, comparison: Comparison) -> list[bool]:
        target = comparison.target
        return self.memory.lists[target.area][target.number : target.number + 3]

    def _write(self, target: Device, states: list[bool]) -> None:
        self.memory.lists[target.area][target.number : target.number + len(states)] = states

    def _record(self, claim: int, comparison: Comparison) -> None:
        """A table's present record is met: its output or data at once, then the next record (6.10.6, 6.10.7)."""
        words, place = self.memory.lists["D"], comparison.table + 4 * comparison.record
        first, second = words[place + 2], words[place + 3]
        if comparison.kind == "outputs":
            outputs = self.memory.lists["Y"]
            if 0 <= first < len(outputs):
                outputs[first] = second != 0
            else:
                self.faults.note(RANGE)
        else:
            self._put("table output", (first, second))
        last = comparison.record + 1 == comparison.records
        over = last and comparison.kind == "data" and not first and not second
        if last:
            self._bits()[self.model.relays["table done"]] = True
        comparison = replace(comparison, record=0 if last else comparison.record + 1, over=over)
        self.comparisons[claim] = comparison
        if not over:
            self._show(comparison)

    def _put(self, meaning: str, words: tuple[int, ...]) -> None:
        registers, number = self.memory.lists[self.model.special_words], self.model.registers[meaning]
        registers[number : number + len(words)] = words

    def _show(self, comparison: Comparison) -> None:
        self._put("table value", split(self._wanted(comparison)))
        self._put("table record", (signed16(comparison.record + 1),))

    def snapshot(self) -> tuple:
        return self.time, dict(self.claims), dict(self.comparisons), dict(self.presets)

    def restore(self, snapshot: tuple) -> None:
        self.time, claims, comparisons, presets = snapshot
        self.claims, self.comparisons, self.presets = dict(claims), dict(comparisons), dict(presets)
        self.wake(bool(self.claims))
