"""A reversing drive: two contactors, one motor, an overload relay, and three push buttons in the operator's hand."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import inf
from operator import attrgetter
from typing import ClassVar, NamedTuple

from ..plant import Faulty, Point, towards

CLOSE_S, OPEN_S = 0.015, 0.025  # a contactor needs so long to close, and to open with its arc
RUN_UP_S, COAST_S, BRAKE_S = 1.5, 4.0, 0.7  # from standstill to speed, back by itself, back against the other direction
TRIP_S, COOL_S = 5.0, 30.0  # a motor that cannot turn trips its overload relay; the relay closes again when it is cool
TURN_S = 0.8  # of the shaft as it is drawn
INSTANT = 1e-9


class Incident(NamedTuple):
    """Something that must not happen to a machine, as a fact: when, and what."""

    seconds: float
    what: str


@dataclass
class Motor(Faulty):
    """The drive. A step of any length gives the same run: between two changes everything moves at a constant rate."""

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Forward", "push button: turn forward"),
        "X1": Point("Reverse", "push button: turn in reverse"),
        "X2": Point("StopPB", "push button, opens when it is pressed: OFF stops"),
        "X3": Point("Healthy", "overload relay, opens when the motor is too hot: OFF stops"),
        "Y0": Point("RunF", "contactor forward"),
        "Y1": Point("RunR", "contactor reverse"),
    }
    FAULTS: ClassVar[dict[str, str]] = {"jammed": "the shaft cannot turn", "F welded": "the forward contactor does not open"}

    faults: frozenset[str] = field(default=frozenset(), init=False)
    seconds: float = field(default=0.0, init=False)
    forward: float = field(default=0.0, init=False)  # contactors: 0 open, 1 closed
    reverse: float = field(default=0.0, init=False)
    speed: float = field(default=0.0, init=False)  # 1 is full speed forward, -1 in reverse
    turns: float = field(default=0.0, init=False)
    heat: float = field(default=0.0, init=False)  # 1 trips the overload relay
    tripped: bool = field(default=False, init=False)
    blown: bool = field(default=False, init=False)  # the fuses, by a short circuit
    incidents: tuple[Incident, ...] = field(default=(), init=False)

    _outputs: tuple[int, ...] = field(default=(0, 0), init=False, repr=False)
    _rates: tuple[float, ...] = field(default=(0.0,) * 4, init=False, repr=False)  # of both contactors, speed and heat
    _steady_s: float = field(default=0.0, init=False, repr=False)
    _amiss: bool = field(default=False, init=False, repr=False)

    def __post_init__(self):
        self._settle()

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under the contactors Y0 and Y1; returns the overload relay X3. The push buttons are in the operator's hand."""
        now = (outputs["Y0"], outputs["Y1"])
        if now != self._outputs:
            self._outputs = now
            self._settle()
        while seconds > self._steady_s - INSTANT:
            self._move(self._steady_s)
            seconds = max(0.0, seconds - self._steady_s)
            self._settle()
        self._move(seconds)
        self._steady_s -= seconds
        return {"X3": int(not self.tripped)}

    def state(self) -> tuple:
        """Everything the machine is, as a value; `restore` takes it back."""
        return whole(self)

    def restore(self, state: tuple) -> None:
        """Make the machine what it was when `state` was taken."""
        vars(self).update(zip(FIELDS, state, strict=True))

    def _move(self, seconds):
        if not seconds:
            return
        forward, reverse, speed, heat = self._rates
        self.seconds += seconds
        self.turns += (self.speed * seconds + speed * seconds * seconds / 2) / TURN_S
        self.forward += forward * seconds
        self.reverse += reverse * seconds
        self.speed += speed * seconds
        self.heat += heat * seconds

    def _settle(self):
        """Take note of what has just changed: how everything moves from here on, for how long, and what is amiss."""
        for name in ("forward", "reverse", "speed", "heat"):
            setattr(self, name, round(getattr(self, name), 9))
        if self.heat >= 1:
            self.tripped = True
        elif self.heat <= 0:
            self.tripped = False
        driven = [self._outputs[0] or ("F welded" in self.faults and self.forward > 0), self._outputs[1]]
        rates = [
            towards(place, int(bool(on)), CLOSE_S if on else OPEN_S) for place, on in zip((self.forward, self.reverse), driven, strict=True)
        ]
        closed = self.forward > 0 and (self.forward == 1 or rates[0] < 0), self.reverse > 0 and (self.reverse == 1 or rates[1] < 0)
        if all(closed) and not self._amiss:
            self.incidents += (Incident(round(self.seconds, 3), "a short circuit between the phases"),)
            self.blown = True
        self._amiss = all(closed)
        wanted = 0 if self.blown else closed[0] - closed[1]
        if "jammed" in self.faults:
            self.speed, speed = 0.0, 0.0
        elif self.speed == wanted:
            speed = 0.0
        elif not wanted:
            speed = towards(self.speed, 0, COAST_S)
        else:
            speed = wanted / (BRAKE_S if self.speed * wanted < 0 else RUN_UP_S)
        heat = 1 / TRIP_S if wanted and "jammed" in self.faults else -1 / COOL_S if self.heat > 0 else 0.0
        if self.heat >= 1 and heat > 0:
            heat = 0.0
        self._rates = (*rates, speed, heat)
        ends = [
            (1 - self.forward if rates[0] > 0 else self.forward, rates[0]),
            (1 - self.reverse if rates[1] > 0 else self.reverse, rates[1]),
        ]
        ends += [(1 - self.heat if heat > 0 else self.heat, heat)]
        ends += [(abs(self.speed) if self.speed * speed < 0 else abs(wanted - self.speed), speed)]
        self._steady_s = min((way / abs(rate) for way, rate in ends if rate), default=inf)


FIELDS = tuple(part.name for part in fields(Motor))
whole = attrgetter(*FIELDS)
