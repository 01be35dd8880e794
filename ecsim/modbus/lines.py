"""The only module that knows pymodbus: its transports carry the octets of TCP connections and serial ports.

What the octets mean is decided here by `ecsim.comms`, not by pymodbus' server: that one neither counts bad frames nor keeps
silent, and loses requests that come close together. Of its transports only what has kept its name since 3.11 is used.
"""

import asyncio
import os
from contextlib import AbstractContextManager

from pymodbus.transport import CommParams, CommType, ModbusProtocol

from ..comms.frames import MODES, BadFrame, Heard, Receiver, rtu_request, tcp_decode, tcp_encode, tcp_length
from ..comms.slave import Slave
from ..hardware.serial import PortSettings

BURST = 16  # so many requests of one client in a row, then the others get their turn
REST_S = 0.001
MOST_CLIENTS = 128
WHOLE_UNITS = frozenset({0, 255})  # unit numbers over TCP that mean whoever is there
SILENCE_US = 20_000  # an operating system hands characters over in lumps, so shorter silences cannot be told
REOPEN_S = 1.0
MOST_WAITING = 16_384  # octets of answers that a serial port has not yet taken; more are lost, as on a wire
PSEUDO_TERMINALS = ("/dev/pts/", "/dev/ttys")  # they have no wire: their characters have eight bits and no parity
PARITIES = {"none": "N", "odd": "O", "even": "E"}


class _Quiet(ModbusProtocol):
    """A protocol that has nothing to do when it is connected or not, and is the one end of its connection."""

    def callback_new_connection(self) -> ModbusProtocol:
        return self

    def callback_connected(self) -> None:
        pass

    def callback_disconnected(self, exc: Exception | None) -> None:
        pass

    def callback_data(self, data: bytes, addr: tuple | None = None) -> int:
        return len(data)


class _Line(_Quiet):
    """What listens. `lock` holds the PLC between two scans; `open` raises OSError where it cannot, RuntimeError without pyserial."""

    def __init__(self, params: CommParams, slave: Slave, lock: AbstractContextManager):
        super().__init__(params, True)
        self.slave, self.lock = slave, lock

    async def open(self) -> None:
        self.is_listener = True
        made = await self.call_create()
        self.transport = made[0] if isinstance(made, tuple) else made


class TcpLine(_Line):
    """A TCP port with any number of clients."""

    def __init__(self, host: str, port: int, slave: Slave, lock: AbstractContextManager):
        super().__init__(CommParams(comm_name="ecsim", comm_type=CommType.TCP, source_address=(host, port)), slave, lock)

    @property
    def address(self) -> tuple[str, int]:
        """Where it listens."""
        return self.transport.sockets[0].getsockname()[:2]

    @property
    def name(self) -> str:
        return "tcp {}:{}".format(*self.address)

    def callback_new_connection(self) -> ModbusProtocol:
        return _Client(self)

    def shut(self) -> None:
        for client in list(self.active_connections.values()):
            client.abort()
        self.close()


class _Client(_Quiet):
    """One client of a TCP port."""

    def __init__(self, line: TcpLine):
        super().__init__(line.comm_params, False)
        self.line = line
        self.octets = bytearray()
        self.resting = self.full = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        if len(self.line.active_connections) > MOST_CLIENTS:
            self.abort()

    def abort(self) -> None:
        if self.transport is not None:
            self.transport.abort()

    def data_received(self, data: bytes) -> None:
        self.octets += data
        if not self.resting and not self.full:
            self._answer()

    def pause_writing(self) -> None:
        """The client does not take its answers: it gets no more until it does."""
        self.full = True
        self._hold(True)

    def resume_writing(self) -> None:
        self.full = False
        if not self.resting:
            self._answer()

    def _hold(self, on: bool) -> None:
        if self.transport is not None and not self.transport.is_closing() and self.transport.is_reading() is on:
            (self.transport.pause_reading if on else self.transport.resume_reading)()

    def _answer(self) -> None:
        """Answer what has come, up to a burst of requests."""
        self.resting = False
        for _ in range(BURST):
            if self.transport is None or self.full:
                return
            try:
                length = tcp_length(self.octets)
            except BadFrame:
                self.line.slave.counts["garbled"] += 1
                self.abort()  # nobody can tell where the next frame begins
                return
            if not length or len(self.octets) < length:
                self._hold(False)
                return
            frame = bytes(self.octets[:length])
            del self.octets[:length]
            self._one(*tcp_decode(frame))
        self.resting = True
        self._hold(True)
        self.loop.call_later(REST_S, self._answer)

    def _one(self, transaction: int, unit: int, message: bytes) -> None:
        slave = self.line.slave
        with self.line.lock:
            reply = slave.receive(slave.station if unit in WHOLE_UNITS else unit, message)
        if reply is not None:
            self.transport.write(tcp_encode(transaction, unit, reply))


