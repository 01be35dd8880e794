"""6.8: peripherals: special modules, potentiometers, the input filter, immediate refresh, the EEPROM."""

from ..errors import NO_ANSWER, NO_BUFFER, NO_MODULE, OPERAND, RANGE, REFRESH, Fault
from ..hardware.eeprom import WRITE_US
from ..values import join, split
from .define import command

SAVED_END = 7000  # 6.8.8: S1 + S2 < D7000
_PLACE = "S1:INT[const]=0..7 S2:INT[const]=0..32767"
_MODULE = {"models": ("EC20",), "faults": (NO_MODULE, NO_ANSWER, NO_BUFFER)}


@command("FROM", f"{_PLACE} >D:INT[D V]*S3 S3:INT[const]=1..32767", steps=9, section="6.8.1", **_MODULE)
def from_(machine, place, first, count):
    """The S3 registers from D on = the buffers of special module S1 from number S2 on."""
    return machine.modules.read(place, first, count)


@command("DFROM", f"{_PLACE} >D:DINT[D V]*S3 S3:INT[const]=1..32767", steps=10, section="6.8.2", **_MODULE)
def dfrom(machine, place, first, count):
    """The S3 double words from D on = pairs of buffers of special module S1 from number S2 on, the high word in the lower number."""
    words = machine.modules.read(place, first, 2 * count)
    return [join(*words[i : i + 2]) for i in range(0, 2 * count, 2)]


@command("TO", f"{_PLACE} S3:INT[D V]*S4 S4:INT[const]=1..32767", steps=9, section="6.8.3", **_MODULE)
def to(machine, place, first, words, count):
    """The buffers of special module S1 from number S2 on = the S4 registers from S3 on."""
    machine.modules.write(place, first, words)


@command("DTO", f"{_PLACE} S3:DINT[D V]*S4 S4:INT[const]=1..32767", steps=10, section="6.8.4", **_MODULE)
def dto(machine, place, first, values, count):
    """Pairs of buffers of special module S1 from number S2 on = the S4 double words from S3 on, the high word in the lower number."""
    machine.modules.write(place, first, [word for value in values for word in split(value)])


@command("VRRD", "S:WORD[const] -> D:WORD[D V]", steps=5, section="6.8.5", faults=(OPERAND,))
def vrrd(machine, number):
    """D = the value of potentiometer S, 0 to 255; it is 0 where there is no such potentiometer."""
    if number > 255:
        raise Fault(OPERAND)
    return machine.pots.read(number)


@command("REFF", "S:WORD", steps=3, section="6.8.6")
def reff(machine, milliseconds):
    """Set the filter of the inputs to S ms, or the next shorter time that the model can do."""
    choices = machine.model.reff_ms
    machine.inputs.set_filter(1000 * max(choice for choice in choices if choice <= milliseconds))


def _groups_of_eight(device, count) -> str | None:
    if device.number % 8:
        return f"{device} is not the first of a group of eight points; D ends in 0"
    return f"S = {count} is no multiple of 8" if count % 8 else None


@command("REF", ">D:POINT[X Y]*S S:INT[const]=8..256", steps=5, section="6.8.7", faults=(RANGE, REFRESH), check=_groups_of_eight)
def ref(machine, device, count):
    """Take the S inputs from D on into the program, or put the S outputs out, at once and not at the end of the scan.

    The image of the outputs is what the terminals show, so that only inputs change.
    """
    if device.number + count > machine.model.areas[device.area].count:
        raise Fault(RANGE)
    machine.modules.refresh(device.area, range(device.number, device.number + count))
    if device.area == "X":
        machine.inputs.refresh(machine.clock[0], range(device.number, device.number + count))


@command("EROMWR", "S1:SAVED S2:INT=0..15", steps=6, section="6.8.8", models=("EC10",), rising=True, faults=(OPERAND,))
def eromwr(machine, first, count):
    """Save the S2 registers from S1 on in the EEPROM, which gives them back at power-up and at RUN; once each time the flow rises."""
    if first + count >= SAVED_END:
        raise Fault(OPERAND)
    if machine.eeprom.save(first, count, machine.clock[0]):
        machine.lengthen(WRITE_US)
