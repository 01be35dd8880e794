"""ECbus: PLCs that share D and M areas, each writing its own part (10.5).

The manual tells what is exchanged and not how. Here one station leads: it lets the stations speak in turn, each of which
then sends its part to all. Station 0 leads; when it falls silent the next one does, until it comes back. A station that did
not answer is asked once a round, one such station in each, so that it is found again soon.
"""

from ..hardware.serial import Port, Protocol
from ..values import signed16
from .checksums import crc16

POLL, PART = 0x50, 0x44  # "speak, station"; a station's part
PATIENCE_US = 5_000  # what a station may take to begin, over the silence behind the poll
SILENCE_US, RANK_US = 200_000, 50_000  # the bus is silent for so long before a station leads, and longer with each number
SILENT_CHARACTERS = 40  # at low baud rates
FLAGS = 4  # bytes of error flags in a poll


class Ecbus(Protocol):
    """One port on the bus."""

    def __init__(self, port: Port):
        super().__init__(port)
        self.heard, self.spoilt = bytearray(), False
        self.message_due: int | None = None
        self.known: tuple[int, int] | None = None  # refresh mode, stations: station 0 has them in its settings, the others hear them
        self.leads = False
        self.turn = -1  # the station that was last let speak
        self.looked = 0  # the station that was last looked for among the absent ones
        self.asked: int | None = None  # the station that has to answer
        self.tries = 0
        self.next_due: int | None = None  # when the leader goes on, or gives up waiting
        self.silence_due: int | None = None
        self.absent: list[int] = []

    @property
    def station(self) -> int:
        """The port's own number."""
        return self.port.register("station")

    @property
    def busy(self) -> bool:
        return self.port.sending or bool(self.heard) or self.asked is not None

    @property
    def due(self) -> int | None:
        if self.port.sending:
            return None
        if self.message_due is not None:
            return self.message_due
        return self.next_due if self.leads else self.silence_due

    def begin(self, now: int) -> None:
        """RUN has cleared the error flags; the bus itself goes on."""
        self._show()
        if self.silence_due is None:
            self._listen(now)

    def _listen(self, now: int) -> None:
        """Somebody speaks: nobody has to begin to lead."""
        self.silence_due = now + SILENCE_US + self.port.framing.after(SILENT_CHARACTERS) + RANK_US * self.station

    def _settings(self) -> tuple[int, int] | None:
        """Refresh mode and stations; station 0 may change its mode in a register (10.5.1)."""
        if self.station == 0:
            mode = self.port.register("refresh mode")
            area = self.port.memory.model.shared.get(mode)
            self.known = None if area is None else (mode, min(self.port.settings.stations, area.stations))
        return self.known

    # -- characters ---------------------------------------------------------------------------------------------

    def character(self, byte: int, wrong: bool, now: int) -> None:
        if self.port.deaf(now):
            return
        self.heard.append(byte)
        self.spoilt = self.spoilt or wrong
        self.message_due = now + self.port.framing.after(3.5)
        self._listen(now)

    def timeout(self, now: int) -> None:
        if self.message_due is not None:
            if self.message_due <= now:
                message, spoilt = bytes(self.heard), self.spoilt
                self.heard.clear()
                self.spoilt, self.message_due = False, None
                if not spoilt and len(message) > 4 and crc16(message) == 0:
                    self._read(message[:-2], now)
                if self.next_due is not None:
                    self.next_due = max(self.next_due, now)
            return
        if self.leads and self.next_due is not None and self.next_due <= now:
            if self.asked is not None:
                self._missing(now)
            else:
                self._go_on(now)
        elif not self.leads and self.silence_due is not None and self.silence_due <= now:
            self._listen(now)
            if self._settings() is not None:
                self.leads, self.turn, self.asked = True, -1, None
                self._go_on(now)

    def sent(self, now: int) -> None:
        self._listen(now)
        if self.leads:
            silence = self.port.framing.after(3.5)
            waits = 2 * silence + PATIENCE_US + self.port.framing.after(1) if self.asked is not None else silence
            self.next_due = now + waits + 1000 * self.port.register("timeout")

    def _send(self, message: bytes, now: int) -> None:
        self.next_due = None
        self.port.send(message + crc16(message).to_bytes(2, "little"), now)

    # -- leading ------------------------------------------------------------------------------------------------

    def _go_on(self, now: int) -> None:
        """Let the next station speak: those that answer in turn, then one that did not."""
        settings = self._settings()
        if settings is None:
            self.leads = False
            return
        _, stations = settings
        self.absent = [station for station in self.absent if station < stations]
        present = [station for station in range(stations) if station not in self.absent]
        following = [station for station in present if station > self.turn]
        if not following and self.absent and self.turn < stations:
            self.turn = stations  # the round is over but for one of the absent
            self.looked = next((station for station in self.absent if station > self.looked), self.absent[0])
            following = [self.looked]
        elif following:
            self.turn = following[0]
        else:
            following = present[:1] or self.absent[:1]
            self.turn = following[0]
        self.tries = 0
        self._ask(following[0], now)

    def _ask(self, station: int, now: int) -> None:
        self._show()
        if station == self.station:
            self.asked = None
            self._send(self._part(), now)
            return
        self.asked = station
        mode, stations = self.known
        flags = sum(1 << number for number in self.absent).to_bytes(FLAGS, "little")
        self._send(bytes((POLL, self.station, station, mode, stations)) + flags, now)

    def _missing(self, now: int) -> None:
        """The station that was asked is silent."""
        if self.tries < self.port.register("retries") and self.asked not in self.absent:
            self.tries += 1
            self._ask(self.asked, now)
            return
        if self.asked not in self.absent:
            self.absent = sorted([*self.absent, self.asked])
        self.asked = None
        self._go_on(now)

    def _yield(self) -> None:
        self.leads, self.asked, self.next_due = False, None, None

    # -- messages -----------------------------------------------------------------------------------------------

    def _read(self, message: bytes, now: int) -> None:
        if message[0] == POLL and len(message) == 5 + FLAGS:
            self._polled(message, now)
        elif message[0] == PART and len(message) > 4:
            self._take(message, now)

    def _polled(self, message: bytes, now: int) -> None:
        leader, station = message[1], message[2]
        if self.leads:
            if leader > self.station:
                return  # that one will give way when it hears this one
            self._yield()
        if self.station != 0:
            self.known = message[3], message[4]
        flags = int.from_bytes(message[5:], "little")
        self.absent = [number for number in range(8 * FLAGS) if flags >> number & 1 and number != self.station]
        self._show()
        if station == self.station and self._settings() is not None:
            self.leads = station == 0  # station 0 leads again as soon as it is asked
            self.turn, self.asked = station, None
            self._send(self._part(), now)

    def _take(self, message: bytes, now: int) -> None:
        """Another station's part: it becomes that station's part here."""
        sender, mode, leader = message[1:4]
        if self.leads and leader and sender < self.station:
            self._yield()
        if sender == self.station:
            return
        area = self.port.memory.model.shared.get(mode)
        content = message[4:]
        if area is not None and sender < area.stations and len(content) == 2 * area.words + area.bits // 8:
            lists = self.port.memory.lists
            first = area.first_word + sender * area.words
            words = [signed16(int.from_bytes(content[2 * place : 2 * place + 2])) for place in range(area.words)]
            lists["D"][first : first + area.words] = words
            bits, first = int.from_bytes(content[2 * area.words :], "little"), area.first_bit + sender * area.bits
            lists["M"][first : first + area.bits] = [bool(bits >> place & 1) for place in range(area.bits)]
            self.port.tell("received", True)
        if sender in self.absent:
            self.absent = [station for station in self.absent if station != sender]
            self._show()
        if self.leads and sender == self.asked:
            self.asked = None
            self.next_due = now + 1000 * self.port.register("timeout")

    def _part(self) -> bytes:
        """The station's own part of what is shared."""
        mode, _ = self.known
        area, lists, station = self.port.memory.model.shared[mode], self.port.memory.lists, self.station
        head = bytes((PART, station, mode, self.leads))
        if station >= area.stations:
            return head
        first = area.first_word + station * area.words
        words = b"".join((word & 0xFFFF).to_bytes(2) for word in lists["D"][first : first + area.words])
        first = area.first_bit + station * area.bits
        bits = sum(1 << place for place, bit in enumerate(lists["M"][first : first + area.bits]) if bit)
        return head + words + bits.to_bytes(area.bits // 8, "little")

    def _show(self) -> None:
        """The error flags of the stations (appendix 1.10)."""
        model = self.port.memory.model
        area = model.shared.get(self.known[0]) if self.known is not None else None
        if area is not None:
            relays = self.port.memory.lists[model.special_bits]
            for station in range(area.stations):
                relays[area.first_flag + station] = station in self.absent

    def snapshot(self) -> tuple:
        return (
            self.heard.hex(), self.spoilt, self.message_due, self.known, self.leads, self.turn, self.looked, self.asked, self.tries,
            self.next_due, self.silence_due, list(self.absent),
        )  # fmt: skip

    def restore(self, state: tuple) -> None:
        (
            heard, self.spoilt, self.message_due, known, self.leads, self.turn, self.looked, self.asked, self.tries,
            self.next_due, self.silence_due, absent,
        ) = state  # fmt: skip
        self.heard[:], self.absent = bytes.fromhex(heard), list(absent)
        self.known = None if known is None else tuple(known)
