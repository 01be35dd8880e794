"""What all plants share: the names of their points, what a plant can do, its faults, and the moment a picture is drawn from."""

from collections.abc import Mapping
from typing import ClassVar, NamedTuple, Protocol

from ecsim import EcsimError


class Point(NamedTuple):
    """A terminal of the PLC as the machine knows it: the name in programs and on panels, and what it is."""

    name: str
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


def towards(place: float, end: float, seconds: float) -> float:
    """The rate a second at which something goes from its place to an end, when the whole way from 0 to 1 takes so many seconds."""
    return 0.0 if place == end else 1 / seconds if place < end else -1 / seconds


class Moment(NamedTuple):
    """What a machine's picture is drawn from: the plant, and the PLC's terminals (device -> 0 or 1)."""

    plant: Plant
    inputs: Mapping[str, int]
    outputs: Mapping[str, int]
