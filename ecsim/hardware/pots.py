"""The analog potentiometers on the front of the main module (2.1.1): knobs that a program reads with VRRD."""

from collections.abc import Iterator

from ..errors import EcsimError
from .unit import Unit

GREATEST = 255  # eight bits


class Potentiometers(Unit):
    """The knobs by number, each at a value of 0 to 255: `plc.pots[0] = 128` turns the first one."""

    def __init__(self, count: int, awake: list[Unit]):
        super().__init__(awake)
        self.values = [0] * count

    def read(self, number: int) -> int:
        """The value of a knob; where there is none it is 0."""
        return self.values[number] if number < len(self.values) else 0

    def __getitem__(self, number: int) -> int:
        return self.values[self._known(number)]

    def __setitem__(self, number: int, value: int) -> None:
        if not isinstance(value, int) or not 0 <= value <= GREATEST:
            raise EcsimError(f"a potentiometer stands at 0 to {GREATEST}, not at {value!r}")
        self.values[self._known(number)] = int(value)

    def _known(self, number: int) -> int:
        if number not in range(len(self.values)):
            raise EcsimError(f"there is no potentiometer {number!r}; this PLC has {len(self.values)}, counted from 0")
        return number

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[int]:
        return iter(self.values)

    def __repr__(self) -> str:
        return f"<Potentiometers {self.values}>"

    def snapshot(self) -> list[int]:
        return list(self.values)

    def restore(self, snapshot: list[int]) -> None:
        self.values[:] = snapshot
