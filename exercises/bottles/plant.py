"""The bottle machine: a turntable carries bottles past a capper, a labeller and a reject cylinder, one place after the other.

The table has eight places. Bottles come from a belt on the left, stand at the capper two places on, at the labeller three,
at the reject cylinder four, and leave on a belt six places on. Lengths are parts: of a place for the table, of the travel
for a cylinder. A cylinder goes out while its valve has current and returns by a spring without.
"""

from dataclasses import dataclass, field
from math import inf
from random import Random
from typing import ClassVar, NamedTuple

from ..plant import DIGITS, Machine, Point

CAPPING, LABELLING, REJECTING, EXIT = 2, 3, 4, 6  # places behind the entry
LINE = 10  # places that are followed: those of the table, and behind the exit those on its belt
FLAG = (-0.04, 0.06)  # the proximity switch sees a place's flag from here to there, 0 is the middle of the station
ALIGNED = 0.1  # so far from the middle the eyes see a bottle, and cylinders meet their place
REACH = 0.1  # of a cylinder's travel: from here on it is in the table's way
PRESSED = 0.9  # and from here on the cap or the label is on
TABLE_MARKS = (-ALIGNED, FLAG[0], FLAG[1], ALIGNED, 0.5)  # where something changes as the table turns

KINDS = ("good", "bad cap", "bad label", "gap")  # what the belt brings, by what will become of it; a gap is no bottle
SHARES = (0.7, 0.8, 0.9)  # of the stream: 70 % good, 10 % of each other kind


class Bottle(NamedTuple):
    """A bottle: what will become of it, and what has: `cap` and `label` are "" before, then "good" or "bad"."""

    number: int
    kind: str
    cap: str = ""
    label: str = ""

    @property
    def sound(self) -> bool:
        """Whether it may be sold."""
        return self.cap == self.label == "good"


