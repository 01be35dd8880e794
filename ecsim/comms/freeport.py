"""Freeport: the program itself sends and receives characters, with XMT and RCV (10.3, 6.12.11, 6.12.12).

Sending and receiving are two tasks that may go on at once; each is begun by its instruction and goes on without flow. The
relays "sending" and "receiving" are ON meanwhile, and the program breaks a task off by turning its relay OFF.
"""

from ..hardware.serial import Port, Protocol

# The register of completion: what ended a reception.
USER, END, FULL, GAP, FRAME, PARITY = (1 << place for place in range(6))


class Freeport(Protocol):
    """XMT and RCV on one port."""

    fires = True

    def __init__(self, port: Port):
        super().__init__(port)
        self._drop()
        self.transmitting = False

    def _drop(self) -> None:
        self.area, self.first = "", 0  # where the characters go, "" while nothing is to be received
        self.most = self.count = 0
        self.begun = False  # the start character has come
        self.gap_due: int | None = None
        self.frame_due: int | None = None

    @property
    def receiving(self) -> bool:
        """Whether an RCV is at work."""
        return self.area != ""

    @property
    def busy(self) -> bool:
        return self.transmitting or self.receiving

    @property
    def due(self) -> int | None:
        return min((moment for moment in (self.gap_due, self.frame_due) if moment is not None), default=None)

    def begin(self, now: int) -> None:
        """6.12.11 and 6.12.12: STOP breaks both off."""
        self._drop()
        self._stop_sending(now)
        self.port.tell("receiving", False)

    # -- XMT ----------------------------------------------------------------------------------------------------

    def transmit(self, text: bytes, now: int) -> None:
        """Send characters, unless some are being sent."""
        if not self.transmitting:
            self.transmitting = True
            self.port.tell("sending", True)
            self.port.send(text, now)

    def _stop_sending(self, now: int) -> None:
        self.transmitting = False
        self.port.tell("sending", False)
        self.port.send(b"", now)

    def sent(self, now: int) -> None:
        self.transmitting = False
        self.port.tell("sending", False)
        self.port.fire("frame sent")

    # -- RCV ----------------------------------------------------------------------------------------------------

    def receive(self, area: str, first: int, most: int, now: int) -> None:
        """Receive up to `most` characters into the low bytes of registers from number `first` on, unless a reception goes on."""
        if self.receiving:
            return
        self._drop()
        self.area, self.first, self.most = area, first, most
        self.begun = self.port.settings.start_char is None
        limit = self.port.register("frame timeout")
        self.frame_due = now + 1000 * limit if limit else None
        self.port.put("completion", 0)
        self.port.put("characters", 0)
        self.port.tell("receiving", True)
        self.port.stirred()

    def character(self, byte: int, wrong: bool, now: int) -> None:
        if not self.receiving:
            return
        starts = not self.begun
        if starts and (wrong or byte != self.port.register("start character") & 0xFF):
            return
        if wrong:
            self._end(PARITY)
            return
        self.begun = True
        self.port.memory.lists[self.area][self.first + self.count] = byte
        self.count += 1
        self.port.put("character", byte)
        self.port.put("characters", self.count)
        self.port.fire("character received")
        ends = self.port.settings.end_char is not None and byte == self.port.register("end character") & 0xFF
        code = (END if ends and not starts else 0) | (FULL if self.count >= self.most else 0)
        limit = self.port.register("gap timeout")
        self.gap_due = now + 1000 * limit if limit else None
        if code:
            self._end(code)

    def timeout(self, now: int) -> None:
        self._end((GAP if self.gap_due is not None and self.gap_due <= now else 0) | (FRAME if self.frame_due == now else 0))

    def _end(self, code: int) -> None:
        self._drop()
        self.port.put("completion", code)
        self.port.tell("receiving", False)
        if code != USER:
            self.port.tell("received", True)
            self.port.fire("frame received")

    # -- both ---------------------------------------------------------------------------------------------------

    def look(self, now: int) -> None:
        if self.transmitting and not self.port.on("sending"):
            self._stop_sending(now)
        if self.receiving and not self.port.on("receiving"):
            self._end(USER)

    def snapshot(self) -> tuple:
        return self.transmitting, self.area, self.first, self.most, self.count, self.begun, self.gap_due, self.frame_due

    def restore(self, state: tuple) -> None:
        self.transmitting, self.area, self.first, self.most, self.count, self.begun, self.gap_due, self.frame_due = state
