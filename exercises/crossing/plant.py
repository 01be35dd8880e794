"""A pedestrian crossing: a road with cars that keep to their lights, people who press a button, wait, and walk."""

from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import INSTANT, Machine, Point

STOP_S = 2.0  # a car that is nearer than this cannot stop any more when the light turns
CROSS_S = 6.0  # a walker needs so long across
PATIENCE_S = 60.0  # who waits longer walks without his light
DRAWN = 8  # so many cars that have passed are remembered for the picture


@dataclass
class Crossing(Machine):
    """The crossing. `cars` are the seconds at which a car reaches the line, `walkers` those at which somebody comes to the kerb.

    A car goes on when its light is green, or yellow and it can no longer stop; a walker goes when his light is green. Lamps
    that contradict each other, and people on the road in front of a moving car, are facts of the crossing.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Button", "somebody presses the button at the kerb"),
        "Y0": Point("CarRed", "cars: red"),
        "Y1": Point("CarYell", "cars: yellow"),
        "Y2": Point("CarGrn", "cars: green"),
        "Y3": Point("WalkRed", "walkers: red"),
        "Y4": Point("WalkGrn", "walkers: green"),
        "Y5": Point("Wait", "the sign at the kerb: the button was pressed, please wait"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2", "Y3", "Y4")
    EXACT: ClassVar[tuple[str, ...]] = ("seconds",)
    FAULTS: ClassVar[dict[str, str]] = {"button sticks": "the button is pressed all the time", "button dead": "the button's wire is broken"}

    cars: tuple[float, ...] = ()
    walkers: tuple[float, ...] = ()

    waiting: tuple[float, ...] = field(default=(), init=False)  # since when each waits at the kerb
    walking: tuple[float, ...] = field(default=(), init=False)  # since when each is on the road
    queue: int = field(default=0, init=False)  # cars at the line
    passed: int = field(default=0, init=False)  # cars
    crossed: int = field(default=0, init=False)  # walkers
    leaving: tuple[tuple[int, float, int], ...] = field(
        default=(), init=False
    )  # the last cars over the line: number, when, place in the queue

    _next_car: int = field(default=0, init=False, repr=False)
    _next_walker: int = field(default=0, init=False, repr=False)
    _lamps: tuple[int, ...] = field(default=(0,) * 5, init=False, repr=False)  # what they were
    _green_since: float = field(default=-inf, init=False, repr=False)  # when the cars' light left green, or inf while it is green

    def __post_init__(self):
        for name in ("cars", "walkers"):
            times = getattr(self, name)
            if any(one < 0 for one in times) or list(times) != sorted(times):
                raise ValueError(f"{name}: times from 0 s on in their order are needed, not {times}")
        super().__post_init__()

    def _plan(self):
        now = self.seconds
        if self._outputs != self._lamps:
            self._turn()
        self._walk(now)
        self._drive(now)
        moments = [*(start + CROSS_S for start in self.walking), *(start + PATIENCE_S for start in self.waiting)]
        if self._next_car < len(self.cars):
            moments.append(self.cars[self._next_car])
        if self._next_walker < len(self.walkers):
            moments.append(self.walkers[self._next_walker])
        pressed = ("button sticks" in self.faults or self.waiting) and "button dead" not in self.faults
        self.inputs = {"X0": int(bool(pressed))}
        return min((moment for moment in moments if moment > now + INSTANT), default=inf) - now

    def _turn(self):
        """The lamps have changed."""
        was_green, green, walk = self._lamps[2], self._outputs[2], self._outputs[4]
        self._lamps = self._outputs
        if was_green and not green:
            self._green_since = self.seconds
        if green and walk:
            self._note("cars and walkers have green together")

    def _walk(self, now):
        while self._next_walker < len(self.walkers) and self.walkers[self._next_walker] <= now + INSTANT:
            self.waiting += (self.walkers[self._next_walker],)
            self._next_walker += 1
        done = [start for start in self.walking if start + CROSS_S <= now + INSTANT]
        if done:
            self.crossed += len(done)
            self.walking = tuple(start for start in self.walking if start not in done)
        if self._outputs[4] and self.waiting:
            self.walking += (now,) * len(self.waiting)
            self.waiting = ()
        bold = [start for start in self.waiting if start + PATIENCE_S <= now + INSTANT]
        if bold:
            self._note("somebody loses patience and walks without green")
            self.waiting = tuple(start for start in self.waiting if start not in bold)
            self.walking += (now,) * len(bold)

    def _drive(self, now):
        while self._next_car < len(self.cars) and self.cars[self._next_car] <= now + INSTANT:
            self._next_car += 1
            if self._outputs[2] or (self._outputs[1] and not self._outputs[0] and now - self._green_since <= STOP_S):
                self._pass(self._next_car - 1, 1)
            else:
                self.queue += 1
        if self._outputs[2] and self.queue:
            cars, self.queue = self.queue, 0
            self._pass(self._next_car - cars, cars)

    def _pass(self, first, cars):
        self.passed += cars
        self.leaving = (*self.leaving, *((first + place, self.seconds, place) for place in range(cars)))[-DRAWN:]
        if self.walking:
            self._note("a car drives while somebody is on the road")
