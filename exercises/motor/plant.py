"""A reversing drive: two contactors, one motor, an overload relay, and three push buttons in the operator's hand."""

from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import Machine, Point, remaining, towards

CLOSE_S, OPEN_S = 0.015, 0.025  # a contactor needs so long to close, and to open with its arc
RUN_UP_S, COAST_S, BRAKE_S = 1.5, 4.0, 0.7  # from standstill to speed, back by itself, back against the other direction
TRIP_S, COOL_S = 5.0, 30.0  # a motor that cannot turn trips its overload relay; the relay closes again when it is cool
TURN_S = 0.8  # of the shaft as it is drawn


@dataclass
class Motor(Machine):
    """The drive: between two changes everything moves at a constant rate."""

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Forward", "push button: turn forward"),
        "X1": Point("Reverse", "push button: turn in reverse"),
        "X2": Point("StopPB", "push button, opens when it is pressed: OFF stops"),
        "X3": Point("Healthy", "overload relay, opens when the motor is too hot: OFF stops"),
        "Y0": Point("RunF", "contactor forward"),
        "Y1": Point("RunR", "contactor reverse"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1")
    EXACT: ClassVar[tuple[str, ...]] = ("forward", "reverse", "speed", "heat")
    FAULTS: ClassVar[dict[str, str]] = {"jammed": "the shaft cannot turn", "F welded": "the forward contactor does not open"}

    forward: float = field(default=0.0, init=False)  # contactors: 0 open, 1 closed
    reverse: float = field(default=0.0, init=False)
    speed: float = field(default=0.0, init=False)  # 1 is full speed forward, -1 in reverse
    turns: float = field(default=0.0, init=False)
    heat: float = field(default=0.0, init=False)  # 1 trips the overload relay
    tripped: bool = field(default=False, init=False)
    blown: bool = field(default=False, init=False)  # the fuses, by a short circuit

    _rates: tuple[float, ...] = field(default=(0.0,) * 4, init=False, repr=False)  # of both contactors, speed and heat

    def _move(self, seconds):
        forward, reverse, speed, heat = self._rates
        self.turns += (self.speed * seconds + speed * seconds * seconds / 2) / TURN_S
        self.forward += forward * seconds
        self.reverse += reverse * seconds
        self.speed += speed * seconds
        self.heat += heat * seconds

    def _plan(self):
        if self.heat >= 1:
            self.tripped = True
        elif self.heat <= 0:
            self.tripped = False
        driven = [self._outputs[0] or ("F welded" in self.faults and self.forward > 0), self._outputs[1]]
        rates = [
            towards(place, int(bool(on)), CLOSE_S if on else OPEN_S) for place, on in zip((self.forward, self.reverse), driven, strict=True)
        ]
        closed = self.forward > 0 and (self.forward == 1 or rates[0] < 0), self.reverse > 0 and (self.reverse == 1 or rates[1] < 0)
        if all(closed):
            self._report({"a short circuit between the phases"})
            self.blown = True
        else:
            self._report(set())
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
        self.inputs = {"X3": int(not self.tripped)}
        way = abs(self.speed) if self.speed * speed < 0 else abs(wanted - self.speed)
        parts = (self.forward, rates[0]), (self.reverse, rates[1]), (self.heat, heat)
        return min(*(remaining(place, rate) for place, rate in parts), way / abs(speed) if speed else inf)
