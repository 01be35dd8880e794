"""6.12: communication over the serial ports. What goes over the line stands in `comms/`."""

from ..comms import inverter
from ..comms.freeport import Freeport
from ..comms.master import FRAME, ILLEGAL_FUNCTION, NO_ROOM, WORD, WRONG_SETTING, Master, report, request_length
from ..devices import Device
from ..errors import OPERAND, RANGE, Fault
from .define import command

_MOST = 7 + 255  # bytes of a request

# -- Modbus ---------------------------------------------------------------------------------------------------------


def _exchange(machine, number: int, request: bytes, stores: str = "", target: Device | None = None, inverter: bool = False) -> None:
    """Let the master of a port carry out a request; a port that is no master is error 16#12."""
    port = machine.ports[number]
    master = port.protocol
    if not isinstance(master, Master):
        report(port, WRONG_SETTING, done=False)
        return
    if inverter and not master.busy:
        area, first, _ = machine.model.buffers["inverter request"]
        machine.memory.lists[area][first : first + len(request)] = request
    area, first = (target.area, target.number) if target is not None else ("", 0)
    master.exchange(request, stores, area, first, machine.clock[0], inverter)


@command("MODBUS", "S1:INT[const]=0..1 S2:FRAME >S3:FRAME[D]~", steps=8, section="6.12.1", rising=True, counted="exchanges")
def modbus(machine, port, source, target):
    """Send the request that stands from S2 on, a byte a register, as Modbus master, and store its answer in the same way from S3 on."""
    words = machine.memory.lists[source.area]
    octets = bytes(word & 0xFF for word in words[source.number : source.number + _MOST])
    padded = octets.ljust(7, b"\0")
    length = request_length(padded)
    if not isinstance(machine.ports[port].protocol, Master):
        report(machine.ports[port], WRONG_SETTING, done=False)
    elif machine.ports[port].protocol.busy:
        return
    elif not length:
        report(machine.ports[port], ILLEGAL_FUNCTION, done=False)
    elif length > len(octets):
        report(machine.ports[port], NO_ROOM, done=False)
    else:
        _exchange(machine, port, octets[:length], FRAME, target)


# -- inverters ------------------------------------------------------------------------------------------------------

_PORT_1, _ALL, _ONE = "S1:INT[const]=1..1", "S2:WORD[const D V]=0..247", "S2:WORD[const D V]=1..247"  # station 0 is a broadcast
_COLUMNS = {"models": ("EC10",), "rising": True, "counted": "exchanges"}


def _tell(machine, port: int, station: int, message: bytes, target: Device | None = None) -> None:
    """Say something to an inverter; with a target the register that it answers with is stored there."""
    _exchange(machine, port, bytes((station,)) + message, WORD if target is not None else "", target, inverter=True)


@command("EVFWD", f"{_PORT_1} {_ALL}", steps=6, section="6.12.2", **_COLUMNS)
def evfwd(machine, port, station):
    """Let inverter S2 run forward; station 0 is all of them."""
    _tell(machine, port, station, inverter.command(inverter.RUN))


@command("EVREV", f"{_PORT_1} {_ALL}", steps=6, section="6.12.3", **_COLUMNS)
def evrev(machine, port, station):
    """Let inverter S2 run in reverse; station 0 is all of them."""
    _tell(machine, port, station, inverter.command(inverter.RUN | inverter.REVERSE))


@command("EVDFWD", f"{_PORT_1} {_ALL}", steps=6, section="6.12.4", **_COLUMNS)
def evdfwd(machine, port, station):
    """Let inverter S2 jog forward; station 0 is all of them."""
    _tell(machine, port, station, inverter.command(inverter.JOG_FORWARD))


@command("EVDREV", f"{_PORT_1} {_ALL}", steps=6, section="6.12.5", **_COLUMNS)
def evdrev(machine, port, station):
    """Let inverter S2 jog in reverse; station 0 is all of them."""
    _tell(machine, port, station, inverter.command(inverter.JOG_REVERSE))


@command("EVSTOP", f"{_PORT_1} {_ALL} S3:WORD[const D V]=0..2", steps=8, section="6.12.6", **_COLUMNS)
def evstop(machine, port, station, way):
    """Stop inverter S2: with its ramp (S3 = 0), by coasting (1), or with its fastest ramp (2)."""
    _tell(machine, port, station, inverter.command(inverter.STOP_COMMANDS[way]))


@command("EVFRQ", f"{_PORT_1} {_ALL} S3:WORD[const D V]=0..655", steps=8, section="6.12.7", **_COLUMNS)
def evfrq(machine, port, station, hertz):
    """Set the frequency of inverter S2 to S3 Hz."""
    _tell(machine, port, station, inverter.write(inverter.SETTING, hertz * inverter.HUNDREDTHS))


@command("EVWRT", f"{_PORT_1} {_ALL} S3:WORD[const D V] S4:WORD[const D V]", steps=10, section="6.12.8", **_COLUMNS)
def evwrt(machine, port, station, register, content):
    """Write S4 into the register S3 of inverter S2."""
    _tell(machine, port, station, inverter.write(register, content))


@command("EVRDST", f"{_PORT_1} {_ONE} S3:WORD[const D V]=0..6 >D1:PLACE[D]~", steps=10, section="6.12.9", **_COLUMNS)
def evrdst(machine, port, station, which, target):
    """D1 = a word of the state of inverter S2: 0 status, 1 actual value, 2 type, 3 current, 4 voltage, 5 speed, 6 fault."""
    _tell(machine, port, station, inverter.read(inverter.STATUS + which), target)


@command("EVRD", f"{_PORT_1} {_ONE} S3:WORD[const D V] >D1:PLACE[D]~", steps=10, section="6.12.10", **_COLUMNS)
def evrd(machine, port, station, register, target):
    """D1 = what the register S3 of inverter S2 holds."""
    _tell(machine, port, station, inverter.read(register), target)


# -- freeport -------------------------------------------------------------------------------------------------------

_PORT = "S1:INT[const]=0..1"


def _freeport(machine, number: int) -> Freeport | None:
    """The freeport of a port, None where the system block has set up another protocol."""
    protocol = machine.ports[number].protocol
    return protocol if isinstance(protocol, Freeport) else None


@command("XMT", f"{_PORT} S2:WORD[D V]*S3! S3:INT-KnSM!", steps=7, section="6.12.11", faults=(OPERAND, RANGE))
def xmt(machine, port, words, count):
    """Send the low bytes of the S3 words from S2 on over freeport S1, if it is not sending already."""
    if count < 1:
        raise Fault(OPERAND)
    protocol = _freeport(machine, port)
    if protocol is not None:
        protocol.transmit(bytes(word & 0xFF for word in words), machine.clock[0])


@command("RCV", f"{_PORT} >D:PLACE*S2 S2:INT-KnSM!", steps=7, section="6.12.12", faults=(OPERAND, RANGE))
def rcv(machine, port, target, most):
    """Receive up to S2 characters from freeport S1 into the low bytes of the words from D on, if it is not receiving already."""
    if most < 1:
        raise Fault(OPERAND)
    if target.number + most > machine.model.areas[target.area].count:
        raise Fault(RANGE)
    protocol = _freeport(machine, port)
    if protocol is not None:
        protocol.receive(target.area, target.number, most, machine.clock[0])
