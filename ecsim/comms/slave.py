"""The Modbus slave (10.4, appendix 7): what a request means to the devices, whichever line carries it."""

from collections import Counter
from collections.abc import Callable
from struct import unpack

from ..memory import Memory
from ..models import ModbusRange
from ..values import DINT, join, signed16, wrap
from .frames import MODES, BadFrame, Heard

ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_DATA = 1, 2, 3
BROADCAST = 0

# Sub-functions of 8 that give a count, and what they count (appendix 7, 3.6).
COUNTS = {11: "messages", 12: "garbled", 13: "exceptions", 14: "addressed", 15: "unanswered", 18: "overruns"}
RETURN_QUERY, RESTART, LISTEN_ONLY, CLEAR = 0, 1, 4, 10
RESTART_WORDS = (b"\0\0", b"\xff\0")
BROADCAST_DIAGNOSTICS = frozenset(sub.to_bytes(2) for sub in (RESTART, LISTEN_ONLY, CLEAR))
BROADCAST_FUNCTIONS = frozenset({5, 6, 8, 15, 16})
ON, OFF = 0xFF00, 0x0000


class Refusal(Exception):
    """An exception response with its code."""

    def __init__(self, code: int):
        super().__init__(code)
        self.code = code


class Slave:
    """One station of a line: answers messages from the devices of a memory, and keeps the line's diagnostic counters.

    A write goes to `write(name of the list, number of the first device, values)`; unless said otherwise that is `memory.receive`.
    """

    def __init__(self, memory: Memory, station: int = 1, write: Callable[[str, int, list], None] | None = None):
        self.memory, self.station = memory, station
        self._write = write or memory.receive
        self.most = memory.model.modbus_most
        self.counts: Counter[str] = Counter()
        self.listening = False  # listen-only mode: nothing is carried out, nothing answered
        self._functions: dict[int, Callable[[int, bytes], bytes]] = {
            1: self._read_bits,
            2: self._read_bits,
            3: self._read_words,
            5: self._write_bit,
            6: self._write_word,
            8: self._diagnose,
            15: self._write_bits,
            16: self._write_words,
        }

    def __repr__(self) -> str:
        return f"<Modbus slave {self.station}{', listening only' if self.listening else ''}>"

    # -- the line -----------------------------------------------------------------------------------------------

    def hear(self, heard: Heard, mode: str) -> bytes | None:
        """What a serial line has carried between two ends; the whole answering frame, None where the manual has none (10.4.12)."""
        if heard.overrun:
            self.counts["overruns"] += 1
            return None
        try:
            if heard.torn:
                raise BadFrame("a gap, a parity or a stop bit")
            station, message = MODES[mode].decode(heard.frame)
        except BadFrame:
            self.counts["garbled"] += 1
            return None
        reply = self.receive(station, message)
        return None if reply is None else MODES[mode].encode(station, reply)

    def receive(self, station: int, message: bytes) -> bytes | None:
        """A sound message for some station of the line; the answer, None where there is none."""
        self.counts["messages"] += 1
        if station not in (self.station, BROADCAST):
            return None
        return self.answer(message, broadcast=station == BROADCAST)

    def answer(self, message: bytes, broadcast: bool = False) -> bytes | None:
        """The answer to a message (function code and data) for this station, None where the manual has none."""
        counts = self.counts  # those that stood when it came: a message that clears them leaves them clear
        counts["addressed"] += 1
        silent = broadcast or self.listening
        reply = self._act(message, broadcast)
        if silent or self.listening:
            counts["unanswered"] += 1
            return None
        return reply

    def restart(self) -> None:
        """Power-up, and function 8 with 1: the counters begin at 0, listen-only mode ends."""
        self.counts, self.listening = Counter(), False

    def state(self) -> dict:
        """What changes while the slave works, as plain data."""
        return {"counts": dict(self.counts), "listening": self.listening}

    def restore(self, state: dict) -> None:
        """Go back to a `state`."""
        self.counts, self.listening = Counter(state["counts"]), state["listening"]

    # -- messages -----------------------------------------------------------------------------------------------

    def _act(self, message: bytes, broadcast: bool) -> bytes:
        """Carry a message out; the answer, an exception response where it is refused."""
        function, content = message[0] if message else 0, message[1:]
        if self.listening:  # only the restart is obeyed
            if function == 8 and content in (RESTART.to_bytes(2) + word for word in RESTART_WORDS):
                self.restart()
            return b""
        try:
            if function not in self._functions:
                raise Refusal(ILLEGAL_FUNCTION)
            if broadcast and not self._for_all(function, content):
                return b""
            return bytes((function,)) + self._functions[function](function, content)
        except Refusal as refusal:
            self.counts["exceptions"] += 1
            return bytes((function | 0x80, refusal.code))

    @staticmethod
    def _for_all(function: int, content: bytes) -> bool:
        """Whether a broadcast of that function is carried out (appendix 7, 5)."""
        return function in BROADCAST_FUNCTIONS and (function != 8 or content[:2] in BROADCAST_DIAGNOSTICS)

    def _range(self, function: int, address: int, count: int) -> tuple[ModbusRange, int]:
        """The run of addresses that holds `count` from `address` on, and the number of its first device; raises Refusal."""
        if not 1 <= count <= self.most.get(function, 1):
            raise Refusal(ILLEGAL_DATA)
        for run in self.memory.model.modbus:
            place, length = address - run.address, run.count * run.words
            if function in run.functions and 0 <= place < length:
                if count > length or count % run.words:
                    raise Refusal(ILLEGAL_DATA)
                if place + count > length or place % run.words:
                    raise Refusal(ILLEGAL_ADDRESS)
                return run, run.first + place // run.words
        raise Refusal(ILLEGAL_ADDRESS)

    def _read_bits(self, function: int, content: bytes) -> bytes:
        address, count = _two(content)
        run, first = self._range(function, address, count)
        bits = sum(1 << place for place, bit in enumerate(self.memory.send(run.name, first, count)) if bit)
        length = (count + 7) // 8
        return bytes((length,)) + bits.to_bytes(length, "little")

    def _read_words(self, function: int, content: bytes) -> bytes:
        address, count = _two(content)
        run, first = self._range(function, address, count)
        width = 2 * run.words
        values = self.memory.send(run.name, first, count // run.words)
        octets = [(value & (1 << 8 * width) - 1).to_bytes(width) for value in values]
        return bytes((2 * count,)) + b"".join(octets if self.memory.model.high_word_first else (each[-2:] + each[:-2] for each in octets))

    def _write_bit(self, function: int, content: bytes) -> bytes:
        address, value = _two(content)
        if value not in (ON, OFF):
            raise Refusal(ILLEGAL_DATA)
        run, number = self._range(function, address, 1)
        self._write(run.name, number, [value == ON])
        return content

    def _write_word(self, function: int, content: bytes) -> bytes:
        address, value = _two(content)
        run, number = self._range(function, address, 1)
        self._write(run.name, number, [signed16(value)])
        return content

    def _write_bits(self, function: int, content: bytes) -> bytes:
        address, count, octets = _several(content)
        run, first = self._range(function, address, count)
        if len(octets) != (count + 7) // 8:
            raise Refusal(ILLEGAL_DATA)
        bits = int.from_bytes(octets, "little")
        self._write(run.name, first, [bool(bits >> place & 1) for place in range(count)])
        return content[:4]

    def _write_words(self, function: int, content: bytes) -> bytes:
        address, count, octets = _several(content)
        run, first = self._range(function, address, count)
        if len(octets) != 2 * count:
            raise Refusal(ILLEGAL_DATA)
        words = unpack(f">{count}h", octets)
        if run.words == 2:
            pairs = zip(words[::2], words[1::2], strict=True)
            words = [wrap(join(*(pair if self.memory.model.high_word_first else pair[::-1])), DINT) for pair in pairs]
        self._write(run.name, first, list(words))
        return content[:4]

    def _diagnose(self, function: int, content: bytes) -> bytes:
        if len(content) < 4:
            raise Refusal(ILLEGAL_DATA)
        sub, word = int.from_bytes(content[:2]), content[2:]
        if sub == RETURN_QUERY:
            return content
        if sub not in (RESTART, LISTEN_ONLY, CLEAR, *COUNTS):
            raise Refusal(ILLEGAL_FUNCTION)
        if word not in (RESTART_WORDS if sub == RESTART else RESTART_WORDS[:1]):
            raise Refusal(ILLEGAL_DATA)
        if sub in COUNTS:
            return content[:2] + (self.counts[COUNTS[sub]] & 0xFFFF).to_bytes(2)
        if sub == LISTEN_ONLY:
            self.listening = True
        else:
            self.restart()
        return content


def _two(content: bytes) -> tuple[int, int]:
    """The two words that a request consists of."""
    if len(content) != 4:
        raise Refusal(ILLEGAL_DATA)
    return unpack(">HH", content)


def _several(content: bytes) -> tuple[int, int, bytes]:
    """Address, count and values of a request that writes several; the number of octets must be right."""
    if len(content) < 5 or content[4] != len(content) - 5:
        raise Refusal(ILLEGAL_DATA)
    return (*unpack(">HH", content[:4]), content[5:])
