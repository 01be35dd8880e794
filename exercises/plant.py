"""What all plants share: the names of their points, what a plant can do, and the moment a picture is drawn from."""

from collections.abc import Mapping
from typing import NamedTuple, Protocol


class Point(NamedTuple):
    """A terminal of the PLC as the machine knows it: the name in programs and on panels, and what it is."""

    name: str
    what: str


class Plant(Protocol):
    """A machine: it is moved by outputs and answers with sensors; it knows no clock, no drawing and no program."""

    wiring: Mapping[str, Point]

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under these outputs (device -> 0 or 1) and return what the sensors then say."""


class Moment(NamedTuple):
    """What a machine's picture is drawn from: the plant, and the PLC's terminals (device -> 0 or 1)."""

    plant: Plant
    inputs: Mapping[str, int]
    outputs: Mapping[str, int]
