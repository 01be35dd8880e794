"""ABS: the conversation with a servo amplifier that tells its absolute position (6.17.11).

The machine turns ON "servo on" and "transfer"; the amplifier answers with "ready". Then, nineteen times: the machine turns
ON "request", the amplifier puts two bits on its data lines and turns "ready" OFF, the machine takes the bits and turns
"request" OFF, the amplifier turns "ready" ON. Sixteen pairs are the position, lowest first; three are the sum of these
pairs. Each side looks at the other's lines once a scan.
"""

from dataclasses import dataclass, replace

from ..devices import Bits, Device
from ..errors import SERVO_CHECKSUM, SERVO_SILENT, Fault
from ..memory import Memory
from ..values import DINT, wrap
from .unit import Unit

PAIRS, CHECK_PAIRS = 16, 3
PATIENCE_US = 5_000_000
BIT0, BIT1, READY = range(3)
SERVO_ON, TRANSFER, REQUEST = range(3)


@dataclass(frozen=True, slots=True)
class Reading:
    """One driven ABS: where it stands. `phase` is "begin", "offer", "answer" or "over"."""

    target: Device
    since: int
    phase: str = "begin"
    pairs: tuple[int, ...] = ()
    fault: int = 0


def check_sum(pairs: tuple[int, ...]) -> int:
    """The six bits that are sent behind the position."""
    return sum(pairs) & 0x3F


class ServoReader(Unit):
    """All driven ABS instructions."""

    def __init__(self, memory: Memory, awake: list[Unit]):
        super().__init__(awake)
        self.memory = memory
        self.readings: dict[int, Reading] = {}

    def read(self, claim: int, source: Device, target: Device, position: Device | Bits, now: int) -> None:
        """One scan of the conversation; raises Fault(79) when the amplifier does not answer, Fault(80) when the sum is wrong."""
        reading = self.readings.get(claim) or Reading(target, now)
        if reading.fault:
            raise Fault(reading.fault)
        lines = self.memory.bits(source.area)[source.number : source.number + 3]
        following = self._step(reading, lines, now)
        if following.phase != "over" and now - following.since > PATIENCE_US:
            following = replace(following, phase="over", fault=SERVO_SILENT)
        if following.phase == "over" and reading.phase != "over" and not following.fault:
            following = self._finish(following, position)
        self.readings[claim] = following
        outputs = self.memory.bits(target.area)
        asking = following.phase == "answer"
        outputs[target.number : target.number + 3] = True, following.phase != "over", asking
        if following.fault:
            raise Fault(following.fault)

    @staticmethod
    def _step(reading: Reading, lines: list[bool], now: int) -> Reading:
        if reading.phase in ("begin", "offer") and lines[READY]:
            if len(reading.pairs) == PAIRS + CHECK_PAIRS:
                return replace(reading, phase="over")
            return replace(reading, phase="answer", since=now)
        if reading.phase == "answer" and not lines[READY]:
            pair = lines[BIT0] | lines[BIT1] << 1
            return replace(reading, phase="offer", since=now, pairs=(*reading.pairs, pair))
        return reading

    def _finish(self, reading: Reading, position: Device | Bits) -> Reading:
        data, check = reading.pairs[:PAIRS], reading.pairs[PAIRS:]
        if check_sum(data) != sum(pair << 2 * place for place, pair in enumerate(check)):
            return replace(reading, fault=SERVO_CHECKSUM)
        self.memory.set(position, DINT, wrap(sum(pair << 2 * place for place, pair in enumerate(data)), DINT))
        return reading

    def release(self, claim: int, now: int) -> None:
        """Without flow the servo goes OFF (6.17.11, rule 3)."""
        reading = self.readings.pop(claim, None)
        if reading is not None:
            outputs = self.memory.bits(reading.target.area)
            outputs[reading.target.number : reading.target.number + 3] = False, False, False

    def restart(self, now: int) -> None:
        self.readings.clear()

    def snapshot(self) -> dict:
        return dict(self.readings)

    def restore(self, snapshot: dict) -> None:
        self.readings = dict(snapshot)
