"""A pick-and-place arm: a carriage on a rail, a cylinder that goes down, and a gripper.

Parts come into a nest under the left end of the rail; the arm sets them on a place under the right end, from which they
are taken away. The carriage is 0 at the left and 1 at the right, the cylinder 0 above and 1 below, the gripper 0 open.
"""

from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import Machine, Point, remaining, towards

RAIL_S = 1.6  # of the carriage, from end to end
DOWN_S, UP_S = 0.6, 0.5  # of the cylinder
CLOSE_S, OPEN_S = 0.25, 0.15  # of the gripper
LOW = 0.05  # so far down the arm hits what stands beside it when the carriage travels
STRAIN_S = 0.5  # so long the carriage may drive against an end


@dataclass
class Arm(Machine):
    """The machine. `pauses` are how long the nest stays empty before each part, over and over; `clears_s` is how long a
    part lies on the place; `carriage` is where it stands at first.

    Between two changes everything moves at a constant rate.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Auto", "switch: automatic"),
        "X1": Point("PartIn", "a part lies in the nest"),
        "X2": Point("AtLeft", "the carriage is above the nest"),
        "X3": Point("AtRight", "the carriage is above the place"),
        "X4": Point("IsUp", "the cylinder is up"),
        "X5": Point("IsDown", "the cylinder is down"),
        "X6": Point("Gripped", "the gripper is closed on a part"),
        "X7": Point("Free", "nothing lies on the place"),
        "Y0": Point("GoRight", "the carriage travels to the right"),
        "Y1": Point("GoLeft", "the carriage travels to the left"),
        "Y2": Point("Down", "the cylinder goes down; a spring brings it up"),
        "Y3": Point("Grip", "the gripper closes; a spring opens it"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2", "Y3")
    EXACT: ClassVar[tuple[str, ...]] = ("carriage", "cylinder", "gripper", "_comes_s", "_away_s", "_strain_s")
    FAULTS: ClassVar[dict[str, str]] = {
        "slips": "the gripper closes and does not get hold of the part",
        "no air": "cylinder and gripper stay where they are",
        "carriage jams": "the carriage does not move",
        "place blocked": "nothing is taken away from the place",
    }

    pauses: tuple[float, ...] = (1.0,)
    clears_s: float = 2.0
    carriage: float = 0.0

    cylinder: float = field(default=0.0, init=False)
    gripper: float = field(default=0.0, init=False)
    nest: bool = field(default=False, init=False)  # a part is in it
    holds: bool = field(default=False, init=False)  # the gripper has one
    occupied: bool = field(default=False, init=False)  # one lies on the place
    came: int = field(default=0, init=False)  # parts
    placed: int = field(default=0, init=False)
    lost: int = field(default=0, init=False)

    _rates: tuple[float, float, float] = field(default=(0.0,) * 3, init=False, repr=False)  # carriage, cylinder, gripper, a second
    _closed: bool = field(default=False, init=False, repr=False)  # the gripper; what it did not catch in closing it does not catch later
    _comes_s: float = field(default=inf, init=False, repr=False)  # until the next part
    _away_s: float = field(default=inf, init=False, repr=False)  # until the place is cleared
    _strain_s: float = field(default=inf, init=False, repr=False)  # until driving against an end does harm

    def __post_init__(self):
        if not self.pauses or min(self.pauses) < 0 or self.clears_s < 0 or not 0 <= self.carriage <= 1:
            raise ValueError(f"pauses and clears_s from 0 s and a carriage between 0 and 1 are needed, not {self}")
        self._comes_s = self.pauses[0]
        super().__post_init__()

    def _move(self, seconds):
        """Let everything go on as it goes."""
        carriage, cylinder, gripper = self._rates
        self.carriage += carriage * seconds
        self.cylinder += cylinder * seconds
        self.gripper += gripper * seconds
        self._comes_s -= seconds
        self._away_s -= seconds
        self._strain_s -= seconds

    def _plan(self):
        right, left, down, grip = self._outputs
        way = bool(right) - bool(left)
        end = {1: 1.0, -1: 0.0}.get(way, self.carriage)
        rates = [
            0.0 if "carriage jams" in self.faults else towards(self.carriage, end, RAIL_S),
            towards(self.cylinder, int(bool(down)), DOWN_S if down else UP_S),
            towards(self.gripper, int(bool(grip)), CLOSE_S if grip else OPEN_S),
        ]
        if "no air" in self.faults:
            rates[1:] = 0.0, 0.0
        self._rates = tuple(rates)
        self._hand_over(rates)
        self._watch(rates, bool(way) and not rates[0], bool(right and left))
        self._look(rates)
        ends = [remaining(place, rate) for place, rate in zip((self.carriage, self.cylinder, self.gripper), rates, strict=True)]
        if rates[0] and rates[1] > 0 and self.cylinder < LOW:
            ends.append((LOW - self.cylinder) / rates[1])
        ends += [wait for wait in (self._comes_s, self._away_s, self._strain_s) if wait > 0]
        return min(ends)

    def _hand_over(self, rates):
        """Parts come, are gripped, lifted, set down, fall, and are taken away."""
        above = self._above()
        if self._comes_s <= 0:
            self.nest, self.came, self._comes_s = True, self.came + 1, inf
        if self._away_s <= 0:
            self.occupied, self._away_s = False, inf
        if self.occupied and (above != "place" or rates[1] < 0) and "place blocked" not in self.faults:
            self._away_s = min(self._away_s, self.clears_s)
        closed = self.gripper == 1 and not rates[2]
        if closed and not self._closed and above == "nest" and self.nest and "slips" not in self.faults:
            self.holds = True
        self._closed = closed
        if self.holds and self.nest and rates[1] < 0:
            self._lift_out()
        if self.holds and rates[2] < 0:
            self.holds = False
            if above == "place":
                self.placed, self.occupied = self.placed + 1, True
            elif not self.nest:
                self._lose("a part falls")

    def _watch(self, rates, strains, both):
        """What goes wrong and lasts is noted once."""
        self._strain_s = min(self._strain_s, STRAIN_S) if strains else inf
        low = self.cylinder > LOW or (self.cylinder == LOW and rates[1] > 0)
        amiss = {
            "the arm hits something on its way": rates[0] and low,
            "the carriage drives against its end": self._strain_s <= 0,
            "the carriage is driven both ways": both,
            "a part is set on another one": self.holds and self.occupied and self._above() == "place",
        }
        now = frozenset(what for what, holds in amiss.items() if holds)
        if self._strain_s <= 0:
            self._strain_s = -inf  # noted
        for what in sorted(now - self._amiss):
            if self.holds and what.startswith("the arm"):
                if self.nest:
                    self._lift_out()
                self.holds = False
                self._lose(what)
            else:
                self._note(what)
        self._amiss = now

    def _above(self):
        """What the lowered gripper is at: "nest", "place" or nothing."""
        return {0: "nest", 1: "place"}.get(self.carriage, "") if self.cylinder == 1 else ""

    def _lift_out(self):
        self.nest = False
        self._comes_s = self.pauses[self.came % len(self.pauses)]

    def _lose(self, what):
        self.lost += 1
        self._note(what)

    def _look(self, rates):
        """What the sensors say: an end switch lets go as soon as its part leaves."""
        carriage, cylinder, _ = rates
        self.inputs = {
            "X1": int(self.nest),
            "X2": int(self.carriage == 0 and not carriage),
            "X3": int(self.carriage == 1 and not carriage),
            "X4": int(self.cylinder == 0 and not cylinder),
            "X5": int(self.cylinder == 1 and not cylinder),
            "X6": int(self.holds),
            "X7": int(not self.occupied),
        }
