"""Lines of the real world for the serial ports of a PLC: a serial device, a pseudo terminal or a TCP connection.

Nothing here waits: what has come is read, what cannot be written yet is kept.
"""

import contextlib
import os
import socket

from .errors import EcsimError
from .hardware.wire import Framing

CHUNK = 4096
MOST_WAITING = 16_384  # characters that nobody has taken; more are lost, as on a wire


class OutsideLine:
    """An open line: `read` gives what has come, `write` sends. `where` is a device's path or "tcp://host:port"."""

    def __init__(self, where: str, framing: Framing):
        self.where = where
        self.waiting = bytearray()
        try:
            if where.startswith("tcp://"):
                host, _, port = where.removeprefix("tcp://").rpartition(":")
                self.socket = socket.create_connection((host, int(port)), timeout=5)
                self.socket.setblocking(False)
                self.number = self.socket.detach()
            else:
                self.number = os.open(where, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
                _set_up(self.number, framing)
        except (OSError, ValueError, OverflowError) as error:
            words = getattr(error, "strerror", None) or error
            raise EcsimError(f"{where} cannot be opened: {words}; give the path of a serial device or tcp://host:port") from None

    def read(self) -> bytes:
        """What has come since; nothing where the other side is gone."""
        try:
            return os.read(self.number, CHUNK)
        except OSError:
            return b""

    def write(self, octets: bytes) -> None:
        """Send, as far as the line takes it now; the rest goes out later."""
        self.waiting += octets
        del self.waiting[MOST_WAITING:]
        with contextlib.suppress(OSError):
            while self.waiting:
                del self.waiting[: os.write(self.number, self.waiting)]

    def close(self) -> None:
        """Give the line back."""
        with contextlib.suppress(OSError):
            os.close(self.number)

    def __repr__(self) -> str:
        return f"<line {self.where}>"


def _set_up(number: int, framing: Framing) -> None:
    """Characters as they are, with the framing of the port; raises OSError for what is no serial device."""
    import termios
    import tty

    try:
        tty.setraw(number)
        speed = getattr(termios, f"B{framing.baud}")
        flags = termios.tcgetattr(number)
        flags[4] = flags[5] = speed
        control = flags[2] & ~(termios.CSIZE | termios.CSTOPB | termios.PARENB | termios.PARODD)
        control |= termios.CS7 if framing.data_bits == 7 else termios.CS8
        control |= termios.CSTOPB if framing.stop_bits == 2 else 0
        control |= (termios.PARENB if framing.parity != "none" else 0) | (termios.PARODD if framing.parity == "odd" else 0)
        flags[2] = control | termios.CREAD | termios.CLOCAL
        with contextlib.suppress(termios.error):  # a pseudo terminal has no parity
            termios.tcsetattr(number, termios.TCSANOW, flags)
    except termios.error as error:
        os.close(number)
        raise OSError(0, f"it is no serial device ({error.args[-1]})") from None
