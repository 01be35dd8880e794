"""The pallet-lift conveyor of manual section 7.5.1 as a machine.

Pallets come on the left belt and wait at a gate. When it goes down, the strands of the left lift pull a pallet in
against a stop. Both lifts raise their beds of rollers through the strands; the rollers carry the pallet from the
left bed over the stop to the right one; going down, the beds leave it on the strands of the right belt, which
carry it past the last switch and away. Valves are single-acting: without current the gate stands up and the lifts
are down. The strands beyond the gate run at twice the left belt's speed (one motor, geared), which opens the gap
behind a pallet that the gate needs to close.

Lengths are metres along the line, a pallet's place is the place of its front.
"""

from bisect import bisect_right
from dataclasses import dataclass, field
from math import inf
from typing import ClassVar, NamedTuple

from ..plant import DIGITS, Machine, Point, remaining

PALLET = 1.2  # its length
BEARING = 0.01  # it bears on what is under it so far in from its ends

# Places along the line.
ARRIVAL = 0.55  # a pallet whose rear is here has come in; the next one may be on its way
AT_ENTRY = 2.64  # X0
GATE = 3.0
LEFT_BED = 3.12  # the left belt hands over to the strands in the left lift
IN_LIFT = 4.40  # X1, on the left bed
LOW_STOP = 4.42  # holds a pallet on the strands; one on the raised bed rolls over it
MIDDLE = 4.57  # between the beds
ACROSS = 5.90  # X3, on the right bed
HIGH_STOP = 5.92  # holds a pallet on the raised right bed; below it the way is free
RIGHT_BED_END = 6.02
LEAVING = 6.75  # X4
DEPARTURE = 8.5  # a pallet whose rear is here has left the machine

# Speeds and travel times.
SLOW = 0.3  # m/s, the left belt
FAST = 0.6  # m/s, strands, rollers and right belt
GATE_S = 0.5
LIFT_S = 1.2
SLOWED = 4  # so many times as long travels a lift whose valve is throttled

# Where a pallet's front must come for something to change: its speed, what carries it, or a switch.
MARKS = tuple(
    sorted(
        round(place, DIGITS)
        for place in (
            *(switch + shift for switch in (AT_ENTRY, IN_LIFT, ACROSS, LEAVING) for shift in (0, PALLET)),
            *(bound + shift for bound in (LEFT_BED, MIDDLE, RIGHT_BED_END) for shift in (BEARING, PALLET / 2, PALLET - BEARING)),
            *(ARRIVAL + PALLET, GATE, GATE + PALLET, LEFT_BED, LOW_STOP, HIGH_STOP, DEPARTURE + PALLET),
        )
    )
)
START = 1e-6  # what turns a valve moves at once: this part of its travel


class Incident(NamedTuple):
    """Something that must not happen to a machine, as a fact: when, to which pallet, and what."""

    seconds: float
    pallet: int
    what: str


def stroke(place, valve, seconds, jams):
    """How a cylinder at `place` of its travel goes on: its place, and its rate a second towards the end its valve says."""
    if jams:
        return place, 0.0
    if valve:
        return (max(place, START), 1 / seconds) if place < 1 else (1.0, 0.0)
    return (min(place, 1 - START), -1 / seconds) if place > 0 else (0.0, 0.0)


