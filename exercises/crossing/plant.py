"""A pedestrian crossing: a road with cars that keep to their lights, people who press a button, wait, and walk."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import inf
from operator import attrgetter
from typing import ClassVar, NamedTuple

from ..plant import Faulty, Point

STOP_S = 2.0  # a car that is nearer than this cannot stop any more when the light turns
CROSS_S = 6.0  # a walker needs so long across
PATIENCE_S = 60.0  # who waits longer walks without his light
DRAWN = 8  # so many cars that have passed are remembered for the picture
INSTANT = 1e-9


class Incident(NamedTuple):
    """Something that must not happen on the road, as a fact: when, and what."""

    seconds: float
    what: str


@dataclass
class Crossing(Faulty):
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
    FAULTS: ClassVar[dict[str, str]] = {"button sticks": "the button is pressed all the time", "button dead": "the button's wire is broken"}

    cars: tuple[float, ...] = ()
    walkers: tuple[float, ...] = ()

    faults: frozenset[str] = field(default=frozenset(), init=False)
    seconds: float = field(default=0.0, init=False)
    waiting: tuple[float, ...] = field(default=(), init=False)  # since when each waits at the kerb
    walking: tuple[float, ...] = field(default=(), init=False)  # since when each is on the road
    queue: int = field(default=0, init=False)  # cars at the line
    passed: int = field(default=0, init=False)  # cars
    crossed: int = field(default=0, init=False)  # walkers
    leaving: tuple[tuple[int, float, int], ...] = field(
        default=(), init=False
    )  # the last cars over the line: number, when, place in the queue
    incidents: tuple[Incident, ...] = field(default=(), init=False)

    _outputs: tuple[int, ...] = field(default=(0,) * 5, init=False, repr=False)
    _next_car: int = field(default=0, init=False, repr=False)
    _next_walker: int = field(default=0, init=False, repr=False)
    _green_since: float = field(default=-inf, init=False, repr=False)  # when the cars' light left green, or inf while it is green
    _due: float = field(default=0.0, init=False, repr=False)  # the next moment at which something happens
    _pressed: bool = field(default=False, init=False, repr=False)

    def __post_init__(self):
        for name in ("cars", "walkers"):
            times = getattr(self, name)
            if any(one < 0 for one in times) or list(times) != sorted(times):
                raise ValueError(f"{name}: times from 0 s on in their order are needed, not {times}")
        self._settle()

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under the lamps Y0 to Y4; returns the button X0."""
        now = (outputs["Y0"], outputs["Y1"], outputs["Y2"], outputs["Y3"], outputs["Y4"])
        if now != self._outputs:
            self._turn(now)
        end = self.seconds + seconds
        while self._due <= end + INSTANT:
            self.seconds = max(self.seconds, self._due)
            self._settle()
        self.seconds = end
        return {"X0": int(("button sticks" in self.faults or self._pressed) and "button dead" not in self.faults)}

    def state(self) -> tuple:
        """Everything the crossing is, as a value; `restore` takes it back."""
        return whole(self)

    def restore(self, state: tuple) -> None:
        """Make the crossing what it was when `state` was taken."""
        vars(self).update(zip(FIELDS, state, strict=True))

    def _turn(self, lamps):
        """The lamps have changed."""
        was_green, green = self._outputs[2], lamps[2]
        self._outputs = lamps
        if was_green and not green:
            self._green_since = self.seconds
        if green and lamps[4]:
            self._note("cars and walkers have green together")
        self._settle()

    def _settle(self):
        """What happens at this moment, and when the next thing will."""
        now = self.seconds
        self._walk(now)
        self._drive(now)
        moments = [*(start + CROSS_S for start in self.walking), *(start + PATIENCE_S for start in self.waiting)]
        if self._next_car < len(self.cars):
            moments.append(self.cars[self._next_car])
        if self._next_walker < len(self.walkers):
            moments.append(self.walkers[self._next_walker])
        self._due = min((moment for moment in moments if moment > now + INSTANT), default=inf)
        self._pressed = bool(self.waiting)

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

    def _note(self, what):
        self.incidents += (Incident(round(self.seconds, 3), what),)


FIELDS = tuple(part.name for part in fields(Crossing))
whole = attrgetter(*FIELDS)
