"""The mixer: a vessel on load cells, four feeds, a stirrer and a drain, all driven by valves and motors that take their time.

Everything is in kilograms and seconds. The scale and the operator's touch screen speak to the PLC over a line: D0 is the
weight, D2 and M2 are what the screen says.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from operator import add
from typing import ClassVar, NamedTuple

from ..plant import Machine, Point, remaining

RATES = (8.0, 8.0, 5.0, 4.0)  # kg/s of water, main material, A and B through an open valve
DRAIN = 12.0  # kg/s
RUN_UP_S = 2.0  # of the stirrer, and as long to stand still
TURNS_S = 0.7  # of the stirrer at full speed
RUNNING = 0.9  # the part of the full speed from which its relay says so
FULL = 3000.0  # kg: the vessel runs over
BATCH, REST = 200.0, 20.0  # kg: so much is a batch, and so little of it an empty vessel
ENDS = (("X0", "X1"), ("X2", "X3"), ("X4", "X5"), ("X6", "X7"), ("X11", "X12"))  # switches of the valves: open, closed


class Incident(NamedTuple):
    """Something that must not happen to a machine, as a fact: when, in which batch, and what."""

    seconds: float
    batch: int
    what: str


class Batch(NamedTuple):
    """A batch as it left the vessel: kg of each that went in, and for how long all of it was stirred and the vessel washed before."""

    water: float
    main: float
    a: float
    b: float
    stirred_s: float
    washed_s: float


@dataclass
class Mixer(Machine):
    """The machine. `valve_s` is how long each valve travels from closed to open: water, main material, A, B, drain.

    Between two changes (a valve at its end, the stirrer at its speed) flows change at a constant rate, and are summed exactly.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("WaterOpn", "the water valve is open"),
        "X1": Point("WaterCls", "the water valve is closed"),
        "X2": Point("MainOpn", "the valve of the main material is open"),
        "X3": Point("MainCls", "the valve of the main material is closed"),
        "X4": Point("AOpn", "the valve of additive A is open"),
        "X5": Point("ACls", "the valve of additive A is closed"),
        "X6": Point("BOpn", "the valve of additive B is open"),
        "X7": Point("BCls", "the valve of additive B is closed"),
        "X10": Point("StirRuns", "the stirrer turns at its speed"),
        "X11": Point("DrainOpn", "the drain is open"),
        "X12": Point("DrainCls", "the drain is closed"),
        "Y0": Point("Water", "water for washing"),
        "Y1": Point("Main", "main material"),
        "Y2": Point("AddA", "additive A"),
        "Y3": Point("AddB", "additive B"),
        "Y4": Point("Drain", "lets the vessel run out"),
        "Y5": Point("Stirrer", "contactor of the stirrer"),
        "D0": Point("Weight", "what is in the vessel, in kg"),
        "D2": Point("Product", "chosen on the touch screen: 1 is A, 2 is B"),
        "M2": Point("Batch", "batch start on the touch screen"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2", "Y3", "Y4", "Y5")
    EXACT: ClassVar[tuple[str, ...]] = ("places", "speed")

    FAULTS: ClassVar[dict[str, str]] = {
        "water sticks": "the water valve does not move",
        "main sticks": "the valve of the main material does not move",
        "A sticks": "the valve of additive A does not move",
        "B sticks": "the valve of additive B does not move",
        "drain sticks": "the drain does not move",
        "stirrer trips": "the stirrer gets no power",
        "scale hangs": "the scale tells its last weight",
    }

    valve_s: tuple[float, ...] = (1.5, 1.5, 1.0, 1.0, 2.0)

    weight: float = field(default=0.0, init=False)
    places: tuple[float, ...] = field(default=(0.0,) * 5, init=False)  # of the valves: 0 closed, 1 open
    speed: float = field(default=0.0, init=False)  # of the stirrer, part of the full one
    turns: float = field(default=0.0, init=False)
    dosed: tuple[float, ...] = field(default=(0.0,) * 4, init=False)  # what went in since the vessel was empty
    stirred_s: float = field(default=0.0, init=False)  # how long the stirrer turned since the last of it went in
    washed_s: float = field(default=0.0, init=False)  # how long water ran through the vessel since the last batch
    batches: tuple[Batch, ...] = field(default=(), init=False)
    spilt: float = field(default=0.0, init=False)  # kg that ran over

    _rates: tuple[float, ...] = field(default=(0.0,) * 6, init=False, repr=False)  # of valves and stirrer, a second
    _holds_batch: bool = field(default=False, init=False, repr=False)
    _moves: bool = field(default=False, init=False, repr=False)  # whether a valve does
    _feeds: bool = field(default=False, init=False, repr=False)  # whether something comes in
    _flows: tuple[float, ...] = field(default=(0.0,) * 5, init=False, repr=False)  # kg/s of the feeds and the drain
    _bends: tuple[float, ...] = field(default=(0.0,) * 5, init=False, repr=False)  # and how they change, kg/s²
    _share: ClassVar[tuple] = (None, 0.0)  # what the last step with these flows brought

    def __post_init__(self):
        if len(self.valve_s) != 5 or min(self.valve_s) <= 0:
            raise ValueError(f"valve_s: five times above 0 s are needed, not {self.valve_s}")
        super().__post_init__()

    @property
    def finished(self) -> int:
        """How many batches have left."""
        return len(self.batches)

    @property
    def still(self) -> float:
        """For how many seconds nothing changes that a sensor tells: valves and weight stand, whatever runs through and turns."""
        flows = self._flows
        stands = not any(flows)
        if not stands:
            net = sum(flows[:4]) - flows[4]
            stands = (not self.weight and net <= 0) or (self.weight == FULL and net >= 0)
        return self._steady_s if stands and not self._moves else 0.0

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under the outputs Y0 to Y5; returns the switches X0 to X12 and the weight D0 in whole kg."""
        super().step(seconds, outputs)
        weight = int(self.weight + 1e-6)
        if weight != self.inputs["D0"] and "scale hangs" not in self.faults:
            self.inputs = {**self.inputs, "D0": weight}
        return self.inputs

    def _plan(self):
        places = self.places
        rates, steady = [], inf
        faults, travels = self.faults, (*self.valve_s, RUN_UP_S)
        for fault, place, driven, travel in zip(self.FAULTS, (*places, self.speed), self._outputs, travels, strict=False):
            if fault in faults:
                driven = 0 if fault == "stirrer trips" else place
            rate = 0.0 if place == driven else 1 / travel if driven else -1 / travel
            rates.append(rate)
            steady = min(steady, remaining(place, rate))
        self._rates, self._moves = tuple(rates), any(rates[:5])
        self._flows = tuple([rate * place for rate, place in zip((*RATES, DRAIN), places, strict=True)])
        self._bends = tuple([rate * change for rate, change in zip((*RATES, DRAIN), rates, strict=False)])
        self._feeds = any(self._flows[:4]) or any(self._bends[:4])
        switches = {}
        for (opened, closed), place, rate in zip(ENDS, places, rates, strict=False):
            switches[opened], switches[closed] = int(place == 1 and not rate), int(place == 0 and not rate)
        switches["X10"] = int(self.speed >= RUNNING)
        weight = self.inputs["D0"] if "scale hangs" in faults else int(self.weight + 1e-6)
        self.inputs = switches | {"D0": weight}
        return steady

    def _move(self, seconds):
        """Let everything go on as it goes."""
        if self._moves or any(self._flows):
            self._flow(seconds)
        if self.speed or self._rates[5]:
            self._stir(seconds)

    def _flow(self, seconds):
        flows = self._flows
        if self._share[0] is not flows or self._share[1] != seconds:
            self._share = self._shared(seconds)
        _, _, added, total, least = self._share
        if added:
            self.dosed = tuple(map(add, self.dosed, added))
            if added[1] or added[2] or added[3]:
                self.stirred_s = 0.0
            if added[0] and (flows[4] or self._bends[4]):
                self.washed_s += seconds
        weight = max(self.weight + total, least)  # it does not fall below 0
        if weight > FULL:
            if not self.spilt:
                self.incidents += (Incident(round(self.seconds, 3), self.finished + 1, "runs over"),)
            self.spilt += weight - FULL
            weight = FULL
        self.weight = weight or 0.0
        if self._moves:
            self.places = tuple([place + rate * seconds for place, rate in zip(self.places, self._rates, strict=False)])
            self._flows = tuple([flow + bend * seconds for flow, bend in zip(flows, self._bends, strict=True)])
        if weight > BATCH:
            self._holds_batch = True
        elif weight < REST:
            if self._holds_batch:
                self._finish()
            elif not weight:
                self.dosed = (0.0,) * 4

    def _shared(self, seconds):
        """What so many seconds bring with the flows as they are: these, the seconds, kg of each feed, in all, and at the least."""
        flows, bends = self._flows, self._bends
        half = seconds * seconds / 2
        added = [flow * seconds + bend * half for flow, bend in zip(flows, bends, strict=True)] if self._feeds else ()
        net, bend = sum(flows[:4]) - flows[4], sum(bends[:4]) - bends[4]
        total = net * seconds + bend * half
        turn = -net / bend if bend > 0 else 0.0  # where the weight is least, if it falls and rises again
        least = net * turn / 2 if 0 < turn < seconds else min(0.0, total)
        return flows, seconds, added, total, total - least

    def _stir(self, seconds):
        rate = self._rates[5]
        self.turns += (self.speed * seconds + rate * seconds * seconds / 2) / TURNS_S
        self.speed += rate * seconds
        self.stirred_s += seconds

    def _finish(self):
        """The batch has left the vessel."""
        self.batches += (Batch(*(round(amount, 3) for amount in (*self.dosed, self.stirred_s, self.washed_s))),)
        self.dosed, self.stirred_s, self.washed_s, self._holds_batch = (0.0,) * 4, 0.0, 0.0, False
