"""Interrupts: who may ask for an interrupt program, and when (chapter 9). Times are exact to the microsecond.

An event asks for its program when interrupts are enabled (EI) and the event's own relay is ON; the requests stand in a
queue and are served one after the other, in the time between two scans in which they come. With the eighth request
the queue is closed: what comes then is lost (error 67) until the queue is empty and the main program has ended.
"""

from ..errors import QUEUE_FULL
from ..memory import Memory
from .faults import Faults
from .inputs import Inputs
from .unit import Unit

DEPTH = 8


class Interrupts(Unit):
    """The global enable, the queue, the timed interrupts and those of the inputs' edges."""

    rank = 2

    def __init__(self, memory: Memory, faults: Faults, awake: list[Unit]):
        super().__init__(awake)
        self.memory, self.faults = memory, faults
        self.enables = memory.model.events
        self.enabled = False
        self.routines: dict[int, str] = {}
        self.timed: dict[int, int] = {}  # event -> the register with its period
        self.fixed: dict[int, int] = {}  # event -> its period in us
        self.edges: list[tuple[int, bool, int]] = []  # input, sense, event: those with a routine
        self.due: dict[int, tuple[int, int]] = {}  # event -> its next moment, its period in us
        self.queue: list[int] = []
        self.first: frozenset[int] = frozenset()  # the events of high priority: their requests stand before those of the others (2.2.1)
        self.closed = False
        self.inputs: Inputs | None = None  # given after both are made
        self.time = 0

    # -- requests -----------------------------------------------------------------------------------------------

    def fire(self, event: int) -> None:
        """An event has come; a request that is not allowed is lost."""
        if self.enabled and self.allowed(event):
            self.request(event)

    def allowed(self, event: int) -> bool:
        """Whether the event's own relay lets it ask."""
        relay = self.enables.get(event)
        return relay is not None and self.memory.lists[self.memory.model.special_bits][relay] is not (
            event in self.memory.model.masked_events
        )

    def request(self, event: int) -> None:
        """Queue a request; one without a routine is no operation."""
        if event not in self.routines:
            return
        if self.closed:
            self.faults.note(QUEUE_FULL)
            return
        place = sum(other in self.first for other in self.queue) if event in self.first else len(self.queue)
        self.queue.insert(place, event)
        self.closed = len(self.queue) >= DEPTH

    def ended(self) -> None:
        """The main program has ended: a closed queue that is empty opens again."""
        if not self.queue:
            self.closed = False

    # -- time ---------------------------------------------------------------------------------------------------

    def restart(self, now: int) -> None:
        """Nothing is enabled until EI."""
        self.enabled = self.closed = False
        self.due.clear()
        self.queue.clear()
        self.time = now

    def assign(self, routines: dict[int, str]) -> None:
        """The interrupt programs of the program that begins to run."""
        self.routines = routines
        model = self.memory.model
        self.timed = {event: register for event, register in model.timed_registers.items() if event in self.enables}
        self.fixed = {event: 1000 * ms for event, ms in model.timed_ms.items() if event in routines}
        self.edges = [(*model.edge_events[event], event) for event in model.edge_events if event in routines]
        self.wake(bool(routines))
        self.inputs.check()

    def look(self, now: int) -> None:
        """A timed interrupt begins its first period when it is enabled, and again when its period was changed."""
        registers = self.memory.lists[self.memory.model.special_words]
        for event, period in (*((event, 1000 * registers[register]) for event, register in self.timed.items()), *self.fixed.items()):
            if not self.allowed(event) or period <= 0:
                self.due.pop(event, None)
            elif event not in self.due or self.due[event][1] != period:
                self.due[event] = now + period, period

    def _edges(self, until: int) -> list[tuple[int, int]]:
        """The next edge of each signal that may ask for a routine, as (moment, event)."""
        found = []
        for number, rising, event in self.edges:
            signal = self.inputs.signals.get(number)
            if signal is not None and self.allowed(event):
                moment = signal.time(rising, self.time, 1)
                if moment is not None and moment <= until:
                    found.append((moment, event))
        return found

    def _times(self, event: int, now: int) -> int:
        """How many edges of an event fall on this microsecond."""
        number, rising = self.memory.model.edge_events[event]
        return self.inputs.signals[number].count(rising, now - 1, now)

    def next(self, until: int) -> int | None:
        first = None
        for moment, _ in self.due.values():
            if moment <= until and (first is None or moment < first):
                first = moment
        if self.edges and self.enabled and self.inputs.signals:
            for moment, _ in self._edges(until if first is None else first):
                first = moment if first is None else min(first, moment)
        return first

    def act(self, now: int) -> None:
        if self.edges and self.enabled and self.inputs.signals:
            for moment, event in self._edges(now):
                if moment == now:
                    for _ in range(self._times(event, now)):
                        self.fire(event)
        for event, (moment, period) in self.due.items():
            if moment == now:
                self.due[event] = now + period, period
                self.fire(event)
        self.time = now

    def advance(self, now: int) -> None:
        # Edges of this very moment are still to be asked for: `act` comes after.
        self.time = now - 1

    def edge(self, number: int, level: bool, now: int) -> None:
        for source, rising, event in self.edges:
            if source == number and rising is level:
                self.fire(event)

    def snapshot(self) -> tuple:
        return self.enabled, self.closed, dict(self.routines), dict(self.due), list(self.queue), self.time

    def restore(self, snapshot: tuple) -> None:
        self.enabled, self.closed, routines, due, queue, self.time = snapshot
        self.assign(dict(routines))
        self.due, self.queue[:] = dict(due), queue
