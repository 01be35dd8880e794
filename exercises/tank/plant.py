"""A water tank: two pumps fill it, consumers draw from it, three float switches tell where the water stands.

Everything is in litres and seconds.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import DIGITS, INSTANT, Machine, Point, remaining, towards

FULL = 500.0  # the tank runs over
BOTTOM, LOW, HIGH = 50.0, 150.0, 400.0  # where the float switches are
MARKS = (0.0, BOTTOM, LOW, HIGH, inf)
PUMP = 12.0  # l/s of one pump at its speed
RUN_UP_S = 1.0  # of a pump, and as long to stand still
LEAK = 18.0  # l/s
TURNS_S = 0.6  # of a pump's wheel at its speed, as it is drawn


@dataclass
class Tank(Machine):
    """The machine. `water` is what is in it at first; `demand` is what the consumers draw, (seconds, l/s) over and over.

    Between two changes (a pump at its speed, another demand, the tank full or
    empty) the flow changes at a constant rate, and is summed exactly.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Auto", "switch: automatic"),
        "X1": Point("Bottom", "float switch: the water stands at 50 l or above"),
        "X2": Point("Low", "float switch: 150 l or above"),
        "X3": Point("High", "float switch: 400 l or above"),
        "X4": Point("OkA", "overload relay of pump A, opens when it trips"),
        "X5": Point("OkB", "overload relay of pump B, opens when it trips"),
        "X6": Point("Reset", "push button: the alarm has been seen to"),
        "Y0": Point("PumpA", "pump A"),
        "Y1": Point("PumpB", "pump B"),
        "Y2": Point("Alarm", "alarm lamp"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1")
    EXACT: ClassVar[tuple[str, ...]] = ("water", "_phase_s", "speeds")
    FAULTS: ClassVar[dict[str, str]] = {
        "leak": "the tank has a hole",
        "A trips": "pump A has tripped its overload relay and gets no power",
        "B trips": "pump B has tripped its overload relay and gets no power",
        "A blocked": "pump A turns, but brings no water",
        "B blocked": "pump B turns, but brings no water",
        "float hangs": "the float of the switch High hangs below",
    }

    water: float = 200.0
    demand: tuple[tuple[float, float], ...] = ((40.0, 3.0), (30.0, 5.0))

    speeds: tuple[float, float] = field(default=(0.0, 0.0), init=False)  # of the pumps, 1 is the full one
    turns: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    pumped: float = field(default=0.0, init=False)  # litres, since the beginning
    spilt: float = field(default=0.0, init=False)  # litres that ran over
    short: float = field(default=0.0, init=False)  # litres that consumers did not get

    _rates: tuple[float, float] = field(default=(0.0, 0.0), init=False, repr=False)  # of the speeds, a second
    _phase: int = field(default=0, init=False, repr=False)  # of the demand
    _phase_s: float = field(default=0.0, init=False, repr=False)  # how much of it is left
    _flow: float = field(default=0.0, init=False, repr=False)  # l/s into the tank, what leaves taken off
    _bend: float = field(default=0.0, init=False, repr=False)  # and how it changes, l/s²
    _edge: str = field(default="", init=False, repr=False)  # "full" while it runs over, "dry" while there is nothing to draw
    _between: tuple[float, float] = field(default=(0.0, 0.0), init=False, repr=False)  # litres: so long the sensors say the same

    def __post_init__(self):
        if not 0 <= self.water <= FULL:
            raise ValueError(f"water: 0 to {FULL:g} l are needed, not {self.water}")
        if not self.demand or min(seconds for seconds, _ in self.demand) <= 0 or min(flow for _, flow in self.demand) < 0:
            raise ValueError(f"demand: (seconds above 0, l/s from 0) are needed, not {self.demand}")
        self._phase_s = self.demand[0][0]
        super().__post_init__()

    @property
    def drawn(self) -> float:
        """What the consumers ask for now, in l/s."""
        return self.demand[self._phase][1]

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under the pumps Y0 and Y1; returns the float switches X1 to X3 and the overload relays X4 and X5."""
        super().step(seconds, outputs)
        water = self.water + 1e-6
        if not self._between[0] <= water < self._between[1]:
            self._look(water)
        return self.inputs

    def _move(self, seconds):
        """Let everything go on as it goes."""
        self._phase_s -= seconds
        brought = self._flow * seconds
        if self._bend:
            brought += self._bend * seconds * seconds / 2
            self._flow += self._bend * seconds
        if self._edge == "full":
            self.spilt += brought
        elif self._edge == "dry":
            self.short -= brought
        else:
            self.water += brought
        if any(self.speeds) or any(self._rates):
            ways = [speed * seconds + rate * seconds * seconds / 2 for speed, rate in zip(self.speeds, self._rates, strict=True)]
            self.turns = tuple([turned + way / TURNS_S for turned, way in zip(self.turns, ways, strict=True)])
            self.pumped += PUMP * sum(way for way, pump in zip(ways, "AB", strict=True) if f"{pump} blocked" not in self.faults)
            self.speeds = tuple([speed + rate * seconds for speed, rate in zip(self.speeds, self._rates, strict=True)])

    def _plan(self):
        speeds = self.speeds
        if self._phase_s <= 0:
            self._phase = (self._phase + 1) % len(self.demand)
            self._phase_s = self.demand[self._phase][0]
        driven = [on and f"{pump} trips" not in self.faults for pump, on in zip("AB", self._outputs, strict=True)]
        rates = self._rates = tuple([towards(speed, int(bool(on)), RUN_UP_S) for speed, on in zip(speeds, driven, strict=True)])
        brings = [PUMP * (f"{pump} blocked" not in self.faults) for pump in "AB"]
        leak = LEAK * ("leak" in self.faults)
        self._flow = round(sum(rate * speed for rate, speed in zip(brings, speeds, strict=True)) - self.drawn - leak, DIGITS)
        self._bend = round(sum(rate * change for rate, change in zip(brings, rates, strict=True)), DIGITS)
        rising = self._flow > 0 or (self._flow == 0 and self._bend > 0)
        falling = self._flow < 0 or (self._flow == 0 and self._bend < 0)
        edge = "full" if self.water >= FULL and rising else "dry" if self.water <= 0 and falling else ""
        if edge and edge != self._edge:
            self._note("the tank runs over" if edge == "full" else "the tank is empty")
        self._edge = edge
        ends = [self._phase_s, *(remaining(speed, rate) for speed, rate in zip(speeds, rates, strict=True))]
        if self._flow * self._bend < 0:
            ends.append(-self._flow / self._bend)  # rising turns to falling, or the other way round
        if not edge and (rising or falling):
            ends.append(_until((FULL if rising else 0.0) - self.water, self._flow, self._bend))
        self._look(self.water + 1e-6)
        return max(min(ends), INSTANT)

    def _look(self, water):
        """What float switches and overload relays say."""
        self._between = max(mark for mark in MARKS if mark <= water), min(mark for mark in MARKS if mark > water)
        self.inputs = {
            "X1": int(water >= BOTTOM),
            "X2": int(water >= LOW),
            "X3": int(water >= HIGH and "float hangs" not in self.faults),
            "X4": int("A trips" not in self.faults),
            "X5": int("B trips" not in self.faults),
        }


def _until(way: float, flow: float, bend: float) -> float:
    """How many seconds it takes to bring `way` litres at `flow` l/s that changes by `bend` l/s²; for ever if it never does."""
    if not bend:
        return way / flow
    root = flow * flow + 2 * bend * way
    if root < 0:
        return inf
    seconds = 2 * way / (flow + root**0.5 * (1 if way >= 0 and flow >= 0 else -1)) if way else 0.0
    return seconds if seconds >= 0 else inf
