"""The serial ports: their settings and, in simulated time, every character that they send and hear."""

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..errors import EcsimError
from ..memory import Memory
from ..models import Model
from ..values import signed16
from .interrupts import Interrupts
from .unit import Unit
from .wire import End, Framing, Wire

PARITIES = ("none", "odd", "even")
MODES = ("rtu", "ascii")
LONGEST_DELAY_MS = 100  # of ECbus
_FRAMES = {"freeport": (9600, 8, "none", 1), "modbus": (19200, 8, "even", 1), "ecbus": (38400, 8, "even", 1)}  # the usual ones


@dataclass(frozen=True)
class PortSettings:
    """What the system block sets for one serial port (2.2.1, 10.3.2, 10.4.13).

    `protocol` is "programming", "none", "freeport", "rs", "modbus slave", "modbus master" or "ecbus"; where baud rate, data bits, parity
    and stop bits are None, they are the usual ones of the protocol (freeport 9600 8N1, Modbus 19200 8E1, 7E1 in ASCII mode).
    Characters are numbers from 0 to 255, None for none; a time of 0 ms is not watched. On an ECbus station 0 says for all how many
    stations there can be, the refresh mode, the retries and an additional delay (10.5.4).
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
    stations: int = 2
    refresh_mode: int = 5
    delay_ms: int = 0

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
        _choice(f"the mode of {where}", self.mode, model.modbus_modes if self.modbus else MODES)
        framing = self.framing
        _choice(f"the baud rate of {where}", framing.baud, model.bauds[self.protocol])
        _choice(f"the parity of {where}", framing.parity, PARITIES)
        _choice(f"the data bits of {where}", framing.data_bits, (7 if self.mode == "ascii" else 8,) if self.modbus else (7, 8))
        stops = model.modbus_stop_bits.get(framing.parity, (1, 2)) if self.modbus else (1, 2)
        _choice(f"the stop bits of {where}", framing.stop_bits, stops)
        _whole(f"the station of {where}", self.station, 1 if self.protocol == "modbus slave" else 0, 31)
        _whole(f"timeout_ms of {where}", self.timeout_ms, 1, 32767)
        _whole(f"retries of {where}", self.retries, 0, 100)
        for name in ("start_char", "end_char"):
            if getattr(self, name) is not None:
                _whole(f"{name} of {where}", getattr(self, name), 0, 255)
        for name in ("gap_timeout_ms", "frame_timeout_ms"):
            _whole(f"{name} of {where}", getattr(self, name), 0, 65535)
        if self.protocol == "ecbus":
            _choice(f"refresh_mode of {where}", self.refresh_mode, tuple(model.shared))
            _whole(f"stations of {where} (refresh mode {self.refresh_mode})", self.stations, 2, model.shared[self.refresh_mode].stations)
            _whole(f"delay_ms of {where}", self.delay_ms, 0, LONGEST_DELAY_MS)


def _choice(what: str, value: Any, choices: tuple) -> None:
    """Raise EcsimError unless a value is one of some."""
    if isinstance(value, bool) or value not in choices:
        raise EcsimError(f"{what} is {value!r}; choose {' or '.join(map(str, choices))}")


def _whole(what: str, value: Any, low: int, high: int) -> None:
    """Raise EcsimError unless a value is a whole number within its range."""
    if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
        raise EcsimError(f"{what} is {value!r}; it is a whole number from {low} to {high}")


class Protocol:
    """What a port does with the characters that it hears; this one does nothing. Times are those of the PLC, in microseconds."""

    busy = False  # whether the port has a task
    due: int | None = None  # when `timeout` has to be called
    fires = False  # whether characters and frames ask for interrupt programs

    def __init__(self, port: "Port"):
        self.port = port

    def begin(self, now: int) -> None:
        """STOP or RUN."""

    def character(self, byte: int, wrong: bool, now: int) -> None:
        """A character was heard."""

    def sent(self, now: int) -> None:
        """All that was to be sent has gone out."""

    def release(self, claim: int, now: int) -> None:
        """The command with this number has lost its flow."""

    def timeout(self, now: int) -> None:
        """The moment that `due` named has come."""

    def look(self, now: int) -> None:
        """A program has run."""

    def serve(self, now: int) -> None:
        """The communication phase of a scan."""

    def snapshot(self) -> Any:
        """What changes while the protocol works, as plain data."""

    def restore(self, state: Any) -> None:
        """Go back to a snapshot."""


class Port(Unit, End):
    """A serial port: characters go out and come in at their time, a protocol says what they mean.

    `plc.ports[1].connect(instrument)` gives it a partner of its own; `Wire.join` puts it on a line with others.
    """

    in_stop = True
    network: Any = None  # the network that the PLC belongs to

    def __init__(
        self,
        number: int,
        memory: Memory,
        interrupts: Interrupts,
        clock: list[int],
        awake: list[Unit],
        protocols: Mapping[str, Callable[["Port"], Protocol]],
    ):
        Unit.__init__(self, awake)
        self.number, self.memory, self.interrupts, self.clock, self.protocols = number, memory, interrupts, clock, protocols
        self.rank = 5 + number
        self.name = f"port {number}"
        self.map = memory.model.ports[number]
        self.powered = True
        self.reserved = False
        self.set_up(None)

    def set_up(self, settings: PortSettings | None) -> None:
        """Take over the settings of the system block; None leaves the port as the unit comes."""
        self.settings = self.chosen = settings or PortSettings(self.map.protocols[0])
        self.told = (0, 0)
        self._begin()
        if self.memory.model.protocol_codes:
            self.show()

    def reserve(self, on: bool) -> None:
        """Keep the port for the programming software, whatever the system block says (10.1), or give it back."""
        if on != self.reserved:
            self.protocol.begin(self.clock[0])  # ends what goes on
            self.reserved = on
            self._begin()
            self.restart(self.clock[0])

    def _begin(self) -> None:
        settings = PortSettings("programming") if self.reserved else self.settings
        End.__init__(self, settings.framing)
        self.heard: deque[tuple[int, int, bool]] = deque()  # (when, byte, wrong)
        self.protocol = self.protocols.get(settings.protocol, Protocol)(self)
        self.stirred()

    def power(self, on: bool) -> None:
        """Switched off a port neither hears nor sends; switched on it begins anew."""
        self.powered = on
        self.set_up(self.chosen)

    # -- special devices ----------------------------------------------------------------------------------------

    def on(self, meaning: str) -> bool:
        """Whether a relay of the port is ON; not where the model has none."""
        relay = self.map.relays.get(meaning)
        return relay is not None and self.memory.lists[self.memory.model.special_bits][relay]

    def tell(self, meaning: str, on: bool) -> None:
        """Turn a relay of the port ON or OFF, if the model has it."""
        if meaning in self.map.relays:
            self.memory.lists[self.memory.model.special_bits][self.map.relays[meaning]] = on

    def register(self, meaning: str) -> int:
        """A register of the port without its sign, 0 where the model has none."""
        if meaning not in self.map.registers:
            return 0
        return self.memory.lists[self.memory.model.special_words][self.map.registers[meaning]] & 0xFFFF

    def put(self, meaning: str, value: int) -> None:
        """Write a register of the port, if the model has it."""
        if meaning in self.map.registers:
            self.memory.lists[self.memory.model.special_words][self.map.registers[meaning]] = signed16(value)

    def fire(self, meaning: str) -> None:
        """Ask for the interrupt program of one of the port's events."""
        if self.protocol.fires and meaning in self.map.events:
            self.interrupts.fire(self.map.events[meaning])

    def show(self) -> None:
        """The settings in the registers from which the program reads, and may change, them."""
        settings, framing, model = self.settings, self.framing, self.memory.model
        parts = {
            "two stop bits": framing.stop_bits == 2, "parity": framing.parity != "none", "odd": framing.parity == "odd",
            "even": framing.parity == "even", "seven bits": framing.data_bits == 7, "eight bits": framing.data_bits == 8,
            "start character": settings.start_char is not None, "end character": settings.end_char is not None,
            "gap timeout": settings.gap_timeout_ms > 0, "frame timeout": settings.frame_timeout_ms > 0,
        }  # fmt: skip
        word = sum(1 << place for what, place in model.mode_bits.items() if parts.get(what))
        self.put("mode", word | model.baud_codes[framing.baud] << model.mode_bits["baud"])
        for meaning, character in (("start character", settings.start_char), ("end character", settings.end_char)):
            if character is not None or not model.protocol_codes:
                self.put(meaning, character or 0)
        code = next((code for code, named in model.protocol_codes.items() if named == (settings.protocol, settings.mode)), 0)
        self.put("protocol", code)
        self.put("gap timeout", settings.gap_timeout_ms)
        self.put("frame timeout", settings.frame_timeout_ms)
        self.tell("idle", not self.protocol.busy)
        self.put("station", settings.station)
        self.put("timeout", settings.delay_ms if settings.protocol == "ecbus" else settings.timeout_ms)
        self.put("refresh mode", settings.refresh_mode if settings.protocol == "ecbus" else 0)
        self.put("retries", settings.retries)
        self.told = self.register("mode"), self.register("protocol")

    def obey(self) -> None:
        """Take over another format or protocol where the program has written one into the port's registers.

        A code that means nothing, or a rate that there is not, leaves the port as it is.
        """
        model = self.memory.model
        told = self.register("mode"), self.register("protocol")
        if told == self.told or "protocol" not in self.map.registers:
            return
        self.told = told
        word, places = told[0], model.mode_bits
        rates = {code: baud for baud, code in model.baud_codes.items()}
        baud = rates.get(word >> places["baud"] & 15)
        protocol, mode = model.protocol_codes.get(told[1], (self.chosen.protocol, self.chosen.mode))
        if baud is None:
            return

        def says(what: str) -> bool:
            return bool(word >> places[what] & 1)

        self.settings = replace(
            self.chosen,
            protocol=protocol,
            mode=mode,
            baud=baud,
            data_bits=8 if says("eight bits") else 7,
            parity="none" if not says("parity") else "even" if says("even") else "odd",
            stop_bits=2 if says("two stop bits") else 1,
            start_char=self.register("start character") & 0xFF if says("start character") else None,
            end_char=self.register("end character") & 0xFF if says("end character") else None,
        )
        self._begin()

    # -- the line -----------------------------------------------------------------------------------------------

    def connect(self, instrument: Any, delay_ms: float = 0) -> End:
        """Connect an instrument, an object with `hear(message: bytes) -> bytes | None`, which answers `delay_ms` after a message."""
        if self.wire is None:
            Wire(f"wire of {self.name}").join(self)
        return self.wire.join(instrument, delay_ms=delay_ms)

    def disconnect(self) -> None:
        """Take the port off its wire."""
        if self.wire is not None:
            self.wire.leave(self)
            self.stirred()

    @property
    def drives(self) -> Wire | None:
        """The wire whose stations live by the clock of this port."""
        return self.wire if self.wire is not None and self.wire.driver is self else None

    def wire_time(self) -> int:
        """The present moment as the wire counts it."""
        return self.clock[0] + self.shift

    def send(self, text: bytes, now: int) -> None:
        End.send(self, text, now)
        self.stirred()

    def take(self, byte: int, wrong: bool, at: int) -> None:
        if self.powered:
            self.heard.append((max(at, self.clock[0]), byte, wrong))  # nothing is heard before one's own time
            self.wake()
            if self.network is not None:
                self.network.reached(self)

    # -- the unit -----------------------------------------------------------------------------------------------

    def _moment(self) -> int | None:
        stations = self.drives
        moments = (
            self.heard[0][0] if self.heard else None,
            self.character_due,
            self.protocol.due,
            stations.next() if stations is not None else None,
        )
        return min((moment for moment in moments if moment is not None), default=None)

    def stirred(self) -> None:
        """Something has changed: the idle relay, and whether time has to ask the port."""
        busy = self.protocol.busy
        self.tell("idle", not busy)
        self.wake(busy or self._moment() is not None)

    def next(self, until: int) -> int | None:
        moment = self._moment()
        return moment if moment is not None and moment <= until else None

    def act(self, now: int) -> None:
        while self.heard and self.heard[0][0] <= now:
            _, byte, wrong = self.heard.popleft()
            self.protocol.character(byte, wrong, now)
        if self.character_due == now:
            self.put("sent character", self.character_out(now))
            self.fire("character sent")
            if not self.sending:
                self.tell("sent", True)
                self.protocol.sent(now)
        if self.protocol.due is not None and self.protocol.due <= now:
            self.protocol.timeout(now)
        if self.drives is not None:
            self.drives.act(now)
        self.stirred()

    def look(self, now: int) -> None:
        self.protocol.look(now)
        self.stirred()

    def serve(self, now: int) -> None:
        self.protocol.serve(now)
        self.stirred()

    def restart(self, now: int) -> None:
        self.protocol.begin(now)
        self.stirred()

    def release(self, claim: int, now: int) -> None:
        self.protocol.release(claim, now)

    def snapshot(self) -> tuple:
        stations = self.drives
        return (
            self.powered, self.sent_so_far(), list(self.heard), self.protocol.snapshot(),
            None if stations is None else stations.snapshot(), self.clock[0], self.reserved,
        )  # fmt: skip

    def restore(self, snapshot: tuple) -> None:
        self.powered, sent, heard, protocol, stations, now, reserved = snapshot
        self.reserve(reserved)
        self.obey()
        self.send_on(sent)
        self.heard = deque(map(tuple, heard))
        self.protocol.restore(protocol)
        if self.drives is not None and stations is not None:
            self.drives.restore(stations, now)
        self.stirred()

    def __repr__(self) -> str:
        return f"<Port {self.number} {'programming' if self.reserved else self.settings.protocol}>"