@dataclass
class BottleMachine(Machine):
    """The machine. The belt brings the kinds in `first`, then a random stream of `seed`; a gap counts as one.

    `table_s` is how long the table takes from one station to the next, `stroke_s` how long capper, labeller and reject
    cylinder travel out, and as long back.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Station", "the table stands at a station"),
        "X1": Point("Bottle", "a bottle is at the capper"),
        "X2": Point("CapOK", "the cap of the bottle at the capper is straight"),
        "X3": Point("LabelOK", "the label of the bottle at the labeller is right"),
        "X5": Point("RejOut", "the reject cylinder is out"),
        "X6": Point("LabOut", "the labeller is out"),
        "X7": Point("CapOut", "the capper is out"),
        "X10": Point("CapHome", "the capper has returned"),
        "X11": Point("LabHome", "the labeller has returned"),
        "X12": Point("RejHome", "the reject cylinder has returned"),
        "Y0": Point("Table", "the turntable turns"),
        "Y1": Point("Capper", "the capper goes out"),
        "Y2": Point("Labeller", "the labeller goes out"),
        "Y3": Point("Reject", "the reject cylinder goes out"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2", "Y3")
    EXACT: ClassVar[tuple[str, ...]] = ("table", "strokes")

    FAULTS: ClassVar[dict[str, str]] = {
        "table jams": "the table does not turn",
        "capper jams": "the capper stays where it is",
        "labeller jams": "the labeller stays where it is",
        "reject jams": "the reject cylinder stays where it is",
        "no caps": "there are no caps in the capper",
        "no labels": "there are no labels in the labeller",
    }

    first: tuple[str, ...] = ("good", "good", "bad cap", "gap", "good", "bad label")
    seed: int = 1
    table_s: float = 1.0
    stroke_s: tuple[float, ...] = (0.6, 0.5, 0.4)

    turned: int = field(default=0, init=False)  # stations that the table has passed
    table: float = field(default=0.0, init=False)  # how far it is past the middle of a station, -0.5 to 0.5 of a place
    strokes: tuple[float, ...] = field(default=(0.0,) * 3, init=False)  # of capper, labeller, reject cylinder: 0 home, 1 out
    line: tuple[Bottle | None, ...] = field(default=(), init=False)  # what stands at each place behind the entry
    passed: int = field(default=0, init=False)  # bottles that have left by the exit
    rejected: int = field(default=0, init=False)
    uncapped: int = field(default=0, init=False)  # bottles that left the capper without its stroke
    unlabelled: int = field(default=0, init=False)  # bottles with a straight cap that left the labeller without its stroke
    escaped: int = field(default=0, init=False)  # faulty bottles that got past the reject cylinder
    lost: int = field(default=0, init=False)  # sound bottles that were rejected
    straight: bool = field(default=False, init=False)  # a bottle with a straight cap stands at the labeller
    sound: bool = field(default=False, init=False)  # a sound bottle stands at the reject cylinder
    faulty: bool = field(default=False, init=False)  # a faulty one does

    _rates: tuple[float, ...] = field(default=(0.0,) * 4, init=False, repr=False)  # of the table and the cylinders, a second
    _ready: tuple[bool, ...] = field(default=(True,) * 3, init=False, repr=False)  # cylinders that have not done their work in this stroke

    def __post_init__(self):
        unknown = [kind for kind in self.first if kind not in KINDS]
        if unknown:
            raise ValueError(f"first: {unknown[0]!r} is no kind of bottle; there are {', '.join(KINDS)}")
        if len(self.stroke_s) != 3 or min(*self.stroke_s, self.table_s) <= 0:
            raise ValueError(f"table_s, stroke_s: one time and three above 0 s are needed, not {self.table_s} and {self.stroke_s}")
        self.line = (self._arrival(1), *(None,) * (LINE - 1))
        super().__post_init__()

    @property
    def at_flag(self) -> bool:
        """Whether the proximity switch sees a place's flag."""
        return FLAG[0] <= self.table < FLAG[1]

    def kind(self, number: int) -> str:
        """What the belt brings as number 1, 2, 3 ..."""
        if number <= len(self.first):
            return self.first[number - 1]
        drawn = Random(f"{self.seed} {number}").random()
        return KINDS[sum(drawn >= share for share in SHARES)]

    def _arrival(self, number):
        kind = self.kind(number)
        return None if kind == "gap" else Bottle(number, kind)

    def _move(self, seconds):
        """Let everything go on as it goes."""
        table, *rates = self._rates
        if table:
            self.table += table * seconds
        if any(rates):
            self.strokes = tuple([place + rate * seconds for place, rate in zip(self.strokes, rates, strict=True)])

    def _plan(self):
        if self.table >= 0.5:
            self._pass_on()
        self._work()
        driven, *valves = self._outputs
        faults, amiss = self.faults, set()
        aligned = -ALIGNED <= self.table < ALIGNED
        rates, times = [], [inf]
        for name, place, valve, travel in zip(NAMES, self.strokes, valves, self.stroke_s, strict=True):
            goal = 1.0 if valve else 0.0
            if JAMS[name] in faults or place == goal:
                rate = 0.0
            elif valve and place >= REACH and not aligned:
                amiss.add(f"{name} hits table")
                rate = 0.0
            else:
                rate = (1 if valve else -1) / travel
                times.append(travel * min(abs(mark - place) for mark in (0.0, REACH, PRESSED, 1.0) if (mark - place) * rate > 0))
            rates.append(rate)
        turns = 1 / self.table_s if driven and "table jams" not in faults else 0.0
        for name, place in zip(NAMES, self.strokes, strict=True):
            if turns and place >= REACH:
                amiss.add(f"table hits {name}")
        if any(place >= REACH for place in self.strokes):
            turns = 0.0
        if turns:
            times.append(self.table_s * min(mark - self.table for mark in TABLE_MARKS if mark > self.table))
        self._rates = turns, *rates
        self._report(amiss)
        self._look(aligned)
        return min(times)

    def _pass_on(self):
        """The table is halfway to the next station: every place is another one's now."""
        capped, labelled, judged = self.line[CAPPING], self.line[LABELLING], self.line[REJECTING]
        self.uncapped += capped is not None and not capped.cap and "no caps" not in self.faults
        self.unlabelled += labelled is not None and labelled.cap == "good" and not labelled.label and "no labels" not in self.faults
        self.escaped += judged is not None and not judged.sound
        self.passed += self.line[EXIT - 1] is not None
        self.turned += 1
        self.table = round(self.table - 1, DIGITS)
        self.line = (self._arrival(self.turned + 1), *self.line[:-1])

    def _work(self):
        """What cylinders do to the bottles that stand before them, once in each stroke."""
        for number, (place, ready) in enumerate(zip(self.strokes, self._ready, strict=True)):
            due = place >= (1.0 if number == REJECTING - CAPPING else PRESSED)
            if due and ready:
                self._treat(CAPPING + number)
            if due == ready:
                self._ready = (*self._ready[:number], not due, *self._ready[number + 1 :])

    def _treat(self, place):
        bottle = self.line[place]
        if bottle is None:
            return
        if place == REJECTING:
            self.rejected += 1
            self.lost += bottle.sound
            bottle = None
        elif place == CAPPING and "no caps" not in self.faults:
            bottle = bottle._replace(cap="bad" if bottle.cap or bottle.kind == "bad cap" else "good")
        elif place == LABELLING and "no labels" not in self.faults:
            bottle = bottle._replace(label="bad" if bottle.label or bottle.kind == "bad label" else "good")
        self.line = (*self.line[:place], bottle, *self.line[place + 1 :])

    def _look(self, aligned):
        """What the switches say, and what stands where."""
        capping, labelling, judged = self.line[CAPPING], self.line[LABELLING], self.line[REJECTING]
        self.straight = labelling is not None and labelling.cap == "good"
        self.sound = judged is not None and judged.sound
        self.faulty = judged is not None and not judged.sound
        capper, labeller, reject = zip(self.strokes, self._rates[1:], strict=True)
        self.inputs = {
            "X0": int(self.at_flag),
            "X1": int(aligned and capping is not None),
            "X2": int(aligned and capping is not None and capping.cap == "good"),
            "X3": int(aligned and labelling is not None and labelling.label == "good"),
            "X5": int(reject == OUT),
            "X6": int(labeller == OUT),
            "X7": int(capper == OUT),
            "X10": int(capper == HOME),
            "X11": int(labeller == HOME),
            "X12": int(reject == HOME),
        }


OUT, HOME = (1.0, 0.0), (0.0, 0.0)  # place and rate of a cylinder that rests at an end
NAMES = ("capper", "labeller", "reject cylinder")
JAMS = dict(zip(NAMES, ("capper jams", "labeller jams", "reject jams"), strict=True))
