"""Server: the lines on which a PLC answers, in a thread with an event loop of its own."""

import asyncio
import ipaddress
import threading
import warnings
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from ..comms.slave import Slave
from ..errors import EcsimError
from ..hardware.serial import PortSettings
from .lines import SerialLine, TcpLine


class _Station(Slave):
    """The slave of a line: silent without power, begun anew with each power-up."""

    def __init__(self, plc: Any, station: int, write: Callable[[str, int, list], None]):
        super().__init__(plc.memory, station, write)
        self.plc, self.power_ups = plc, plc.power_ups

    def receive(self, station: int, message: bytes) -> bytes | None:
        if self.power_ups != self.plc.power_ups:
            self.power_ups = self.plc.power_ups
            self.restart()
        return super().receive(station, message) if self.plc.powered else None


class Server:
    """Answers Modbus clients until `stop()`. `lines` says where; `with` stops it at its end."""

    def __init__(self, target: Any, tcp: int | None, rtu: str | None, ascii: str | None, host: str, station: int, baud: int, parity: str):  # noqa: A002
        plc = getattr(target, "plc", target)
        if not hasattr(plc, "memory"):
            raise EcsimError(f"only a Plc or a Session can be served, not {type(target).__name__}")
        if tcp is None and not rtu and not ascii:
            raise EcsimError("nothing to serve on: give tcp=5020, or rtu= or ascii= with a serial device")
        if tcp is not None and (isinstance(tcp, bool) or not isinstance(tcp, int) or not 0 <= tcp <= 65535):
            raise EcsimError(f"tcp is {tcp!r}; it is a port from 0 to 65535")
        settings = {
            path: PortSettings("modbus slave", mode, station, baud, parity=parity)
            for mode, path in (("rtu", rtu), ("ascii", ascii))
            if path
        }
        if rtu and rtu == ascii:
            raise EcsimError(f"{rtu} is given in both modes; a line has one")
        for each in settings.values() or (PortSettings("modbus slave", station=station),):
            each.check(plc.model, 0)
        write = getattr(target, "receive", plc.memory.receive)
        openers: list[Callable[[], TcpLine | SerialLine]] = []

        if tcp is not None:
            if not _is_loopback(host):
                warnings.warn(f"Modbus has no password: whoever reaches {host} can write every device", stacklevel=3)
            openers.append(lambda: TcpLine(host, tcp, _Station(plc, station, write), plc.lock))
        for path, each in settings.items():
            openers.append(lambda path=path, each=each: SerialLine(path, each, _Station(plc, station, write), plc.lock))
        self.lines: list[TcpLine | SerialLine] = []
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="ecsim modbus", daemon=True)
        self._thread.start()
        try:
            self._do(self._open(openers))
        except BaseException:
            self.stop()
            raise

    async def _open(self, openers: list[Callable[[], TcpLine | SerialLine]]) -> None:
        for opener in openers:
            line = opener()
            try:
                await line.open()
            except (OSError, RuntimeError, ValueError) as error:
                where = getattr(line, "path", None) or "{}:{}".format(*line.comm_params.source_address)
                remedy = "choose another one, or 0 for any" if isinstance(line, TcpLine) else "give the path of a serial device"
                raise EcsimError(f"{where} cannot be opened: {getattr(error, 'strerror', None) or error}; {remedy}") from None
            self.lines.append(line)

    def _do(self, work: Any) -> Any:
        future: Future = asyncio.run_coroutine_threadsafe(work, self._loop)
        return future.result(timeout=30)

    @property
    def port(self) -> int | None:
        """The TCP port, None without one."""
        return next((line.address[1] for line in self.lines if isinstance(line, TcpLine)), None)

    @property
    def slaves(self) -> list[Slave]:
        """The slave of each line, with its counters."""
        return [line.slave for line in self.lines]

    def stop(self) -> None:
        """Close every line and connection; the ports are free when it returns. Once more does nothing."""
        if self._loop.is_closed():
            return
        self._do(self._shut())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _shut(self) -> None:
        for line in self.lines:
            line.shut()
        for _ in range(3):  # asyncio lets go of sockets in its next turns
            await asyncio.sleep(0)

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        if self._loop.is_closed():
            return "<Modbus server, stopped>"
        return f"<Modbus server on {', '.join(line.name for line in self.lines)}>"


def _is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
