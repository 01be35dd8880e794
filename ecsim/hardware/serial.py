"""The serial ports: their settings and, in simulated time, every character that they send and hear."""

from dataclasses import dataclass
from typing import Any

from ..errors import EcsimError
from ..models import Model

PARITIES = ("none", "odd", "even")
MODES = ("rtu", "ascii")
_FRAMES = {"freeport": (9600, 8, "none", 1), "modbus": (19200, 8, "even", 1), "ecbus": (38400, 8, "even", 1)}  # the usual ones


@dataclass(frozen=True, slots=True)
class Framing:
    """How one character stands on the line."""

    baud: int
    data_bits: int
    parity: str
    stop_bits: int

    @property
    def bits(self) -> int:
        """The bits of a character, its start bit too."""
        return 1 + self.data_bits + (self.parity != "none") + self.stop_bits

    def after(self, count: int) -> int:
        """How long `count` characters take, in whole microseconds."""
        return count * self.bits * 1_000_000 // self.baud


@dataclass(frozen=True)
class PortSettings:
    """What the system block sets for one serial port (2.2.1, 10.3.2, 10.4.13).

    `protocol` is "programming", "none", "freeport", "modbus slave", "modbus master" or "ecbus"; where baud rate, data bits, parity
    and stop bits are None, they are the usual ones of the protocol (freeport 9600 8N1, Modbus 19200 8E1, 7E1 in ASCII mode).
    Characters are numbers from 0 to 255, None for none; a time of 0 ms is not watched.
    """

    protocol: str = "none"
    mode: str = "rtu"
    station: int = 1
    baud: int | None = None
    data_bits: int | None = None
    parity: str | None = None
    stop_bits: int | None = None
    timeout_ms: int = 500
    retries: int = 0
    start_char: int | None = None
    end_char: int | None = None
    gap_timeout_ms: int = 0
    frame_timeout_ms: int = 0

    @property
    def framing(self) -> Framing:
        """The characters of this port."""
        baud, data_bits, parity, stop_bits = _FRAMES.get(self.protocol.partition(" ")[0], _FRAMES["freeport"])
        if self.mode == "ascii" and self.modbus:
            data_bits = 7
        parity = parity if self.parity is None else self.parity
        if self.stop_bits is not None:
            stop_bits = self.stop_bits
        elif self.modbus:
            stop_bits = 2 if parity == "none" else 1
        return Framing(self.baud or baud, self.data_bits or data_bits, parity, stop_bits)

    @property
    def modbus(self) -> bool:
        """Whether the port speaks Modbus, in either role."""
        return self.protocol.startswith("modbus")

    def check(self, model: Model, number: int) -> None:
        """Raise EcsimError for what port `number` of a model cannot be set to."""
        where = f"port {number}"
        if number >= len(model.ports):
            raise EcsimError(f"{model.name} has no {where}; it has {len(model.ports)} serial ports")
        _choice(f"the protocol of {where}", self.protocol, model.ports[number].protocols)
        _choice(f"the mode of {where}", self.mode, MODES)
        framing = self.framing
        _choice(f"the baud rate of {where}", framing.baud, model.bauds[self.protocol])
        _choice(f"the parity of {where}", framing.parity, PARITIES)
        _choice(f"the data bits of {where}", framing.data_bits, (7 if self.mode == "ascii" else 8,) if self.modbus else (7, 8))
        stops = ((2,) if framing.parity == "none" else (1,)) if self.modbus else (1, 2)  # 10.4.13: 1 with parity, 2 without
        _choice(f"the stop bits of {where}", framing.stop_bits, stops)
        _whole(f"the station of {where}", self.station, 1 if self.protocol == "modbus slave" else 0, 31)
        _whole(f"timeout_ms of {where}", self.timeout_ms, 1, 32767)
        _whole(f"retries of {where}", self.retries, 0, 100)
        for name in ("start_char", "end_char"):
            if getattr(self, name) is not None:
                _whole(f"{name} of {where}", getattr(self, name), 0, 255)
        for name in ("gap_timeout_ms", "frame_timeout_ms"):
            _whole(f"{name} of {where}", getattr(self, name), 0, 65535)


def _choice(what: str, value: Any, choices: tuple) -> None:
    """Raise EcsimError unless a value is one of some."""
    if isinstance(value, bool) or value not in choices:
        raise EcsimError(f"{what} is {value!r}; choose {' or '.join(map(str, choices))}")


def _whole(what: str, value: Any, low: int, high: int) -> None:
    """Raise EcsimError unless a value is a whole number within its range."""
    if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
        raise EcsimError(f"{what} is {value!r}; it is a whole number from {low} to {high}")
