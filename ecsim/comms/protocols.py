"""The protocols of the serial ports by name."""

from collections.abc import Callable

from ..hardware.serial import Port, Protocol
from .ecbus import Ecbus
from .freeport import Freeport
from .master import Master
from .rs import Rs
from .station import SlaveStation

PROTOCOLS: dict[str, Callable[[Port], Protocol]] = {
    "freeport": Freeport,
    "rs": Rs,
    "modbus master": Master,
    "modbus slave": SlaveStation,
    "ecbus": Ecbus,
}
