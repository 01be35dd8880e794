"""The Modbus master of a port (6.12.1, 10.4.14): one request at a time, its answer, time-outs and retries.

Requests of MODBUS and of the inverter instructions go the same way. They differ in where the answer is stored and in how a
frame that cannot be read is reported (appendices 4 and 5).
"""

from math import ceil

from ..hardware.serial import Port, Protocol
from ..values import signed16
from .frames import MODES, BadFrame, Heard, Receiver

# Appendix 4; the codes of the inverter's own answers are in appendix 5.
ILLEGAL_FUNCTION, TIMEOUT, BAD_FRAME, WRONG_SETTING, OWN_STATION, NO_ROOM = 0x01, 0x10, 0x11, 0x12, 0x13, 0x14
INVERTER_BAD_FRAME = 0x18
BROADCAST = 0
EXCEPTION = 0x80

FRAME, WORD = "frame", "word"  # what of an answer is stored: all of it, a byte a register; the one register that was read
READS_BITS, READS_WORDS, WRITES_SEVERAL, FIXED = (1, 2), (3,), (15, 16), (1, 2, 3, 5, 6, 8)


def request_length(request: bytes) -> int:
    """How many bytes a request has that begins so, station and function included; 0 for a function that is none of 10.4.5."""
    function = request[1]
    if function in FIXED:
        return 6
    return 7 + request[6] if function in WRITES_SEVERAL else 0


def answer_length(request: bytes) -> int:
    """How many bytes its answer has, station and function included."""
    function, count = request[1], int.from_bytes(request[4:6])
    if function in READS_BITS:
        return 3 + (count + 7) // 8
    return 3 + 2 * count if function in READS_WORDS else 6


class Master(Protocol):
    """The port sends what MODBUS and the inverter instructions ask for."""

    def __init__(self, port: Port):
        super().__init__(port)
        self.mode = MODES[port.settings.mode]
        self.receiver = Receiver(self.mode, port.framing.bits * 1e6 / port.framing.baud)
        self._drop()

    def _drop(self) -> None:
        self.request = b""  # empty while no exchange goes on
        self.stores, self.area, self.first = "", "", 0  # what is stored, and where
        self.inverter = False
        self.tries = 0  # left
        self.deadline: int | None = None

    @property
    def busy(self) -> bool:
        return bool(self.request)

    @property
    def due(self) -> int | None:
        if self.receiver.due is not None:
            return ceil(self.receiver.due)
        return self.deadline

    def begin(self, now: int) -> None:
        if self.busy:
            self._drop()
            self.port.send(b"", now)
        self.receiver.end()

    def exchange(self, request: bytes, stores: str, area: str, first: int, now: int, inverter: bool = False) -> bool:
        """Send a request (station and message) and store what its answer brings; False while another exchange goes on."""
        if self.busy:
            return False
        report(self.port, 0, done=False)
        if request[0] == self.port.register("station"):
            report(self.port, OWN_STATION)
            return True
        self.request, self.stores, self.area, self.first, self.inverter = request, stores, area, first, inverter
        self.tries = self.port.register("retries")
        self._send(now)
        return True

    def _send(self, now: int) -> None:
        self.deadline = None
        self.receiver.end()
        self.port.send(self.mode.encode(self.request[0], self.request[1:]), now)

    def sent(self, now: int) -> None:
        if self.request and self.request[0] == BROADCAST:
            self._finish(0)
        elif self.request:
            self.deadline = now + 1000 * self.port.register("timeout")

    def character(self, byte: int, wrong: bool, now: int) -> None:
        if self.deadline is None or self.port.deaf(now):
            return
        heard = self.receiver.hear(byte, now, wrong)
        if heard is not None:
            self._read(heard, now)

    def timeout(self, now: int) -> None:
        if self.receiver.due is not None:
            self._read(self.receiver.end(), now)
        else:
            self._again(TIMEOUT, now)

    def _again(self, code: int, now: int) -> None:
        """The exchange has failed: once more, or it ends so."""
        if self.tries:
            self.tries -= 1
            self._send(now)
        else:
            self._finish(code)

    def _read(self, heard: Heard, now: int) -> None:
        """The answer has come: checksum, station and function are checked (6.12.1)."""
        bad = INVERTER_BAD_FRAME if self.inverter else BAD_FRAME
        try:
            if heard.torn or heard.overrun:
                raise BadFrame("a gap, a parity or a stop bit")
            station, message = self.mode.decode(heard.frame)
        except BadFrame:
            self._again(bad, now)
            return
        function = self.request[1]
        if station == self.request[0] and message[0] == function | EXCEPTION and len(message) == 2:
            self._finish(message[1])
        elif station != self.request[0] or message[0] != function or 1 + len(message) != answer_length(self.request):
            self._again(bad, now)
        else:
            self._finish(self._store(bytes((station,)) + message))

    def _store(self, answer: bytes) -> int:
        """Put the answer where it belongs; the error code, 0 without one."""
        memory = self.port.memory
        if self.inverter:
            area, first, _ = memory.model.buffers["inverter answer"]
            memory.lists[area][first : first + len(answer)] = answer
        values = list(answer) if self.stores == FRAME else [signed16(int.from_bytes(answer[3:5]))] if self.stores == WORD else []
        if self.first + len(values) > memory.model.areas[self.area or "D"].count:
            return NO_ROOM
        if values:
            memory.lists[self.area][self.first : self.first + len(values)] = values
        self.port.tell("received", True)
        return 0

    def _finish(self, code: int) -> None:
        self._drop()
        report(self.port, code)

    def snapshot(self) -> tuple:
        receiver = self.receiver
        heard = receiver.octets.hex(), receiver.last, receiver.torn, receiver.overrun
        return self.request.hex(), self.stores, self.area, self.first, self.inverter, self.tries, self.deadline, heard

    def restore(self, state: tuple) -> None:
        request, self.stores, self.area, self.first, self.inverter, self.tries, self.deadline, heard = state
        self.request = bytes.fromhex(request)
        octets, self.receiver.last, self.receiver.torn, self.receiver.overrun = heard
        self.receiver.octets[:] = bytes.fromhex(octets)


def report(port: Port, code: int, done: bool = True) -> None:
    """Tell the program how an exchange ended; with `done` False that one begins."""
    memory = port.memory
    model = memory.model
    relays = memory.lists[model.special_bits]
    relays[model.relays["exchange done"]] = done
    relays[model.relays["exchange failed"]] = code != 0
    memory.lists[model.special_words][model.registers["exchange error"]] = code
