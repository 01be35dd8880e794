"""A motor that is started in star and runs in delta: three contactors and what they do to the motor and its fuses."""

from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import Machine, Point, remaining, towards

CLOSE_S, OPEN_S = 0.015, 0.025  # a contactor needs so long to close, and to open with its arc
STAR_S, DELTA_S, COAST_S = 4.0, 2.0, 10.0  # from standstill to full speed, and back by itself
STAR_SPEED = 0.85  # in star it gets no faster
SLOW = 0.7  # closing delta below this speed asks more of the mains than they give
TRIP_S, COOL_S = 6.0, 30.0  # a motor that cannot turn trips its overload relay; it closes again when it is cool
TURN_S = 0.6


@dataclass
class StarDelta(Machine):
    """The drive: between two changes everything moves at a constant rate."""

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Start", "push button"),
        "X1": Point("StopPB", "push button, opens when it is pressed: OFF stops"),
        "X2": Point("Healthy", "overload relay, opens when the motor is too hot: OFF stops"),
        "Y0": Point("Line", "line contactor"),
        "Y1": Point("Star", "star contactor"),
        "Y2": Point("Delta", "delta contactor"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2")
    EXACT: ClassVar[tuple[str, ...]] = ("places", "speed", "heat")
    FAULTS: ClassVar[dict[str, str]] = {"jammed": "the shaft cannot turn", "star welded": "the star contactor does not open"}

    places: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), init=False)  # contactors line, star, delta: 0 open, 1 closed
    speed: float = field(default=0.0, init=False)  # 1 is full speed
    turns: float = field(default=0.0, init=False)
    heat: float = field(default=0.0, init=False)  # 1 trips the overload relay
    tripped: bool = field(default=False, init=False)
    blown: bool = field(default=False, init=False)  # the fuses

    _rates: tuple[float, ...] = field(default=(0.0,) * 5, init=False, repr=False)  # of the contactors, of speed and heat
    _closed: tuple[bool, ...] = field(default=(False,) * 3, init=False, repr=False)

    def _move(self, seconds):
        *rates, speed, heat = self._rates
        self.turns += (self.speed * seconds + speed * seconds * seconds / 2) / TURN_S
        self.places = tuple([place + rate * seconds for place, rate in zip(self.places, rates, strict=True)])
        self.speed += speed * seconds
        self.heat += heat * seconds

    def _plan(self):
        places = self.places
        self.tripped = self.heat >= 1 or (self.tripped and self.heat > 0)
        line, star, delta = self._outputs
        driven = line, star or ("star welded" in self.faults and places[1] > 0), delta
        rates = [towards(place, int(bool(on)), CLOSE_S if on else OPEN_S) for place, on in zip(places, driven, strict=True)]
        # a contactor conducts when it has closed, and until it has opened
        closed = tuple(place > 0 and (place == 1 or rate < 0) for place, rate in zip(places, rates, strict=True))
        if closed[1] and closed[2] and not (self._closed[1] and self._closed[2]):
            self._note("star and delta short the mains")
        if closed[0] and closed[2] and not (self._closed[0] and self._closed[2]) and self.speed < SLOW and not self.blown:
            self._note(f"delta at {self.speed:.0%} of the speed blows the fuses")
        self._closed = closed
        powered = closed[0] and (closed[1] or closed[2]) and not self.blown
        top = (1.0 if closed[2] else STAR_SPEED) if powered else 0.0
        if "jammed" in self.faults:
            self.speed, speed = 0.0, 0.0
        elif powered and self.speed < top:
            speed = 1 / (DELTA_S if closed[2] else STAR_S)
        else:
            speed = towards(self.speed, top, COAST_S)
        heat = 1 / TRIP_S if powered and "jammed" in self.faults else -1 / COOL_S if self.heat > 0 else 0.0
        if self.heat >= 1 and heat > 0:
            heat = 0.0
        self._rates = (*rates, speed, heat)
        self.inputs = {"X2": int(not self.tripped)}
        times = [remaining(place, rate) for place, rate in zip((*places, self.heat), (*rates, heat), strict=True)]
        return min(*times, abs(top - self.speed) / abs(speed) if speed else inf)

    def _note(self, what):
        super()._note(what)
        self.blown = True
