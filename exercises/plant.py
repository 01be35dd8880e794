"""What all plants share: the names of their points, stepping from change to change, faults, and the moment a picture is drawn from."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from math import inf
from operator import attrgetter, itemgetter
from typing import Any, ClassVar, NamedTuple, Protocol

from ecsim import EcsimError

INSTANT = 1e-9  # s: what lies nearer together is one moment
DIGITS = 9  # of what is compared with a mark


class Point(NamedTuple):
    """A terminal of the PLC as the machine knows it: the name in programs and on panels, and what it is."""

    name: str
    what: str


class Incident(NamedTuple):
    """Something that must not happen to a machine, as a fact: when, and what."""

    seconds: float
    what: str


class Plant(Protocol):
    """A machine: it is moved by outputs and answers with sensors; it knows no clock, no drawing and no program."""

    wiring: Mapping[str, Point]

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under these outputs (device -> 0 or 1) and return what the sensors then say."""


class Faulty:
    """A machine with faults that can be switched in. Sensors that stick or bounce are the wiring's affair and not among them."""

    FAULTS: ClassVar[Mapping[str, str]] = {}  # name -> what is then wrong, in words
    faults: frozenset[str] = frozenset()  # those that are switched in

    def fail(self, fault: str, on: bool = True) -> None:
        """Switch a fault in, or out again; raises EcsimError for one that the machine does not have."""
        if fault not in self.FAULTS:
            raise EcsimError(f"this machine has no fault {fault!r}; it has {', '.join(self.FAULTS) or 'none'}")
        self.faults = self.faults | {fault} if on else self.faults - {fault}
        self._settle()

    def _settle(self) -> None:
        """Take note of a change."""


@dataclass
class Machine(Faulty):
    """A machine that goes from change to change exactly: a step of any length gives the same run.

    A machine says in `_plan` how it goes on from here and for how many seconds nothing changes then, and in `_move` what that does.
    Its fields hold values that a step replaces and never alters; so does what a step returns.
    """

    wiring: ClassVar[Mapping[str, Point]] = {}
    DRIVES: ClassVar[tuple[str, ...]] = ()  # the outputs that move it, two or more, in the order of `_outputs`
    EXACT: ClassVar[tuple[str, ...]] = ()  # fields (numbers, tuples of numbers) that are compared with marks: rounded at each change

    faults: frozenset[str] = field(default=frozenset(), init=False)
    seconds: float = field(default=0.0, init=False)
    incidents: tuple[Incident, ...] = field(default=(), init=False)
    inputs: dict[str, int] = field(default_factory=dict, init=False)  # what the sensors say now

    _outputs: tuple[int, ...] = field(default=(), init=False, repr=False)
    _amiss: frozenset = field(default=frozenset(), init=False, repr=False)  # the incidents that last
    _steady_s: float = field(default=0.0, init=False, repr=False)  # nothing changes for so long

    def __init_subclass__(cls, **more: Any):
        super().__init_subclass__(**more)
        cls._driven = itemgetter(*cls.DRIVES)

    def __post_init__(self):
        self._outputs = (0,) * len(self.DRIVES)
        self._settle()

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under these outputs (device -> 0 or 1) and return what the sensors say; the operator's points are left out."""
        now = self._driven(outputs)
        if now != self._outputs:
            self._outputs = now
            self._settle()
        while seconds > self._steady_s - INSTANT:
            steady = self._steady_s
            self.seconds += steady
            self._move(steady)
            seconds = max(0.0, seconds - steady)
            self._settle()
        if seconds:
            self.seconds += seconds
            self._move(seconds)
            self._steady_s -= seconds
        return self.inputs

    def state(self) -> tuple:
        """Everything the machine is, as a value; `restore` takes it back."""
        return _whole(type(self))(self)

    def restore(self, state: tuple) -> None:
        """Make the machine what it was when `state` was taken."""
        for name, value in zip(_names(type(self)), state, strict=True):
            setattr(self, name, value)

    def _settle(self) -> None:
        """Something has changed: what stands at a mark is brought onto it, and the machine says how it goes on."""
        for name in self.EXACT:
            value = getattr(self, name)
            setattr(self, name, tuple([round(one, DIGITS) for one in value]) if isinstance(value, tuple) else round(value, DIGITS))
        self._steady_s = self._plan()

    def _plan(self) -> float:
        """Take note of what has just changed (rates, `inputs`, what is amiss); returns for how many seconds nothing changes now."""
        return inf

    def _move(self, seconds: float) -> None:
        """Let everything go on as it goes."""

    def _report(self, amiss: set) -> None:
        """Tell all that is amiss now; what lasts is noted once."""
        for what in sorted(amiss - self._amiss):
            self._note(what)
        self._amiss = frozenset(amiss)

    def _note(self, what: str) -> None:
        self.incidents += (Incident(round(self.seconds, 3), what),)


@cache
def _names(machine: type[Machine]) -> tuple[str, ...]:
    return tuple(part.name for part in fields(machine))


@cache
def _whole(machine: type[Machine]) -> Callable[[Machine], tuple]:
    return attrgetter(*_names(machine))


def towards(place: float, end: float, seconds: float) -> float:
    """The rate a second at which something goes from its place to an end, when the whole way from 0 to 1 takes so many seconds."""
    return 0.0 if place == end else 1 / seconds if place < end else -1 / seconds


def remaining(place: float, rate: float) -> float:
    """How many seconds something at a place from 0 to 1 still needs to the end that it goes to; for ever when it stands."""
    return (1 - place if rate > 0 else place) / abs(rate) if rate else inf


class Moment(NamedTuple):
    """What a machine's picture is drawn from: the plant, and the PLC's terminals (device -> 0 or 1)."""

    plant: Plant
    inputs: Mapping[str, int]
    outputs: Mapping[str, int]