@dataclass
class Conveyor(Machine):
    """The machine, with pallets arriving at the given distances (rear to front, in metres), over and over.

    Between two changes (a stop reached, a switch passed, a valve turned) everything moves at a constant speed.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("AtEntry", "a pallet waits at the entrance"),
        "X1": Point("InLift", "a pallet is fully on the left lift"),
        "X2": Point("Up", "both lifts are up (two switches in series)"),
        "X3": Point("Across", "a pallet is fully on the right lift"),
        "X4": Point("Leaving", "a pallet is leaving on the right belt"),
        "X5": Point("Start", "start switch"),
        "X6": Point("Emerg", "emergency switch, ON when pressed"),
        "Y0": Point("Gate", "entry gate goes down"),
        "Y1": Point("LiftL", "left lift goes up"),
        "Y2": Point("LiftR", "right lift goes up"),
        "Y3": Point("Rollers", "transfer rollers of both lifts"),
        "Y4": Point("BeltL", "left belt and the strands in the left lift"),
        "Y5": Point("BeltR", "right belt and the strands in the right lift"),
    }
    FAULTS: ClassVar[dict[str, str]] = {
        "no pallets": "no more pallets come",
        "pallet sticks": "the pallet ahead stays where it is, whatever turns under it",
        "gate jams": "the gate stays where it is",
        "left lift stops": "the left lift stays where it is",
        "right lift stops": "the right lift stays where it is",
        "right lift slow": "the valve of the right lift is throttled: it takes four times as long",
        "no rollers": "the rollers have no drive",
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2", "Y3", "Y4", "Y5")
    EXACT: ClassVar[tuple[str, ...]] = ("gate", "left", "right", "fronts")

    distances: tuple[float, ...] = (0.5, 3.0, 0.4, 4.2, 2.6)
    first: float = 1.8  # where the first pallet stands

    gate: float = field(default=0.0, init=False)  # 0 up and shut, 1 down and open
    left: float = field(default=0.0, init=False)  # lifts: 0 down, 1 up
    right: float = field(default=0.0, init=False)
    fronts: tuple[float, ...] = field(default=(), init=False)  # the pallets' places, the one ahead first
    delivered: int = field(default=0, init=False)  # how many have left: the pallet ahead is number delivered + 1
    belt_left_m: float = field(default=0.0, init=False)  # how far each drive has run
    belt_right_m: float = field(default=0.0, init=False)
    rollers_m: float = field(default=0.0, init=False)

    _rates: tuple[float, ...] = field(default=(0.0,) * 6, init=False, repr=False)  # of gate, lifts and drives, a second
    _speeds: tuple[float, ...] = field(default=(), init=False, repr=False)  # of the pallets

    def __post_init__(self):
        if not self.distances or min(self.distances) < 0:
            raise ValueError(f"distances: one or more lengths of 0 m or more are needed, not {self.distances}")
        if not self.first <= GATE:
            raise ValueError(f"first: the first pallet stands before the gate, at {GATE} m at most, not {self.first}")
        self.fronts = (round(self.first, DIGITS),)
        super().__post_init__()

    def pose(self, front: float) -> tuple[float, float]:
        """How high a pallet with its front here is carried at its rear and at its front, as parts of the lifts' travel."""
        return self._height(front - PALLET + BEARING), self._height(front - BEARING)

    def _height(self, place):
        """How high what carries a pallet stands here."""
        place = round(place, DIGITS)
        if place < LEFT_BED or place >= RIGHT_BED_END:
            return 0.0
        return self.left if place < MIDDLE else self.right

    def _move(self, seconds):
        """Let everything go on as it goes."""
        gate, left, right, belt_left, belt_right, rollers = self._rates
        self.gate += gate * seconds
        self.left += left * seconds
        self.right += right * seconds
        self.belt_left_m += belt_left * seconds
        self.belt_right_m += belt_right * seconds
        self.rollers_m += rollers * seconds
        self.fronts = tuple([front + speed * seconds for front, speed in zip(self.fronts, self._speeds, strict=True)])

    def _plan(self):
        self._pass_on()
        amiss = set()
        gate_valve, left_valve, right_valve, rollers, belt_left, belt_right = self._outputs
        if not gate_valve and self.gate == 1:
            gate_valve = self._over_gate(amiss)
        faults = self.faults
        self.gate, gate_rate = stroke(self.gate, gate_valve, GATE_S, "gate jams" in faults)
        self.left, left_rate = stroke(self.left, left_valve, LIFT_S, "left lift stops" in faults)
        right_s = LIFT_S * (SLOWED if "right lift slow" in faults else 1)
        self.right, right_rate = stroke(self.right, right_valve, right_s, "right lift stops" in faults)
        pallets = self._drive_pallets(amiss)
        self._rates = (
            gate_rate,
            left_rate,
            right_rate,
            SLOW if belt_left else 0.0,
            FAST if belt_right else 0.0,
            FAST if rollers and "no rollers" not in faults else 0.0,
        )
        self._speeds = tuple(speed for speed, _ in pallets)
        self._report(amiss)
        self.inputs = self._switches()
        times = [remaining(place, rate) for place, rate in zip((self.gate, self.left, self.right), self._rates[:3], strict=True)]
        return min(*times, *(seconds for _, seconds in pallets))

    def _note(self, what):
        self.incidents += (Incident(round(self.seconds, 6), *what),)

    def _pass_on(self):
        """Let the pallet that is through go, and let the next one come when there is room behind the last."""
        if len(self.fronts) > 1 and self.fronts[0] - PALLET >= DEPARTURE:
            self.fronts = self.fronts[1:]
            self.delivered += 1
        rear = self.fronts[-1] - PALLET
        if rear >= ARRIVAL and "no pallets" not in self.faults:
            number = self.delivered + len(self.fronts)  # of the last one; pallets count from 1
            distance = self.distances[(number - 1) % len(self.distances)]
            self.fronts += (round(rear - distance, DIGITS),)

    def _over_gate(self, amiss):
        """Whether a pallet stands over the gate, which then cannot rise."""
        for number, front in enumerate(self.fronts, self.delivered + 1):
            if round(front - PALLET, DIGITS) < GATE < front:
                amiss.add((number, "has the gate close under it"))
                return True
        return False

    def _drive_pallets(self, amiss):
        """For each pallet its speed and how long it keeps it."""
        moves = []
        ahead, ahead_speed = inf, 0.0  # where the pallet ahead ends, and its speed
        for number, front in enumerate(self.fronts, self.delivered + 1):
            speed = self._carried(number, front, amiss)
            keeps = inf
            if speed and front >= ahead:
                if front > GATE and speed > ahead_speed:
                    amiss.add((number, f"runs into pallet {number - 1}"))
                speed = min(speed, ahead_speed)
            elif speed > ahead_speed:
                keeps = (ahead - front) / (speed - ahead_speed)
            if speed:
                keeps = min(keeps, (MARKS[bisect_right(MARKS, front)] - front) / speed if front < MARKS[-1] else inf)
            moves.append((speed, keeps))
            ahead, ahead_speed = round(front - PALLET, DIGITS), speed
        return moves

    def _carried(self, number, front, amiss):
        """The speed that what lies under a pallet gives it, 0 where a stop holds it or it does not lie level."""
        rear_height, front_height = self.pose(front)
        if rear_height != front_height:
            amiss.add((number, "tips"))
            return 0.0
        if number == self.delivered + 1 and "pallet sticks" in self.faults:
            return 0.0
        _, _, _, rollers, belt_left, belt_right = self._outputs
        rollers = rollers and "no rollers" not in self.faults
        centre = round(front - PALLET / 2, DIGITS)
        if centre < LEFT_BED:
            speed = SLOW if belt_left else 0.0
        elif centre < MIDDLE:
            speed = FAST if (rollers if self.left else belt_left) else 0.0
        elif centre < RIGHT_BED_END:
            speed = FAST if (rollers if self.right else belt_right) else 0.0
        else:
            speed = FAST if belt_right else 0.0
        if front == GATE and self.gate < 1:
            return 0.0
        if front == LEFT_BED and self.left:
            if speed:
                amiss.add((number, "runs against the raised left lift"))
            return 0.0
        if (front == LOW_STOP and self.left < 1) or (front == HIGH_STOP and self.right):
            return 0.0
        return speed

    def _switches(self):
        """What the limit switches say."""

        def pressed(place):
            return int(any(round(front - PALLET, DIGITS) < place <= front for front in self.fronts))

        return {
            "X0": pressed(AT_ENTRY),
            "X1": pressed(IN_LIFT),
            "X2": int(self.left == 1 and self.right == 1),
            "X3": pressed(ACROSS),
            "X4": pressed(LEAVING),
        }
