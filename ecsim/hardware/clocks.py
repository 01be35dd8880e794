"""The clock relays SM10 to SM14 and SM15 (appendix 1, section 2)."""

from ..memory import Memory

# Meaning of the relay and half its period in units of 5 ms.
_CLOCKS = (("clock 10 ms", 1), ("clock 100 ms", 10), ("clock 1 s", 100), ("clock 1 min", 6_000), ("clock 1 h", 360_000))
UNIT_US = 5_000
SLOWER = 10  # all but the fastest change at multiples of so many units


class Clocks:
    """Square waves counted from the begin of RUN; their first half period is OFF."""

    def __init__(self, memory: Memory):
        self.memory = memory
        model = memory.model
        self.area = model.special_bits
        (self.fastest, _), *self.slow = [(model.relays[meaning], half) for meaning, half in _CLOCKS if meaning in model.relays]
        self.toggle = model.relays.get("scan toggle")
        self.restart(0)

    def restart(self, now: int) -> None:
        """RUN begins."""
        self.began = self.due = now
        self.slow_due = 0  # in units

    def refresh(self, now: int, first: bool) -> None:
        """Set the relays for the scan that begins."""
        relays = self.memory.lists[self.area]
        toggle = self.toggle
        if toggle is not None:
            relays[toggle] = not first and not relays[toggle]
        if now >= self.due:
            units = (now - self.began) // UNIT_US
            relays[self.fastest] = units & 1 == 1
            self.due = self.began + (units + 1) * UNIT_US
            if units >= self.slow_due:
                for number, half in self.slow:
                    relays[number] = units // half & 1 == 1
                self.slow_due = (units // SLOWER + 1) * SLOWER
