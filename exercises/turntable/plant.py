"""A table that a motor turns to its windows (ROTC of H2U), and a shaft with an encoder for drums of cams (ABSD, INCD)."""

from dataclasses import dataclass, field
from math import inf, sqrt
from typing import ClassVar

from ecsim import EcsimError

from ..plant import Machine, Point

PLACES = 10
FAST, SLOW = 1.0, 0.2  # places a second
STARTING, BRAKING = 2.0, 10.0  # places a second, each second: of the motor or by friction, and of the brake
QUARTERS = 4  # of a pulse: phase A leads phase B by one


@dataclass
class Turntable(Machine):
    """A table of 10 places with as many windows around it, its motor and its switches.

    The two phases give `pulses` pulses a place, so that ROTC gets M1 = 10 * pulses and items and windows as multiples of
    `pulses`. `start` is how many pulses the table has been turned forward at first. Item 0 then stands at window 0 when it has
    been turned by 0; forward takes item 1 there. The table needs a while to change its speed.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("PhaseA", "phase A of the switch"),
        "X1": Point("PhaseB", "phase B of the switch"),
        "X2": Point("Zero", "item 0 stands at window 0"),
        "Y0": Point("FwdFast", "motor: forward fast"),
        "Y1": Point("FwdSlow", "motor: forward slowly"),
        "Y2": Point("Brake", "brake"),
        "Y3": Point("BackSlow", "motor: backward slowly"),
        "Y4": Point("BackFast", "motor: backward fast"),
    }
    DRIVES: ClassVar[tuple[str, ...]] = ("Y0", "Y1", "Y2", "Y3", "Y4")
    EXACT: ClassVar[tuple[str, ...]] = ("within", "speed")
    FAULTS: ClassVar[dict[str, str]] = {"jammed": "the table cannot turn"}

    pulses: int = 10
    start: int = 0

    quarter: int = field(default=0, init=False)  # in which quarter of a pulse it stands, round the whole table
    within: float = field(default=0.0, init=False)  # how far in it, 0 to 1
    speed: float = field(default=0.0, init=False)  # places a second, forward positive
    travelled: float = field(default=0.0, init=False)  # places altogether, forward positive

    _change: float = field(default=0.0, init=False, repr=False)  # of the speed, a second

    def __post_init__(self):
        if not isinstance(self.pulses, int) or not 1 <= self.pulses <= 100:
            raise EcsimError(f"{self.pulses!r} pulses a place; a table gives 1 to 100")
        if self.start not in range(PLACES * self.pulses):
            raise EcsimError(f"start {self.start!r}; it is counted in pulses, 0 to {PLACES * self.pulses - 1}")
        self.quarter = QUARTERS * self.start
        super().__post_init__()

    @property
    def turned(self) -> float:
        """How many places it is turned forward, 0 to 10."""
        return (self.quarter + self.within) / (QUARTERS * self.pulses)

    def item_at(self, window: int) -> tuple[int, float]:
        """The item nearest to a window, and how many places it stands before it (below 0: it has gone by, seen forward)."""
        there = (self.turned + window) % PLACES
        return round(there) % PLACES, round(round(there) - there, 6)

    def _plan(self):
        rate = QUARTERS * self.pulses  # quarters a place
        around = PLACES * rate
        forward_fast, forward_slow, brake, back_slow, back_fast = map(bool, self._outputs)
        amiss = set()
        if forward_fast + forward_slow + back_slow + back_fast > 1:
            amiss.add("the motor is driven in two ways at once")
        target = FAST * (forward_fast - back_fast) or SLOW * (forward_slow - back_slow)
        if brake and target:
            amiss.add("the motor is driven against the brake")
        self._report(amiss)
        if amiss or "jammed" in self.faults:
            target = 0.0
        goal = 0.0 if self.speed * target < 0 else target  # through standstill to the other way
        change = 0.0 if goal == self.speed else (BRAKING if brake or "jammed" in self.faults else STARTING)
        self._change = change if goal > self.speed else -change
        way = 1 if (self.speed or self._change) > 0 else -1
        if self.speed or self._change:
            if way > 0 and self.within == 1:
                self.quarter, self.within = (self.quarter + 1) % around, 0.0
            elif way < 0 and self.within == 0:
                self.quarter, self.within = (self.quarter - 1) % around, 1.0
        phase = self.quarter % QUARTERS
        self.inputs = {"X0": int(phase in (1, 2)), "X1": int(phase in (2, 3)), "X2": int(self.quarter in (0, around - 1))}
        left = (1 - self.within if way > 0 else self.within) / rate
        steady = abs(goal - self.speed) / change if change else inf
        return min(steady, _seconds(left, abs(self.speed), self._change * way))

    def _move(self, seconds):
        places = (self.speed + self._change * seconds / 2) * seconds
        self.within += places * QUARTERS * self.pulses
        self.travelled += places
        self.speed += self._change * seconds


def _seconds(way: float, speed: float, change: float) -> float:
    """How long a way takes at a speed that changes evenly; for ever when it ends before."""
    square = speed * speed + 2 * change * way
    reach = speed + sqrt(square) if square > 0 else 0.0
    return 2 * way / reach if reach else inf


CAMS = 8


@dataclass
class CamShaft(Machine):
    """A shaft that turns while its motor runs, its encoder with zero mark, and eight outputs in the place of cams.

    The encoder gives `pulses` pulses a turn, the n-th one at n/pulses of it; a turn takes `turn_s` seconds. Where each output went
    ON and OFF last stands in `cams`.
    """

    wiring: ClassVar[dict[str, Point]] = {
        "X0": Point("Pulse", "encoder of the shaft"),
        "X1": Point("Mark", "zero mark of the shaft"),
        "Y0": Point("Run", "motor of the shaft"),
        **{f"Y{0o10 + cam:o}": Point(f"Cam{cam}", f"output {cam} of the drum") for cam in range(CAMS)},
    }
    DRIVES: ClassVar[tuple[str, ...]] = tuple(device for device in wiring if device.startswith("Y"))
    EXACT: ClassVar[tuple[str, ...]] = ("within",)
    FAULTS: ClassVar[dict[str, str]] = {"jammed": "the shaft cannot turn"}

    pulses: int = 72
    turn_s: float = 6.0

    half: int = field(default=0, init=False)  # halves of a pulse that it has turned since the start
    within: float = field(default=0.0, init=False)  # how far in it, 0 to 1
    cams: tuple[tuple[float | None, float | None], ...] = field(default=((None, None),) * CAMS, init=False)  # degrees: ON, OFF

    _before: tuple[int, ...] = field(default=(0,) * CAMS, init=False, repr=False)
    _rate: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self):
        if not isinstance(self.pulses, int) or not 4 <= self.pulses <= 3600:
            raise EcsimError(f"{self.pulses!r} pulses a turn; an encoder gives 4 to 3600")
        if not self.turn_s > 0:
            raise EcsimError(f"a turn in {self.turn_s!r} s; it takes more than 0")
        super().__post_init__()

    @property
    def angle(self) -> float:
        """The shaft's angle in degrees, 0 to 360."""
        return (self.half + self.within) * 180 / self.pulses % 360

    def _plan(self):
        run, *outputs = self._outputs
        self._rate = 2 * self.pulses / self.turn_s if run and "jammed" not in self.faults else 0.0
        if self.within == 1:
            self.half, self.within = self.half + 1, 0.0
        if tuple(outputs) != self._before:
            angle = round(self.angle, 3)
            self.cams = tuple(
                cam if now == was else (angle, cam[1]) if now else (cam[0], angle)
                for cam, now, was in zip(self.cams, outputs, self._before, strict=True)
            )
            self._before = tuple(outputs)
        # The shaft stands before its first pulse at first.
        self.inputs = {"X0": int(self.half > 0 and self.half % 2 == 0), "X1": int(self.half % (2 * self.pulses) == 0)}
        return (1 - self.within) / self._rate if self._rate else inf

    def _move(self, seconds):
        self.within += self._rate * seconds