class SerialLine(_Line):
    """A serial port in RTU or ASCII mode; one that is unplugged is opened again when it is back."""

    def __init__(self, path: str, settings: PortSettings, slave: Slave, lock: AbstractContextManager):
        framing = settings.framing
        wireless = os.path.realpath(path).startswith(PSEUDO_TERMINALS)
        params = CommParams(
            comm_name="ecsim",
            comm_type=CommType.SERIAL,
            source_address=(path, 0),
            baudrate=framing.baud,
            bytesize=8 if wireless else framing.data_bits,
            parity=PARITIES["none" if wireless else framing.parity],
            stopbits=framing.stop_bits,
        )
        super().__init__(params, slave, lock)
        self.path, self.mode, self.character_us = path, settings.mode, 1e6 * framing.bits / framing.baud

    @property
    def name(self) -> str:
        return f"{self.mode} {self.path}"

    def callback_new_connection(self) -> ModbusProtocol:
        return _Characters(self)

    def shut(self) -> None:
        self.close()

    def lost(self) -> None:
        """The port has gone away."""
        if not self.is_closing:
            self.loop.call_later(REOPEN_S, lambda: self.loop.create_task(self._reopen()))

    async def _reopen(self) -> None:
        if self.is_closing:
            return
        try:
            await self.open()
        except OSError:
            self.lost()


class _Characters(_Quiet):
    """The characters of a serial port."""

    def __init__(self, line: SerialLine):
        super().__init__(line.comm_params, False)
        self.line = line
        silence = max(3.5 * line.character_us, SILENCE_US) if line.mode == "rtu" else None
        self.receiver = Receiver(MODES[line.mode], line.character_us, gap_us=silence, silence_us=silence)
        self.timer: asyncio.TimerHandle | None = None
        self.waiting = 0

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        if self.timer is not None:
            self.timer.cancel()
        self.line.lost()

    def data_received(self, data: bytes) -> None:
        now = self.loop.time() * 1e6
        self._silence(now)
        rtu, receiver = self.line.mode == "rtu", self.receiver
        for octet in data:
            heard = receiver.hear(octet, now)
            if rtu and not receiver.overrun and rtu_request(receiver.octets):
                heard = receiver.end()
            if heard is not None:
                self._one(heard)
        self._watch()

    def _silence(self, now: float) -> None:
        if self.receiver.due is not None and now >= self.receiver.due:
            self._one(self.receiver.end())

    def _watch(self) -> None:
        """Look again when the silence may have ended a frame."""
        if self.timer is not None:
            self.timer.cancel()
            self.timer = None
        if self.receiver.due is not None:
            self.timer = self.loop.call_at(self.receiver.due / 1e6, self._due)

    def _due(self) -> None:
        self.timer = None
        self._silence(self.loop.time() * 1e6 + 1)
        self._watch()

    def _one(self, heard: Heard) -> None:
        with self.line.lock:
            reply = self.line.slave.hear(heard, self.line.mode)
        if reply is None or self.transport is None:
            return
        if not self.transport.get_write_buffer_size():
            self.waiting = 0
        if self.waiting < MOST_WAITING:
            self.waiting += len(reply)
            self.transport.write(reply)
