"""Serving a PLC to real Modbus clients, over TCP and over serial ports (chapter 10)."""

from typing import TYPE_CHECKING, Any

from ..errors import EcsimError

if TYPE_CHECKING:
    from .server import Server


def serve(
    target: Any,
    tcp: int | None = None,
    rtu: str | None = None,
    ascii: str | None = None,  # noqa: A002 - the manual's name of the mode
    host: str = "127.0.0.1",
    station: int = 1,
    baud: int = 19200,
    parity: str = "even",
) -> "Server":
    """Let Modbus clients reach a Session, or a Plc, until `stop()` of what is returned; the lines have a thread of their own.

    `tcp` is a port (0: any free one), `rtu` and `ascii` are serial devices ("/dev/ttyS1", "COM3") with `baud`, `parity`
    ("none", "odd", "even") and the stop bits of 10.4.13. Requests are carried out between two scans. A Session lets time go by
    meanwhile; a Plc alone scans when it is told to. `host` is the address to listen at, this machine alone unless told otherwise.
    Raises EcsimError for what cannot be opened, and opens nothing then.
    """
    try:
        from .server import Server
    except ImportError as error:
        raise EcsimError(f'serving needs {error.name}; install it with: pip install "pymodbus[serial]"') from None
    return Server(target, tcp=tcp, rtu=rtu, ascii=ascii, host=host, station=station, baud=baud, parity=parity)


__all__ = ["serve"]
