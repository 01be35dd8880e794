"""Timers: T devices counting whole units of simulated time (3.1.6, 5.4)."""

from ..memory import Memory

LONGEST = 32767


class Timers:
    """Moves the values of running timers; `DUE[n]` is when timer n counts next, 0 while it stands."""

    def __init__(self, memory: Memory, clock: list[int]):
        self.memory, self.clock = memory, clock
        model = memory.model
        self.bases = [model.timer_base_us(n) for n in range(model.areas["T"].count)]
        self.fast = range(model.fast_timers[0], model.fast_timers[1] + 1)
        self.watched: dict[int, tuple[int, int | None]] = {}

    def tick(self, number: int) -> None:
        """Count the units that have gone by since the last one; a timer that stood begins its first unit now."""
        lists = self.memory.lists
        due, base, now = lists["DUE"][number], self.bases[number], self.clock[0]
        if due:
            units = (now - due) // base + 1
            lists["T"][number] = min(lists["T"][number] + units, LONGEST)
            lists["DUE"][number] = due + units * base
        else:
            lists["DUE"][number] = now + base

    def begin(self, number: int) -> None:
        """As `tick`, but a timer that stood begins from 0 with its contact OFF (5.4.1, rule 4)."""
        lists = self.memory.lists
        if not lists["DUE"][number]:
            lists["T"][number] = 0
            lists["TB"][number] = False
        self.tick(number)

    def resume(self, number: int) -> None:
        """As `tick`, but a timer that stood goes on with the part of a unit that it had."""
        lists = self.memory.lists
        if lists["DUE"][number]:
            self.tick(number)
        else:
            lists["DUE"][number] = self.clock[0] + self.bases[number] - lists["REST"][number]
            if lists["REST"][number] >= self.bases[number]:
                self.tick(number)

    def watch(self, number: int, preset: int, final: int | None) -> None:
        """Remember what a timer counted by interrupt does on reaching its preset: contact ON and on it counts, or OFF at a final value."""
        self.watched[number] = (preset, final)

    def advance(self) -> None:
        """Bring the 1 ms timers up to the present; they count without waiting for their instruction (3.1.6)."""
        lists = self.memory.lists
        now = self.clock[0]
        for number, (preset, final) in self.watched.items():
            if lists["DUE"][number] and now >= lists["DUE"][number]:
                self.tick(number)
                if lists["T"][number] >= preset:
                    lists["TB"][number] = final is None
                    if final is not None:
                        lists["T"][number], lists["DUE"][number] = final, 0

    def restart(self) -> None:
        """Forget what is watched (STOP -> RUN)."""
        self.watched.clear()
