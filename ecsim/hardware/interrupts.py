"""Interrupts: who may ask for an interrupt program, and when (chapter 9). Times are exact to the microsecond."""

from ..memory import Memory

FIRST_TIMED, TIMED = 26, 3  # events 26 to 28: relays SM66-68 enable, registers SD66-68 hold the period in ms
FIRST_SWITCH = 66
EDGES, EDGE_SWITCH, FALLING = 8, 40, 10  # events 0 to 7 and 10 to 17: rising and falling edges of X0 to X7, enabled by SM40-47
DEPTH = 8


class Interrupts:
    """The global enable, the timed interrupts and those of the inputs' edges."""

    def __init__(self, memory: Memory):
        self.memory = memory
        self.enabled = False
        self.routines: dict[int, str] = {}
        self.due: list[int | None] = [None] * TIMED
        self.queue: list[int] = []

    def edge(self, number: int, level: bool) -> None:
        """An input terminal has changed; a request that is not allowed is lost."""
        if number < EDGES and self.enabled and self.memory.lists[self.memory.model.special_bits][EDGE_SWITCH + number]:
            self.request(number if level else FALLING + number)

    def request(self, event: int) -> None:
        """Queue a request; one without a routine is no operation."""
        if event in self.routines and len(self.queue) < DEPTH:
            self.queue.append(event)

    def restart(self, routines: dict[int, str]) -> None:
        """STOP -> RUN: nothing is enabled until EI."""
        self.enabled = False
        self.routines = routines
        self.due = [None] * TIMED
        self.queue.clear()

    def arm(self, now: int) -> None:
        """Look at the enables after a program has run: a timer that was enabled begins its first period now."""
        relays, registers = self.memory.lists[self.memory.model.special_bits], self.memory.lists[self.memory.model.special_words]
        for place in range(TIMED):
            active = relays[FIRST_SWITCH + place] and registers[FIRST_SWITCH + place] >= 1
            if not active:
                self.due[place] = None
            elif self.due[place] is None:
                self.due[place] = now + registers[FIRST_SWITCH + place] * 1000

    def take(self, until: int) -> tuple[int, str | None] | None:
        """The next event up to a time: when, and which routine asks to run (None when it may not or there is none)."""
        waiting = [(due, place) for place, due in enumerate(self.due) if due is not None and due <= until]
        if not waiting:
            return None
        due, place = min(waiting)
        self.due[place] = due + self.memory.lists[self.memory.model.special_words][FIRST_SWITCH + place] * 1000
        return due, self.routines.get(FIRST_TIMED + place) if self.enabled else None
