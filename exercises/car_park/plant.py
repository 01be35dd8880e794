"""A car park with one lane for both ways, and two light barriers across it, one close behind the other.

Everything is in metres and seconds. The outer barrier is at 0 m, the inner one GAP further in. Cars, buses and people on
foot come through the lane one after the other; some turn back half-way.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import ClassVar, NamedTuple

from ..plant import DIGITS, Machine, Point

PLACES = 4
GAP = 0.4  # between the barriers
LENGTHS = {"car": 4.5, "bus": 12.0, "walker": 0.3}
SPEEDS = {"car": 2.0, "bus": 1.5, "walker": 1.25}  # m/s
APPROACH = 5.0  # so far from the barriers a visit begins and ends
TURN_S = 1.0  # standing still, before it goes back


class Visit(NamedTuple):
    """Somebody who comes through the lane: who, from and to where ("street" or "park"), and how long after the one before.

    `turns` are the places at which it goes the other way, as parts of the way from the outer barrier (0) until both are
    behind it (1). Who `obeys` drives on when the sign says that the park is full.
    """

    who: str = "car"
    comes: str = "street"
    goes: str = "park"
    turns: tuple[float, ...] = ()
    pause_s: float = 1.0
    obeys: bool = True


@dataclass
class CarPark(Machine):
    """The machine. `visits` come one after the other; `inside` is how many vehicles stand in it at first.

    Between two turns everything moves at a constant speed.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Outer", "light barrier on the street's side, ON when something is in it"),
        "X1": Point("Inner", "light barrier on the park's side, ON when something is in it"),
        "X2": Point("Zero", "key switch of the attendant: the park is empty"),
        "Y0": Point("Full", "sign at the street: full"),
        "Y1": Point("Warn", "lamp at the street: something comes out"),
        "D0": Point("Cars", "how many vehicles are inside, for the display"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1")
    EXACT: ClassVar[tuple[str, ...]] = ("_leg_s",)
    FAULTS: ClassVar[dict[str, str]] = {
        "outer knocked": "the outer barrier looks over cars and people and sees buses only",
        "inner knocked": "the inner barrier looks over cars and people and sees buses only",
    }

    visits: tuple[Visit, ...] = (Visit(),)
    inside: int = 0

    who: str = field(default="", init=False)  # in the lane now
    place: float = field(default=0.0, init=False)  # of its end towards the park
    entered: int = field(default=0, init=False)  # vehicles
    left: int = field(default=0, init=False)
    turned_away: int = field(default=0, init=False)  # by the sign
    done: int = field(default=0, init=False)  # visits that are over

    _legs: tuple[tuple[float, float, str], ...] = field(default=(), init=False, repr=False)  # seconds, m/s, what comes then
    _leg_s: float = field(default=0.0, init=False, repr=False)  # what is left of the first one

    def __post_init__(self):
        for visit in self.visits:
            if visit.who not in LENGTHS or not {visit.comes, visit.goes} <= {"street", "park"} or visit.pause_s < 0:
                raise ValueError(f"visits: {', '.join(LENGTHS)} between street and park are needed, not {visit}")
            if len(visit.turns) % 2 != (visit.comes == visit.goes) or not all(0 < turn < 1 for turn in visit.turns):
                raise ValueError(f"visits: the turns (each between 0 and 1) do not lead from {visit.comes} to {visit.goes}: {visit}")
        if self.inside < 0:
            raise ValueError(f"inside: 0 or more vehicles are needed, not {self.inside}")
        self._await()
        super().__post_init__()

    @property
    def visit(self) -> Visit | None:
        """The one under way, or that comes next."""
        return self.visits[self.done] if self.done < len(self.visits) else None

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under the sign Y0; returns the light barriers X0 and X1."""
        super().step(seconds, outputs)
        if self.who:
            self._look()
        return self.inputs

    def _move(self, seconds):
        if self._legs:
            self.place += self._legs[0][1] * seconds
            self._leg_s -= seconds

    def _plan(self):
        if self._legs and self._leg_s <= 0:
            self._next()
        self._look()
        return self._leg_s if self._legs else inf

    def _look(self):
        """What the light barriers see."""
        outer = inner = 0
        if self.who:
            front = round(self.place, DIGITS)
            rear = round(self.place - LENGTHS[self.who], DIGITS)
            tall = self.who == "bus"
            outer = int(rear < 0 < front and (tall or "outer knocked" not in self.faults))
            inner = int(rear < GAP < front and (tall or "inner knocked" not in self.faults))
        self.inputs = {"X0": outer, "X1": inner}

    def _await(self):
        """Wait for the next visit."""
        visit = self.visit
        self._legs = ((visit.pause_s, 0.0, "comes"),) if visit else ()
        self._leg_s = visit.pause_s if visit else 0.0

    def _next(self):
        """A leg is over: what comes then."""
        what, visit = self._legs[0][2], self.visit
        self._legs = self._legs[1:]
        if what == "comes":
            self._begin(visit)
        elif what == "through" and visit.who != "walker":
            self._count(visit)
        elif what == "gone":
            self.who, self.done = "", self.done + 1
            self._await()
        if self._legs:
            self._leg_s = self._legs[0][0]

    def _begin(self, visit):
        """Somebody appears: plan the way through the lane."""
        if visit.comes == "park" and visit.who != "walker" and not self.inside:
            return self._skip()
        if visit.comes == "street" and visit.who != "walker" and visit.obeys and self._outputs[0]:
            self.turned_away += 1
            return self._skip()
        length, speed = LENGTHS[visit.who], SPEEDS[visit.who]
        ends = {"street": -APPROACH, "park": length + GAP + APPROACH}
        through = {"street": 0.0, "park": length + GAP}[visit.goes]
        places = [ends[visit.comes], *(turn * (length + GAP) for turn in visit.turns), through, ends[visit.goes]]
        whats = [*("turns" for _ in visit.turns), "through", "gone"]
        legs = []
        for start, end, what in zip(places, places[1:], whats, strict=False):
            legs.append((abs(end - start) / speed, speed if end > start else -speed, what))
            if what == "turns":
                legs.append((TURN_S, 0.0, "on"))
        self.who, self.place, self._legs = visit.who, places[0], tuple(legs)
        return None

    def _skip(self):
        self.done += 1
        self._await()

    def _count(self, visit):
        """A vehicle has both barriers behind it."""
        if visit.comes == visit.goes:
            return
        if visit.goes == "park":
            self.entered, self.inside = self.entered + 1, self.inside + 1
            if self.inside > PLACES and visit.obeys:
                self._note(f"a {visit.who} finds no place")
        else:
            self.left, self.inside = self.left + 1, self.inside - 1
