"""The free protocol of H1U and H2U (FNC 80): one instruction sends what it is asked for and receives meanwhile.

While RS is driven the port listens. "send request" turned ON by the program sends the characters; it goes OFF behind the last.
"received" goes ON when a message is complete, and until the program turns it OFF nothing more is received. In 8-bit mode
("bytewise") a register holds one character in its low byte, otherwise two, the low byte first.
"""

from dataclasses import dataclass
from typing import Any

from ..devices import Device
from ..hardware.serial import Port, Protocol

USUAL_TENS = 10  # of ms without a character that end a message where the register says 0


@dataclass(frozen=True, slots=True)
class Task:
    """A driven RS: what it sends and where it puts what it receives, and how many characters of each at most."""

    source: Device
    length: int
    target: Device
    room: int


class Rs(Protocol):
    """RS on one port."""

    def __init__(self, port: Port):
        super().__init__(port)
        self.tasks: dict[int, Task] = {}  # by claim; the first one has the port
        self.transmitting = False
        self._listen()

    def _listen(self) -> None:
        self.count = 0
        self.begun = self.port.settings.start_char is None
        self.due: int | None = None

    @property
    def busy(self) -> bool:
        return bool(self.tasks) or self.transmitting

    @property
    def _task(self) -> Task | None:
        return next(iter(self.tasks.values()), None)

    @property
    def _bytewise(self) -> bool:
        model = self.port.memory.model
        return self.port.memory.lists[model.special_bits][model.relays["bytewise"]]

    def begin(self, now: int) -> None:
        self.tasks.clear()
        if self.transmitting:
            self.transmitting = False
            self.port.send(b"", now)
        self._listen()

    # -- the instruction ----------------------------------------------------------------------------------------

    def drive(self, claim: int, task: Task) -> None:
        """RS has flow; of several the first one that had it works."""
        if claim not in self.tasks and not self.tasks:
            self._listen()
            self.port.put("characters", 0)
        self.tasks[claim] = task
        self.port.stirred()

    def release(self, claim: int, now: int) -> None:
        if self.tasks.pop(claim, None) is not None and not self.tasks:
            self._listen()
            self.port.stirred()

    # -- sending ------------------------------------------------------------------------------------------------

    def look(self, now: int) -> None:
        task = self._task
        if task is not None and not self.transmitting and self.port.on("send request"):
            self.transmitting = True
            text = self._enclosed(self._text(task))
            self.port.put("to send", len(text))
            self.port.send(text, now)
            if not text:
                self.sent(now)

    def _text(self, task: Task) -> bytes:
        """The characters to be sent, as they stand in the registers now."""
        bytewise = self._bytewise
        words = self.port.memory.lists[task.source.area][task.source.number :][: task.length if bytewise else (task.length + 1) // 2]
        octets = bytes(word & 0xFF for word in words) if bytewise else b"".join((word & 0xFFFF).to_bytes(2, "little") for word in words)
        return octets[: task.length]

    def _enclosed(self, text: bytes) -> bytes:
        """With the header before it and the terminator behind it that the format asks for."""
        settings = self.port.settings
        before = bytes((self.port.register("start character") & 0xFF,)) if settings.start_char is not None else b""
        behind = bytes((self.port.register("end character") & 0xFF,)) if settings.end_char is not None else b""
        return before + text + behind if text else b""

    def sent(self, now: int) -> None:
        self.transmitting = False
        self.port.put("to send", 0)
        self.port.tell("send request", False)

    # -- receiving ----------------------------------------------------------------------------------------------

    def character(self, byte: int, wrong: bool, now: int) -> None:
        task = self._task
        if task is None or self.port.on("received") or self.port.deaf(now) or wrong:
            return
        if not self.begun:
            self.begun = byte == self.port.register("start character") & 0xFF
            return
        if self.port.settings.end_char is not None and byte == self.port.register("end character") & 0xFF:
            self._complete()
            return
        if self.count < task.room:
            self._store(task, byte)
        self.due = now + 10_000 * (self.port.register("tens of ms") or USUAL_TENS)
        if self.count >= task.room and self.port.settings.end_char is None:
            self._complete()

    def _store(self, task: Task, byte: int) -> None:
        """The next character goes into its register; the other byte of that keeps what it is."""
        registers = self.port.memory.lists[task.target.area]
        if self._bytewise:
            registers[task.target.number + self.count] = byte
        else:
            place = task.target.number + self.count // 2
            word = registers[place] & 0xFFFF
            word = word & 0xFF | byte << 8 if self.count % 2 else word & 0xFF00 | byte
            registers[place] = word - 0x10000 if word & 0x8000 else word
        self.count += 1
        self.port.put("characters", self.count)

    def timeout(self, now: int) -> None:
        self.port.tell("timed out", True)
        self._complete()

    def _complete(self) -> None:
        self.port.put("characters", self.count)
        self.port.tell("received", True)
        self._listen()

    # -- state --------------------------------------------------------------------------------------------------

    def snapshot(self) -> Any:
        tasks = [
            (claim, (t.source.area, t.source.number), t.length, (t.target.area, t.target.number), t.room) for claim, t in self.tasks.items()
        ]
        return tasks, self.transmitting, self.count, self.begun, self.due

    def restore(self, state: Any) -> None:
        tasks, self.transmitting, self.count, self.begun, self.due = state
        self.tasks = {claim: Task(Device(*source), length, Device(*target), room) for claim, source, length, target, room in tasks}
