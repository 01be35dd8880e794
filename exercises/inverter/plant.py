"""An EV inverter with its motor, spoken to over Modbus RTU as station of a line (6.12, appendix 5).

It is commanded by its control word and main setting and tells its state in seven words; their places are those of
`ecsim.comms.inverter`. Frequencies are hertz, forward positive. It stands on a wire like any instrument:

    drive = Inverter(station=5)
    plc.ports[1].connect(drive)
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from ecsim import EcsimError
from ecsim.comms.frames import BadFrame, rtu_decode, rtu_encode
from ecsim.comms.inverter import (
    CONTROL,
    FAULT_RESET,
    HUNDREDTHS,
    JOG_FORWARD,
    JOG_REVERSE,
    RAMP,
    READ,
    REVERSE,
    RUN,
    SETTING,
    STATUS,
    STATUS_WORDS,
    STOP_COMMANDS,
    VALID,
    WRITE,
)

from ..plant import Faulty, Point

# Appendix 5.
FUNCTION, REGISTER, LIMITS, FAILED, IN_PROGRESS, BUSY = range(1, 7)
FRAME, FIXED, RUNNING_LOCK, PASSWORD = 0x18, 0x20, 0x21, 0x22

# The status word: bits, and the code of the trip in its high byte.
RUNNING, BACKWARD, ARRIVED, REMOTE = 1, 2, 4, 8

# What it trips with, and the number that it tells (word 6 and the high byte of the status word).
TRIPS = {"overcurrent": 3, "overvoltage": 6, "phase loss": 8, "overheated": 11, "overload": 13, "external": 15}

MOST_READ = 10  # registers of one request
EXCEPTION = 0x80
TYPE = 1000
MAGNETISING = 0.3  # the share of the rated current that flows without load
SLIP = 0.04  # at the rated load


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter: its value as it comes, its limits, and whether it may be written at all and while the motor turns."""

    value: int
    low: int
    high: int
    writable: bool = True
    running: bool = True


DIGITAL_CONTROL, INITIAL, TOP, ACCELERATION, DECELERATION, FAST, JOG, KIND = 0x0001, 0x0002, 0x0005, 0x000A, 0x000B, 0x000C, 0x0205, 0x0D00
# Frequencies in 0.01 Hz, times in 0.1 s from standstill to the top frequency; 1 and 2 are those that 6.12.8 and 6.12.10 name.
PARAMETERS = {
    DIGITAL_CONTROL: Parameter(0, 0, 3),
    INITIAL: Parameter(5000, 0, 5000),
    TOP: Parameter(5000, 1000, 40000, running=False),
    ACCELERATION: Parameter(60, 1, 36000),
    DECELERATION: Parameter(60, 1, 36000),
    FAST: Parameter(10, 1, 36000),
    JOG: Parameter(500, 10, 5000),
    KIND: Parameter(TYPE, 0, 0xFFFF, writable=False),
}


class _Refused(Exception):
    """A request that is answered with a code of appendix 5."""

    def __init__(self, code: int):
        super().__init__(code)
        self.code = code


