"""Modbus frames (10.4.3, 10.4.4): a station and its message to octets and back, in RTU and ASCII, and over TCP.

A message (PDU) is a function code and its data. Gaps between characters are the line's affair: `Receiver` puts characters
together to frames by the times at which they came.
"""

from collections.abc import Callable
from dataclasses import dataclass

from .checksums import crc16, lrc

RTU_LONGEST, ASCII_LONGEST = 256, 513  # characters of a frame
TCP_HEADER, TCP_LONGEST = 7, 260


class BadFrame(ValueError):
    """Characters that are no frame: too few, a wrong checksum, a character or an end that is none."""


def rtu_encode(station: int, message: bytes) -> bytes:
    """The frame of a message: station, message, CRC with its low byte first."""
    frame = bytes((station,)) + message
    return frame + crc16(frame).to_bytes(2, "little")


def rtu_decode(frame: bytes) -> tuple[int, bytes]:
    """Station and message of a frame; raises BadFrame."""
    if len(frame) < 4:
        raise BadFrame("an RTU frame has four characters or more")
    if crc16(frame[:-2]) != int.from_bytes(frame[-2:], "little"):
        raise BadFrame("the CRC is wrong")
    return frame[0], bytes(frame[1:-2])


_REQUESTS = {1: 8, 2: 8, 3: 8, 5: 8, 6: 8, 8: 8}  # function -> characters of its RTU request


def rtu_request(frame: bytes) -> bool:
    """Whether the characters are just one sound request of a known function, so that a slave need not wait for the silence behind it."""
    length = len(frame)
    if length < 8:
        return False
    expected = 9 + frame[6] if frame[1] in (15, 16) else _REQUESTS.get(frame[1])
    return length == expected and crc16(frame) == 0  # the CRC of a frame with its CRC


def ascii_encode(station: int, message: bytes) -> bytes:
    """The frame of a message: a colon, station, message and LRC as hexadecimal digits, CR LF."""
    frame = bytes((station,)) + message
    return b":" + (frame + bytes((lrc(frame),))).hex().upper().encode() + b"\r\n"


_DIGITS = frozenset(b"0123456789ABCDEF")  # as the protocol's characters are; small letters are none


def ascii_decode(frame: bytes) -> tuple[int, bytes]:
    """Station and message of a frame; raises BadFrame."""
    if not (frame.startswith(b":") and frame.endswith(b"\r\n")):
        raise BadFrame("an ASCII frame begins with a colon and ends with CR LF")
    digits = bytes(frame[1:-2])
    if len(digits) < 6 or len(digits) % 2 or not _DIGITS.issuperset(digits):
        raise BadFrame("an ASCII frame has pairs of hexadecimal digits, three or more")
    octets = bytes.fromhex(digits.decode())
    if lrc(octets):
        raise BadFrame("the LRC is wrong")
    return octets[0], octets[1:-1]


def tcp_encode(transaction: int, station: int, message: bytes) -> bytes:
    """The frame of a message over TCP: transaction, protocol 0, length, station, message."""
    return transaction.to_bytes(2) + b"\0\0" + (len(message) + 1).to_bytes(2) + bytes((station,)) + message


def tcp_length(octets: bytes) -> int:
    """How long the frame is that begins here, 0 while that cannot be told; raises BadFrame where none can begin."""
    if len(octets) < 6:
        return 0
    length = 6 + int.from_bytes(octets[4:6])
    if octets[2:4] != b"\0\0" or not TCP_HEADER < length <= TCP_LONGEST:
        raise BadFrame("no Modbus header: the protocol is 0, the length 2 to 254")
    return length


def tcp_decode(frame: bytes) -> tuple[int, int, bytes]:
    """Transaction, station and message of a whole frame."""
    return int.from_bytes(frame[:2]), frame[6], bytes(frame[7:])


@dataclass(frozen=True, slots=True)
class Mode:
    """One of the two ways to write frames on a serial line."""

    name: str
    longest: int
    encode: Callable[[int, bytes], bytes]
    decode: Callable[[bytes], tuple[int, bytes]]


MODES = {
    mode.name: mode for mode in (Mode("rtu", RTU_LONGEST, rtu_encode, rtu_decode), Mode("ascii", ASCII_LONGEST, ascii_encode, ascii_decode))
}

ASCII_GAP_US = 1_000_000  # 10.4.4


@dataclass(frozen=True, slots=True)
class Heard:
    """What a line has carried between two ends: its characters, whether a gap tore it, whether it was too long."""

    frame: bytes
    torn: bool = False
    overrun: bool = False


class Receiver:
    """Puts characters together to frames by the times at which they end, in microseconds.

    In RTU mode a frame ends with a silence of 3.5 characters and a gap of more than 1.5 tears it; `gap_us` and `silence_us`
    replace both where a line's times are not those of its characters. In ASCII mode a frame begins with a colon and ends
    with LF; a gap of more than a second tears it.
    """

    def __init__(self, mode: Mode, character_us: float, gap_us: float | None = None, silence_us: float | None = None):
        self.mode = mode
        rtu = mode.name == "rtu"
        self.gap_us = (1.5 * character_us if rtu else ASCII_GAP_US) if gap_us is None else gap_us
        self.silence_us = (3.5 * character_us if rtu else ASCII_GAP_US) if silence_us is None else silence_us
        self.character_us = character_us
        self.octets = bytearray()
        self.last: float | None = None
        self.torn = self.overrun = False

    @property
    def due(self) -> float | None:
        """The moment at which silence ends what has come so far, None while nothing has."""
        return None if self.last is None else self.last + self.silence_us

    def hear(self, octet: int, now: float, garbled: bool = False) -> Heard | None:
        """A character ends at `now`; `garbled` when its parity or stop bit was wrong. Gives a frame that ends with it (ASCII)."""
        late = self.last is not None and now - self.last > self.gap_us + self.character_us
        if self.mode.name == "ascii":
            return self._hear_ascii(octet, now, garbled, late)
        self.torn |= late or garbled
        self._keep(octet, now)
        return None

    def _hear_ascii(self, octet: int, now: float, garbled: bool, late: bool) -> Heard | None:
        if octet == 0x3A:
            broken = self.end() if self.octets else None
            self.torn = garbled
            self._keep(octet, now)
            return broken and Heard(broken.frame, torn=True, overrun=broken.overrun)
        if not self.octets:
            return None  # between frames
        self.torn |= late or garbled
        self._keep(octet, now)
        return self.end() if octet == 0x0A else None

    def _keep(self, octet: int, now: float) -> None:
        self.last = now
        if len(self.octets) < self.mode.longest:
            self.octets.append(octet)
        else:
            self.overrun = True

    def end(self) -> Heard:
        """What has come so far, as a frame: silence has ended it."""
        heard = Heard(bytes(self.octets), self.torn, self.overrun)
        self.octets.clear()
        self.last, self.torn, self.overrun = None, False, False
        return heard
