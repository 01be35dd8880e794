"""A baking oven: a heater behind a relay and a contactor, a chamber that loses heat, and a sensor that comes after it.

Temperatures are degrees Celsius, heat flows watts. The transmitter of the sensor speaks to the PLC over a line: D0 is what it
says, in tenths of a degree; D2 is the goal that is set on the touch screen.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from math import exp, inf, sqrt
from typing import ClassVar

from ..plant import Machine, Point

POWER = 3000.0  # W
ELEMENT, CHAMBER = 360.0, 3000.0  # J/K: what they store
TO_CHAMBER = 30.0  # W/K from the element
CLOSED, OPEN = 10.0, 40.0  # W/K to the room, by the door
SENSOR_S = 6.0  # so far the sensor is behind
BURNT = 265.0  # the chamber must not come here
BROKEN = 32767  # what the transmitter says of a broken sensor


@lru_cache(maxsize=256)
def decay(loss: float, seconds: float) -> tuple[float, ...]:
    """What is left after a time of the distances to the steady temperatures: the exponential of the heat balance's matrix.

    Element from element and chamber; chamber from element and chamber; sensor from element, chamber and sensor.
    """
    give, take, out = TO_CHAMBER / ELEMENT, TO_CHAMBER / CHAMBER, loss / CHAMBER
    total, root = give + take + out, sqrt((give - take - out) ** 2 + 4 * give * take)
    parts = []
    for rate, other in (((root - total) / 2, (-root - total) / 2), ((-root - total) / 2, (root - total) / 2)):
        left, share = exp(rate * seconds), 1 / (rate - other)
        follows = (left - exp(-seconds / SENSOR_S)) / (1 + rate * SENSOR_S)
        wall = take * share, (-take - out - other) * share
        parts.append(
            ((-give - other) * share * left, give * share * left, wall[0] * left, wall[1] * left, wall[0] * follows, wall[1] * follows)
        )
    slow, fast = parts
    return (*(one + two for one, two in zip(slow, fast, strict=True)), exp(-seconds / SENSOR_S))


@dataclass
class Oven(Machine):
    """The oven. `room` is the temperature outside, and inside at first unless `warm` is given.

    Between two changes of what drives it, its temperatures are sums of exponentials; they are exact for a step of any length.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("On", "switch: heat"),
        "X1": Point("Door", "the door is closed"),
        "X2": Point("Reset", "push button: the alarm has been seen to"),
        "D0": Point("Temp", "temperature in tenths of a degree; 32767 when the sensor is broken"),
        "D2": Point("Goal", "goal in tenths of a degree, on the touch screen"),
        "Y0": Point("Heater", "relay of the heater"),
        "Y1": Point("Main", "contactor before the relay"),
        "Y2": Point("Ready", "lamp: it has its temperature"),
        "Y3": Point("Alarm", "alarm lamp"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1")
    FAULTS: ClassVar[dict[str, str]] = {
        "door open": "the door stands open",
        "relay welded": "the relay of the heater stays closed",
        "element broken": "the heater takes no current",
        "sensor broken": "the sensor's wire is broken",
    }

    room: float = 20.0
    warm: float | None = None

    element: float = field(default=0.0, init=False)
    chamber: float = field(default=0.0, init=False)
    sensor: float = field(default=0.0, init=False)
    heating: bool = field(default=False, init=False)  # the heater takes current

    _loss: float = field(default=CLOSED, init=False, repr=False)
    _end: float = field(default=0.0, init=False, repr=False)  # where the chamber goes to
    _element_end: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self):
        self.element = self.chamber = self.sensor = self.room if self.warm is None else self.warm
        super().__post_init__()

    def step(self, seconds: float, outputs: Mapping[str, int]) -> dict[str, int]:
        """Let `seconds` pass under relay Y0 and contactor Y1; returns door X1 and temperature D0. What burns is noted at a step's end."""
        super().step(seconds, outputs)
        if self._reading() != self.inputs["D0"] or (self.chamber >= BURNT) != bool(self._amiss):
            self._look()
        return self.inputs

    def _move(self, seconds):
        element, chamber, sensor = self.element - self._element_end, self.chamber - self._end, self.sensor - self._end
        ee, ec, ce, cc, se, sc, ss = decay(self._loss, seconds)
        self.element = self._element_end + ee * element + ec * chamber
        self.chamber = self._end + ce * element + cc * chamber
        self.sensor = self._end + se * element + sc * chamber + ss * sensor

    def _plan(self):
        relay, main = self._outputs
        self.heating = bool(main and (relay or "relay welded" in self.faults) and "element broken" not in self.faults)
        self._loss = OPEN if "door open" in self.faults else CLOSED
        self._end = self.room + POWER * self.heating / self._loss
        self._element_end = self._end + POWER * self.heating / TO_CHAMBER
        self._look()
        return inf

    def _reading(self):
        return BROKEN if "sensor broken" in self.faults else round(10 * self.sensor)

    def _look(self):
        """What door and transmitter say, and whether something burns."""
        self.inputs = {"X1": int("door open" not in self.faults), "D0": self._reading()}
        self._report({"what is in the oven burns"} if self.chamber >= BURNT else set())
