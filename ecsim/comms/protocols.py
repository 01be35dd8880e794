"""The protocols of the serial ports by name."""

from collections.abc import Callable

from ..hardware.serial import Port, Protocol
from .freeport import Freeport

PROTOCOLS: dict[str, Callable[[Port], Protocol]] = {"freeport": Freeport}
