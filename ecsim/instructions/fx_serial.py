"""FNC 80: the serial port in the free protocol. What goes over the line stands in `comms/rs.py`."""

from ..comms.rs import Rs, Task
from ..errors import OPERAND, RANGE, Fault
from .define import FX, command

_MOST = 256  # characters of a message
PORT = 1  # COM1; the other one is for programming


@command(
    "FX:RS", "claim S:PLACE[D]~ M:INT[const D] >D:PLACE[D]~ N:INT[const D]", steps=9, section="FNC 80", models=FX, pulsed=False,
    faults=(OPERAND, RANGE),
)  # fmt: skip
def rs(machine, claim, source, length, target, room):
    """Send M characters from S on when M8122 is turned ON, and receive up to N into D and on; M8123 tells of a message."""
    if not (0 <= length <= _MOST and 0 <= room <= _MOST):
        raise Fault(OPERAND)
    count = machine.model.areas["D"].count
    if source.number + length > count or target.number + room > count:
        raise Fault(RANGE)
    protocol = machine.ports[PORT].protocol
    if isinstance(protocol, Rs):
        protocol.drive(claim, Task(source, length, target, room))