@dataclass
class Inverter(Faulty):
    """The inverter. `load` is the torque on the motor's shaft as a share of the rated one; more than 1.5 trips it by itself."""

    station: int = 1
    load: float = 0.5
    rated_a: float = 10.0
    rated_v: float = 380.0
    rated_hz: float = 50.0
    pole_pairs: int = 2
    coast_s: float = 8.0  # how long the motor takes from the rated speed to standstill without current
    hertz: float = 0.0  # what is put out; 0 without output
    rotor: float = 0.0  # how fast the motor turns, in hertz without slip
    mode: str = "stopped"  # stopped, running, stopping, coasting, fast, jogging or tripped
    target: float = 0.0  # the frequency that it goes to while running or jogging
    backward: bool = False
    ramping: bool = True  # the control word lets the ramp go on
    trip: str = ""
    setting: int = 0  # hundredths of a hertz
    faults: frozenset[str] = frozenset()
    parameters: dict[int, int] = field(default_factory=lambda: {address: row.value for address, row in PARAMETERS.items()})

    wiring: ClassVar[dict[str, Point]] = {}  # everything goes over the line
    FAULTS: ClassVar[dict[str, str]] = {
        "silent": "it does not answer",
        "garbled": "its answers have a wrong checksum",
        "busy": "it is busy and carries nothing out",
        "slow": "it stores parameters slowly and says so",
        "locked": "its parameters are protected by a password",
        **{name: f"it trips: {name}" for name in TRIPS},
    }

    def __post_init__(self) -> None:
        if not 1 <= self.station <= 247:
            raise EcsimError(f"station {self.station!r} of an inverter; it is 1 to 247")
        self.setting = self.parameters[INITIAL]

    def fail(self, fault: str, on: bool = True) -> None:
        """Switch a fault in, or out again; a trip stays until it is reset. Raises EcsimError for one that it does not have."""
        super().fail(fault, on)
        if on and fault in TRIPS:
            self._trip(fault)

    def _trip(self, cause: str) -> None:
        self.trip, self.mode, self.hertz = cause, "tripped", 0.0

    # -- motor --------------------------------------------------------------------------------------------------

    def step(self, seconds: float, outputs: Mapping[str, int] | None = None) -> dict[str, int]:
        """Let the motor turn for so long."""
        if self.mode in ("running", "jogging"):
            self._toward(self.target, seconds)
            if self.load > 1.5:
                self._trip("overload")
        elif self.mode in ("stopping", "fast"):
            self._toward(0.0, seconds)
            if not self.hertz:
                self.mode = "stopped"
        if self.mode in ("coasting", "tripped", "stopped"):
            self.hertz = 0.0
            fall = self.rated_hz / self.coast_s * seconds
            self.rotor = max(abs(self.rotor) - fall, 0.0) * (1 if self.rotor >= 0 else -1)
            if not self.rotor and self.mode == "coasting":
                self.mode = "stopped"
        else:
            self.rotor = self.hertz
        return {}

    def _toward(self, target: float, seconds: float) -> None:
        """The ramp: away from standstill with the time to accelerate, toward it with that to decelerate."""
        if not self.ramping:
            return
        top = self.parameters[TOP] / HUNDREDTHS
        while seconds > 0 and self.hertz != target:
            slowing = self.hertz * target < 0 or abs(target) < abs(self.hertz)
            tenths = self.parameters[ACCELERATION]
            if slowing:
                tenths = self.parameters[FAST if self.mode == "fast" else DECELERATION]
            rate = top / (tenths / 10)
            goal = 0.0 if self.hertz * target < 0 else target  # a reversal goes through standstill
            needed = abs(goal - self.hertz) / rate
            if needed <= seconds:
                self.hertz = goal
            else:
                self.hertz += rate * seconds * (1 if goal > self.hertz else -1)
            seconds -= needed

    @property
    def current(self) -> float:
        """The motor's current in amperes."""
        if not self.status & RUNNING:
            return 0.0
        surplus = 0.4 if self.mode in ("running", "jogging") and abs(self.target) > abs(self.hertz) else 0.0
        return self.rated_a * (MAGNETISING + (1 - MAGNETISING) * self.load + surplus)

    @property
    def voltage(self) -> float:
        """The output voltage: in proportion to the frequency up to the rated one."""
        return self.rated_v * min(abs(self.hertz) / self.rated_hz, 1.0)

    @property
    def rpm(self) -> float:
        """The motor's speed in revolutions a minute, forward positive."""
        slip = SLIP * self.load if self.hertz else 0.0
        return 60 * self.rotor / self.pole_pairs * (1 - slip)

    # -- line ---------------------------------------------------------------------------------------------------

    def hear(self, message: bytes) -> bytes | None:
        """Answer a frame of the line: an RTU frame for this station, or None for what is none, a broadcast, or for another one."""
        try:
            station, request = rtu_decode(message)
        except BadFrame:
            return None
        if station not in (0, self.station) or "silent" in self.faults:
            return None
        try:
            answer = self._carry_out(request)
        except _Refused as refused:
            answer = bytes((request[0] | EXCEPTION, refused.code))
        if station == 0:
            return None
        frame = rtu_encode(self.station, answer)
        return frame[:-1] + bytes((frame[-1] ^ 0xFF,)) if "garbled" in self.faults else frame

    def _carry_out(self, request: bytes) -> bytes:
        function = request[0]
        if function not in (READ, WRITE):
            raise _Refused(FUNCTION)
        if len(request) != 5:
            raise _Refused(FRAME)
        register, value = int.from_bytes(request[1:3]), int.from_bytes(request[3:5])
        if function == READ:
            if not 1 <= value <= MOST_READ:
                raise _Refused(LIMITS)
            words = [self._read(register + place) for place in range(value)]
            return bytes((READ, 2 * value)) + b"".join(word.to_bytes(2) for word in words)
        if "busy" in self.faults:
            raise _Refused(BUSY)
        self._write(register, value)
        return request

    def _read(self, register: int) -> int:
        if register in self.parameters:
            return self.parameters[register]
        if register == SETTING:
            return self.setting
        if not STATUS <= register < STATUS + len(STATUS_WORDS):
            raise _Refused(REGISTER)
        words = (
            self.status, round(abs(self.hertz) * HUNDREDTHS), self.parameters[KIND], round(self.current * 10), round(self.voltage),
            round(abs(self.rpm)), TRIPS.get(self.trip, 0),
        )  # fmt: skip
        return words[register - STATUS]

    @property
    def status(self) -> int:
        """The status word."""
        turning = self.mode in ("running", "jogging", "stopping", "fast")
        arrived = self.mode in ("running", "jogging") and self.hertz == self.target
        backward = self.hertz < 0 or (turning and not self.hertz and self.backward)
        bits = RUNNING * turning + BACKWARD * backward + ARRIVED * arrived + REMOTE
        return bits | TRIPS.get(self.trip, 0) << 8

    def _write(self, register: int, value: int) -> None:
        if register == CONTROL:
            self._command(value)
        elif register == SETTING:
            if value > self.parameters[TOP]:
                raise _Refused(LIMITS)
            self.setting = value
            if self.mode == "running":
                self._aim(value)
        elif register in PARAMETERS:
            self._store(register, PARAMETERS[register], value)
        elif STATUS <= register < STATUS + len(STATUS_WORDS):
            raise _Refused(FIXED)
        else:
            raise _Refused(REGISTER)

    def _store(self, register: int, row: Parameter, value: int) -> None:
        if "locked" in self.faults:
            raise _Refused(PASSWORD)
        if not row.writable:
            raise _Refused(FIXED)
        if not row.running and self.status & RUNNING:
            raise _Refused(RUNNING_LOCK)
        if not row.low <= value <= row.high:
            raise _Refused(LIMITS)
        self.parameters[register] = value
        if "slow" in self.faults:
            raise _Refused(IN_PROGRESS)

    def _aim(self, hundredths: int) -> None:
        self.target = hundredths / HUNDREDTHS * (-1 if self.backward else 1)

    def _command(self, word: int) -> None:
        """The control word; one that is not valid changes nothing."""
        if not word & VALID:
            return
        self.ramping = bool(word & RAMP)
        if word & FAULT_RESET and self.trip and self.trip not in self.faults:
            self.trip, self.mode = "", "stopped"
        order, jog = word & 0b111, word & (JOG_FORWARD | JOG_REVERSE)
        if order == RUN or jog:
            if self.trip or jog == JOG_FORWARD | JOG_REVERSE or (jog and order != RUN and self.mode == "running"):
                raise _Refused(FAILED)
            if self.mode in ("stopped", "coasting"):
                self.hertz = self.rotor  # it catches a motor that turns
            self.mode = "running" if order == RUN else "jogging"
            self.backward = bool(word & REVERSE) if order == RUN else jog == JOG_REVERSE
            self._aim(self.setting if order == RUN else self.parameters[JOG])
        elif self.status & RUNNING and (order in STOP_COMMANDS or self.mode == "jogging"):
            self.mode = dict(zip(STOP_COMMANDS, ("stopping", "coasting", "fast"), strict=True)).get(order, "stopping")

    def state(self) -> tuple:
        """What `restore` takes to come back to this moment."""
        return (
            self.load, self.hertz, self.rotor, self.mode, self.target, self.backward, self.ramping, self.trip, self.setting,
            sorted(self.faults), sorted(self.parameters.items()),
        )  # fmt: skip

    def restore(self, state: tuple) -> None:
        """Come back to a moment."""
        (
            self.load, self.hertz, self.rotor, self.mode, self.target, self.backward, self.ramping, self.trip, self.setting,
            faults, parameters,
        ) = state  # fmt: skip
        self.faults, self.parameters = frozenset(faults), dict(parameters)
