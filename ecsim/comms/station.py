"""A port as Modbus slave: the characters of the line become frames, the slave answers them in the communication phase of a scan."""

from math import ceil

from ..hardware.serial import Port, Protocol
from .frames import MODES, Heard, Receiver
from .slave import Slave


class SlaveStation(Protocol):
    """10.4.7: it speaks only when it was asked, in RUN and in STOP."""

    def __init__(self, port: Port):
        super().__init__(port)
        self.mode = MODES[port.settings.mode]
        self.receiver = Receiver(self.mode, port.framing.bits * 1e6 / port.framing.baud)
        self.slave = Slave(port.memory, port.settings.station)
        self.waiting: list[Heard] = []

    @property
    def busy(self) -> bool:
        return self.receiver.due is not None or bool(self.waiting) or self.port.sending

    @property
    def due(self) -> int | None:
        return None if self.receiver.due is None else ceil(self.receiver.due)

    def character(self, byte: int, wrong: bool, now: int) -> None:
        if self.port.deaf(now):
            return
        heard = self.receiver.hear(byte, now, wrong)
        if heard is not None:
            self.waiting.append(heard)

    def timeout(self, now: int) -> None:
        self.waiting.append(self.receiver.end())

    def serve(self, now: int) -> None:
        waiting, self.waiting = self.waiting, []
        if "station" in self.port.map.registers:
            self.slave.station = self.port.register("station")
        for heard in waiting:
            addressed = self.slave.counts["addressed"]
            answer = self.slave.hear(heard, self.mode.name)
            if self.slave.counts["addressed"] != addressed:
                self.port.tell("received", True)
            if answer is not None:
                self.port.send(answer, now)

    def snapshot(self) -> tuple:
        receiver = self.receiver
        heard = receiver.octets.hex(), receiver.last, receiver.torn, receiver.overrun
        return self.slave.state(), [(each.frame.hex(), each.torn, each.overrun) for each in self.waiting], heard

    def restore(self, state: tuple) -> None:
        slave, waiting, heard = state
        self.slave.restore(slave)
        self.waiting = [Heard(bytes.fromhex(frame), torn, overrun) for frame, torn, overrun in waiting]
        octets, self.receiver.last, self.receiver.torn, self.receiver.overrun = heard
        self.receiver.octets[:] = bytes.fromhex(octets)
