"""6.17: positioning. The axes stand in `hardware/pulses.py`, the reading of a servo's position in `hardware/servo.py`."""

from ..errors import OPERAND, SERVO_CHECKSUM, SERVO_SILENT, Fault
from ..hardware.pulses import Home
from ..hardware.trains import Ramps, Segment, least_hertz
from .define import command

SLOWEST, FASTEST = 10, 100_000  # Hz
FARTHEST = 999_999


def _limits(machine) -> tuple[int, int, int]:
    """Base and top frequency and ramp time (SD84 to SD87); a base that is not below a tenth of the top is set to that (6.17.6)."""
    model = machine.model
    registers = machine.memory.lists[model.special_words]
    top, ramp = machine.outputs.register(model.registers["top frequency"]), registers[model.registers["ramp time"]]
    place = model.registers["base frequency"]
    if registers[place] * 10 >= top > 0:
        registers[place] = top // 10
    return registers[place], top, ramp


def _speed(machine, hertz: int) -> tuple[float, Ramps] | None:
    """The frequency that is put out for the one that is asked for, and the ramps; None when nothing is (6.17.4)."""
    base, top, ramp = _limits(machine)
    if hertz < base or hertz > top:
        return None
    least = least_hertz(top, ramp)
    slope = (top - base) * 1000 / ramp if ramp > 0 else 0.0
    return max(hertz, least), Ramps(max(base, least, 1), slope)


def _free(machine, claim: int, output: int):
    """The output, if the instruction may begin: not in the scan in which another one gave it back."""
    axis = machine.outputs.owner(claim, output)
    return axis if axis is not None and axis.claim is None and axis.free != machine.clock[0] else None


def _direct(machine, device, forward: bool) -> None:
    machine.memory.bits(device.area)[device.number] = forward


@command("ZRN", "claim S1:DINT S2:DINT S3:POINT[X Y M S] >D:PULSE", steps=11, section="6.17.7", faults=(OPERAND,))
def zrn(machine, claim, hertz, creep, dog, output):
    """Return to the origin on D: backward at S1 Hz, at S2 Hz from the near-point signal S3 on, to the place where that ends."""
    if not SLOWEST <= hertz <= FASTEST or not 1 <= creep <= FASTEST:
        raise Fault(OPERAND)
    axis = _free(machine, claim, output)
    if axis is None:
        return
    speed, now = _speed(machine, hertz), machine.clock[0]
    if speed is None:
        axis.claim = claim
        machine.outputs.wake()
        return
    hertz, ramps = speed
    first = min(ramps.base, hertz)
    rise = ramps.between(first, hertz)
    plan = (Segment(now, first, rise, ramps.slope, direction=-1),) if rise else ()
    plan += (Segment(plan[0].end if plan else now, hertz, None, direction=-1),)
    machine.outputs.start(axis, claim, plan, now, ramps=ramps, home=Home(dog, min(creep, hertz), ramps))
    machine.outputs.sense(axis, now)


@command("PLSV", "claim S:DINT >D1:PULSE >D2:POINT", steps=8, section="6.17.8", faults=(OPERAND,))
def plsv(machine, claim, hertz, output, direction):
    """Put out pulses of S Hz on D1 without ramps; the sign of S is the direction D2, and S may change on the way."""
    outputs, now = machine.outputs, machine.clock[0]
    axis = outputs.owner(claim, output)
    if hertz > FASTEST or hertz < -FASTEST or 0 < hertz < SLOWEST:
        if axis is not None:
            outputs.refrain(axis, claim, now)
        raise Fault(OPERAND)
    if axis is None or (axis.claim is None and axis.free == now):
        return
    sign = 1 if hertz > 0 else -1
    if not hertz:
        outputs.refrain(axis, claim, now)
        return
    _direct(machine, direction, hertz > 0)
    segment = Segment(now, abs(hertz), None, direction=sign)
    if not axis.segments:
        outputs.start(axis, claim, (segment,), now)
    elif (axis.segments[-1].hertz, axis.segments[-1].direction) != (segment.hertz, sign):
        outputs.replace(axis, (segment,), now)


def _move(machine, claim: int, pulses: int, hertz: int, output: int, direction) -> None:
    axis, now = _free(machine, claim, output), machine.clock[0]
    if axis is None:
        return
    speed = _speed(machine, hertz)
    plan = ()
    if speed is not None and pulses:
        _direct(machine, direction, pulses > 0)
        plan = speed[1].move(now, abs(pulses), speed[0], 1 if pulses > 0 else -1)
    machine.outputs.start(axis, claim, plan, now, completes=bool(plan), ramps=speed[1] if speed else None)


@command("DRVI", "claim S1:DINT S2:DINT >D1:PULSE >D2:POINT", steps=11, section="6.17.9", faults=(OPERAND,))
def drvi(machine, claim, pulses, hertz, output, direction):
    """Move by S1 pulses at S2 Hz on D1 with ramps; D2 is the direction. Without flow it slows down and stops."""
    if abs(pulses) > FARTHEST or not SLOWEST <= hertz <= FASTEST:
        raise Fault(OPERAND)
    _move(machine, claim, pulses, hertz, output, direction)


@command("DRVA", "claim S1:DINT S2:DINT >D1:PULSE >D2:POINT", steps=11, section="6.17.10", faults=(OPERAND,))
def drva(machine, claim, target, hertz, output, direction):
    """Move to the position S1 at S2 Hz on D1 with ramps; D2 is the direction. Without flow it slows down and stops."""
    if abs(target) > FARTHEST or not SLOWEST <= hertz <= FASTEST:
        raise Fault(OPERAND)
    _move(machine, claim, target - machine.outputs.position(output), hertz, output, direction)


@command(
    "ABS", "claim S:POINT[X Y M S]*3 >D1:POINT*3 >D2:DPLACE[KnY KnM KnS D SD C]~", steps=8, section="6.17.11",
    faults=(SERVO_SILENT, SERVO_CHECKSUM),
)  # fmt: skip
def read_position(machine, claim, source, target, position):
    """D2 = the absolute position that a servo amplifier sends over the inputs from S on, asked for by the outputs from D1 on."""
    machine.servo.read(claim, source, target, position, machine.clock[0])
