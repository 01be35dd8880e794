"""Inputs: terminals, signals on them, the input filter, the input image and pulse capture (2.1.2, 2.2.1, 3.1.3, 8.2)."""

from collections.abc import Callable, Iterable
from itertools import takewhile

from ..memory import Memory
from .signals import Signal, steady
from .unit import Unit

FAST = 8  # X0 to X7: watched between scans


class Inputs(Unit):
    """The X terminals. A terminal is what the wiring holds; the image X takes it over at the input refresh, after the filter."""

    rank = 1

    def __init__(self, memory: Memory, filter_ms: float, awake: list[Unit], watchers: list[Unit]):
        super().__init__(awake)
        self.memory, self.watchers = memory, watchers
        self.terminals = [False] * memory.model.areas["X"].count
        self.filtered = frozenset(range(memory.model.filter_inputs))
        self.unfiltered: frozenset[int] = frozenset()
        self.filter_us = self.usual_us = round(filter_ms * 1000)  # REFF changes it until the next RUN
        self.waiting: dict[int, tuple[int, int]] = {}  # number -> (level, time from which it counts)
        self.signals: dict[int, Signal] = {}
        self.time = 0  # up to which signals have been taken into account
        self.taken: frozenset[int] = frozenset()  # inputs of HCNT and SPD: from the second scan on they catch no pulse (8.2)
        self.catching = True
        self.capture = memory.model.relays.get("capture")
        self.may_catch: Callable[[], bool] = lambda: True
        self.changed = True
        self.check: Callable[[], None] = lambda: None  # looks at the frequencies; given after all units are made

    def assign(self, taken: Iterable[int], watched: Iterable[int]) -> None:
        """Tell which inputs the program's counters and SPD need, and which others it watches between scans: none of them is filtered."""
        self.taken = frozenset(taken)
        self.unfiltered = self.taken | frozenset(watched)

    def restart(self, now: int) -> None:
        self.catching = True

    # -- terminals ----------------------------------------------------------------------------------------------

    def set(self, number: int, level: int, now: int) -> None:
        """Put a level on a terminal; it stays until it is set again. A signal on it ends."""
        level = bool(level)
        if self.signals and self.signals.pop(number, None) is not None:
            self.wake(bool(self.signals))
        if self.terminals[number] is level:
            return
        self.changed = True
        if self.filter_us and number in self.filtered and number not in self.unfiltered:
            self.waiting[number] = (level, now + self.filter_us)
        self._switch(number, level, now)

    def _switch(self, number: int, level: bool, now: int) -> None:
        """The level of a terminal changes: captures and what watches edges are told."""
        self.terminals[number] = level
        if number < FAST:
            if level:
                self._catch(number)
            for watcher in self.watchers:
                watcher.edge(number, level, now)

    def drive(self, number: int, signal: Signal, now: int) -> None:
        """Put a signal on a terminal; after its end the last level stays. Its edges of this very moment come at once."""
        for _, level in takewhile(lambda edge: edge[0] <= now, signal.edges(now - 1)):
            self.set(number, level, now)
        self.set(number, signal.level(now), now)
        if not self.signals:
            self.time = now
        self.signals[number] = signal
        self.changed = True
        self.wake()
        self.check()

    def follow(self, now: int) -> None:
        """An output that inputs may be wired to has begun: it can be ON from its first moment, which is an edge of this moment."""
        for number, signal in self.signals.items():
            level = signal.level(now)
            if level is not self.terminals[number]:
                self._switch(number, level, now)

    def set_filter(self, filter_us: int) -> None:
        """Change the filter's time, also for the levels that wait to be taken over."""
        later = filter_us - self.filter_us
        if later:
            self.waiting = {number: (level, due + later) for number, (level, due) in self.waiting.items()}
            self.filter_us = filter_us

    def _catch(self, number: int) -> None:
        if self.capture is None or number >= self.memory.model.captures or not self.may_catch():
            return
        if self.catching or number not in self.taken:
            self.memory.lists[self.memory.model.special_bits][self.capture + number] = True

    # -- time ---------------------------------------------------------------------------------------------------

    def advance(self, now: int) -> None:
        for number, signal in self.signals.items():
            if number < FAST and signal.count(True, self.time, now):
                self._catch(number)
            self.terminals[number] = signal.level(now)
        self.time = now

    def refresh(self, now: int, numbers: range | None = None) -> None:
        """Take the terminals, or only those with these numbers, over into the input image."""
        image = self.memory.lists["X"]
        if numbers is not None:
            image[numbers.start : numbers.stop] = self._fresh(now, numbers)[numbers.start : numbers.stop]
            return
        if not self.waiting and not self.signals:
            image[:] = self.terminals
            self.changed = False
            return
        image[:] = self._fresh(now, range(len(image)))

    def _fresh(self, now: int, numbers: range) -> list[bool]:
        """The terminals behind the filter, for the inputs with these numbers."""
        image = self.memory.lists["X"]
        fresh = self.terminals[:]
        for number in [n for n in self.waiting if n in numbers]:
            level, due = self.waiting[number]
            fresh[number] = level if now >= due else image[number]
            if now >= due:
                del self.waiting[number]
        for number in [n for n in self.signals if n in numbers]:
            signal = self.signals[number]
            least = self.filter_us if number in self.filtered and number not in self.unfiltered else 0
            level = steady(signal, now, least) if least else self.terminals[number]
            if level is not None:
                fresh[number] = level
                self.waiting.pop(number, None)
            else:
                fresh[number] = image[number]
            if signal.end is not None and signal.end + least <= now:
                del self.signals[number]
                self.wake(bool(self.signals))
        return fresh

    def snapshot(self) -> tuple:
        needs = self.taken, self.unfiltered
        return list(self.terminals), dict(self.waiting), dict(self.signals), self.time, self.catching, self.filter_us, *needs

    def restore(self, snapshot: tuple) -> None:
        self.terminals[:] = snapshot[0]
        self.waiting, self.signals = dict(snapshot[1]), dict(snapshot[2])
        self.time, self.catching, self.filter_us, self.taken, self.unfiltered = snapshot[3:]
        self.wake(bool(self.signals))
        self.changed = True
