"""The EEPROM of the main module, which keeps registers for good (2.1.8, 6.8.8)."""

from collections.abc import Container

from ..memory import Memory
from .unit import Unit

AREA = "D"
WRITE_US = 5_000  # 2.1.8: a write takes 2 to 5 ms


class Eeprom(Unit):
    """Saved registers by number. A relay tells that nothing is being written; a write meanwhile is not carried out."""

    def __init__(self, memory: Memory, awake: list[Unit]):
        super().__init__(awake)
        self.memory = memory
        self.relay = memory.model.relays.get("eeprom idle")
        self.cells: dict[int, int] = {}
        self.due: int | None = None  # when the present write ends
        self.sound = True  # a broken one takes nothing in

    def save(self, first: int, count: int, now: int) -> bool:
        """Begin to write `count` registers from number `first` on; False while another write goes on."""
        if self.due is not None:
            return False
        if self.sound:
            self.cells.update(enumerate(self.memory.lists[AREA][first : first + count], first))
        self._busy(now + WRITE_US)
        return True

    def recall(self, keep: Container[int]) -> None:
        """Give the saved registers back but for the numbers to keep."""
        registers = self.memory.lists[AREA]
        for number, value in self.cells.items():
            if number not in keep:
                registers[number] = value

    def _busy(self, due: int | None) -> None:
        self.due = due
        self.wake(due is not None)
        if self.relay is not None:
            self.memory.lists[self.memory.model.special_bits][self.relay] = due is None

    def next(self, until: int) -> int | None:
        return self.due if self.due is not None and self.due <= until else None

    def advance(self, now: int) -> None:
        if self.due is not None and now >= self.due:
            self._busy(None)

    def restart(self, now: int) -> None:
        self._busy(None)

    def snapshot(self) -> tuple:
        return dict(self.cells), self.due, self.sound

    def restore(self, snapshot: tuple) -> None:
        self.cells, self.due, self.sound = dict(snapshot[0]), *snapshot[1:]
        self.wake(self.due is not None)
