"""A table on a screw, driven by pulses and a direction, with limit switches and a near-point switch (manual 6.17.3), and its servo amplifier.

Lengths are millimetres along the screw. The origin is the place where the table leaves the near-point switch on its way
back; forward is away from it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import ClassVar

from ..plant import Machine, Point

BITS, CHECK_BITS = 32, 6
GRIP = 0.75  # the part of the way that a slipping coupling passes on


@dataclass
class Axis(Machine):
    """The table. `position` is where it stands; with `backlash` it follows the screw only when the nut has come to bear."""

    position: float = 120.0
    pulses_per_mm: float = 100.0
    backlash: float = 0.0
    front: float = 400.0  # the limit switches
    rear: float = -20.0
    dog: tuple[float, float] = (0.0, 15.0)  # where the near-point switch is ON
    stop: float = 10.0  # so far behind a limit switch the table runs against a stop
    missed: int = 0  # pulses that moved nothing because the table stood against a stop
    play: float = field(default=0.0, repr=False)  # how far the screw has turned within the backlash
    speed: float = 0.0  # of the motor in the last step, in mm/s without sign, to 0.1

    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y4")
    counted: ClassVar[frozenset[str]] = frozenset({"Y0"})  # outputs that are given as the number of their pulses
    FAULTS: ClassVar[dict[str, str]] = {
        "coupling slips": "the screw follows three quarters of the motor's way",
        "front wire": "the wire of the front limit switch is broken",
        "rear wire": "the wire of the rear limit switch is broken",
    }
    wiring: ClassVar[dict[str, Point]] = {
        "Y0": Point("Pulses", "pulse input of the drive"),
        "Y4": Point("Dir", "ON: forward"),
        "X3": Point("Near", "near-point switch"),
        "X6": Point("Front", "front limit switch, ON in the allowed range"),
        "X7": Point("Rear", "rear limit switch, ON in the allowed range"),
        "X0": Point("StopPB", "push button, OFF while it is pressed"),
        "X1": Point("Origin", "push button: return to the origin"),
        "X2": Point("To50", "push button: go to 50 mm"),
        "X4": Point("To200", "push button: go to 200 mm"),
        "Y5": Point("Known", "lamp: the position is known"),
        "Y6": Point("AtPlace", "lamp: it stands where it was sent"),
    }

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Move by the pulses that came in this time and return what the switches say; the operator's points are left out."""
        pulses = outputs.get("Y0", 0)
        self.seconds += seconds
        if seconds:
            self.speed = round(pulses / self.pulses_per_mm / seconds, 1)
        if pulses:
            self._turn(pulses if outputs.get("Y4") else -pulses)
            self._settle()
        return self.inputs

    @property
    def moving(self) -> bool:
        """Whether pulses came in the last step."""
        return self.speed > 0

    def stand_at(self, position: float) -> None:
        """Somebody turns the screw by hand until the table stands here."""
        self.position = position
        self._settle()

    def _turn(self, pulses: int) -> None:
        """The screw turns by so many pulses; the table follows behind the play of the nut."""
        wanted = pulses / self.pulses_per_mm * (GRIP if "coupling slips" in self.faults else 1)
        slack = self.backlash - self.play if wanted > 0 else self.play
        taken = min(abs(wanted), slack)
        self.play += taken if wanted > 0 else -taken
        travel = abs(wanted) - taken
        free = self.front + self.stop - self.position if wanted > 0 else self.position - self.rear + self.stop
        done = min(travel, free)
        self.position += done if wanted > 0 else -done
        self.missed += round((travel - done) * self.pulses_per_mm)
        self._report({"the table runs against its stop"} if done < travel else set())

    def _plan(self) -> float:
        """The switches; the table moves by pulses alone, so that nothing changes with time."""
        self.inputs = {
            "X3": int(self.dog[0] <= self.position <= self.dog[1]),
            "X6": int(self.position < self.front and "front wire" not in self.faults),
            "X7": int(self.position > self.rear and "rear wire" not in self.faults),
        }
        return inf


@dataclass
class ServoAmplifier:
    """An amplifier that tells the absolute position of its motor in pairs of bits, each asked for and answered (6.17.11)."""

    pulses: int = 0  # the absolute position
    silent: bool = False  # it does not answer
    garbled: bool = False  # its sum is wrong
    ready: bool = False
    sent: int = 0
    lines: tuple[int, int] = (0, 0)
    word: int = field(default=0, repr=False)

    wiring: ClassVar[dict[str, Point]] = {
        "Y10": Point("ServoOn", "servo on"),
        "Y11": Point("Transfer", "transfer of the absolute position"),
        "Y12": Point("Request", "the next pair of bits, please"),
        "X10": Point("Bit0", "lower bit"),
        "X11": Point("Bit1", "higher bit"),
        "X12": Point("Ready", "ready to be asked"),
    }

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Answer to the lines of the controller."""
        if self.silent or not (outputs.get("Y10") and outputs.get("Y11")):
            self.ready, self.sent, self.lines = False, 0, (0, 0)
        elif not self.ready and not self.sent:
            self.ready, self.word = True, self._message()
        elif self.ready and outputs.get("Y12"):
            pair = self.word >> 2 * self.sent & 3
            self.ready, self.lines, self.sent = False, (pair & 1, pair >> 1), self.sent + 1
        elif not self.ready and not outputs.get("Y12"):
            self.ready = True
        return {"X10": self.lines[0], "X11": self.lines[1], "X12": int(self.ready)}

    def _message(self) -> int:
        """The position and behind it the sum of its pairs of bits."""
        data = self.pulses % (1 << BITS)
        total = sum(data >> place & 3 for place in range(0, BITS, 2)) + self.garbled
        return data | total % (1 << CHECK_BITS) << BITS

    def state(self) -> tuple:
        """What `restore` takes to come back to this moment."""
        return self.pulses, self.silent, self.garbled, self.ready, self.sent, self.lines, self.word

    def restore(self, state: tuple) -> None:
        """Come back to a moment."""
        self.pulses, self.silent, self.garbled, self.ready, self.sent, self.lines, self.word = state
