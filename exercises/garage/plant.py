"""A garage door: a motor that opens and closes it, end switches, a light barrier, and cars that want in and out."""

from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import INSTANT, Machine, Point

TRAVEL_S = 8.0  # from closed to open
PASS_S = 4.0  # a car stands in the light barrier so long
CLEAR = 0.9  # the door must be so far open for a car
TOUCH = 0.68  # here the door touches what stands under it
LOWEST, HIGHEST = -0.02, 1.02  # so far the motor may push before something bends
MARKS = (LOWEST, 0.0, TOUCH, CLEAR, 1.0, HIGHEST)


@dataclass
class Garage(Machine):
    """The door. `cars` are the seconds at which a car wants to drive through; it waits until the door is open and then does.

    Between two changes the door moves at a constant speed.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Key", "key switch or remote control"),
        "X1": Point("Open", "the door is open"),
        "X2": Point("Closed", "the door is closed"),
        "X3": Point("Barrier", "light barrier, ON while nothing is in the way"),
        "Y0": Point("MoveUp", "motor: opens"),
        "Y1": Point("MoveDown", "motor: closes"),
        "Y2": Point("Lamp", "warning lamp"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1")
    EXACT: ClassVar[tuple[str, ...]] = ("place",)
    FAULTS: ClassVar[dict[str, str]] = {"child": "somebody stands in the doorway", "jammed": "the door cannot move"}

    cars: tuple[float, ...] = ()

    place: float = field(default=0.0, init=False)  # 0 closed, 1 open
    inside: float = field(default=-inf, init=False)  # when the last car drove under the door
    waiting: int = field(default=0, init=False)  # cars before the door
    through: int = field(default=0, init=False)  # cars that have driven through

    _next_car: int = field(default=0, init=False, repr=False)
    _rate: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self):
        if any(one < 0 for one in self.cars) or list(self.cars) != sorted(self.cars):
            raise ValueError(f"cars: times from 0 s on in their order are needed, not {self.cars}")
        super().__post_init__()

    @property
    def blocked(self) -> bool:
        """Whether something is in the doorway."""
        return "child" in self.faults or self.seconds < self.inside + PASS_S - INSTANT

    @property
    def is_open(self) -> bool:
        """Whether the upper end switch is actuated: at its mark, until the door leaves it."""
        return self.place >= 1 if self._rate >= 0 else self.place > 1

    @property
    def is_closed(self) -> bool:
        """Whether the lower end switch is actuated."""
        return self.place <= 0 if self._rate <= 0 else self.place < 0

    def _move(self, seconds):
        self.place += self._rate * seconds

    def _plan(self):
        self._let_cars_through()
        up, down = self._outputs
        amiss = set()
        if up and down:
            amiss.add("the motor is driven both ways")
        rate = 0.0 if "jammed" in self.faults else (bool(up) - bool(down)) / TRAVEL_S
        low, high = LOWEST if not self.blocked or self.place < TOUCH else TOUCH, HIGHEST
        if rate < 0 and self.place <= low:
            amiss.add("the door hits what stands under it" if low == TOUCH else "the motor pushes the door against its end")
            rate = 0.0
        elif rate > 0 and self.place >= high:
            amiss.add("the motor pushes the door against its end")
            rate = 0.0
        self._report(amiss)
        self._rate = rate
        self.inputs = {"X1": int(self.is_open), "X2": int(self.is_closed), "X3": int(not self.blocked)}
        ahead = [mark for mark in MARKS if (mark > self.place if rate > 0 else mark < self.place)]
        ways = [abs((min(ahead) if rate > 0 else max(ahead)) - self.place) / abs(rate)] if rate and ahead else []
        if self._next_car < len(self.cars):
            ways.append(self.cars[self._next_car] - self.seconds)
        if self.seconds < self.inside + PASS_S - INSTANT:
            ways.append(self.inside + PASS_S - self.seconds)
        return min(ways, default=inf)

    def _let_cars_through(self):
        while self._next_car < len(self.cars) and self.cars[self._next_car] <= self.seconds + INSTANT:
            self._next_car += 1
            self.waiting += 1
        if self.waiting and self.place >= CLEAR and not self.blocked:
            self.waiting -= 1
            self.through += 1
            self.inside = self.seconds
