"""6.10: high-speed inputs and outputs. What counts, compares and puts out pulses between two scans stands in `hardware/`."""

from ..errors import OPERAND, RAMP, RANGE, Fault
from ..hardware.counters import Comparison
from ..hardware.trains import Segment, Wave, envelope, stepped
from ..values import join
from .define import command

FASTEST = 100_000  # Hz


def counter_inputs(model, operands):
    counter = next(operand for operand in operands if getattr(operand, "area", "") == "C")
    return model.fast_counters[counter.number].needs


@command("HCNT", "claim >D:HCOUNTER S:DINT", steps=7, section="6.10.1", cleared=True, faults=(OPERAND,), occupies=counter_inputs)
def hcnt(machine, claim, counter, preset):
    """Drive a high-speed counter: it counts its inputs while the flow is ON; its contact turns ON at S upward and OFF downward."""
    machine.counters.drive(claim, counter, preset, machine.clock[0])


@command("DHSCS", "claim S1:DINT S2:HCOUNTER >D:POINT", steps=10, section="6.10.2", cleared=True)
def dhscs(machine, claim, value, counter, target):
    """Turn D ON in the moment in which the high-speed counter S2 counts to S1."""
    machine.counters.compare(claim, Comparison("set", counter, value, target=target))


@command("DHSCI", "claim S1:DINT S2:HCOUNTER S3:WORD[const]=20..25", steps=10, section="6.10.3", cleared=True)
def dhsci(machine, claim, value, counter, event):
    """Ask for the interrupt program of event S3 in the moment in which the high-speed counter S2 counts to S1."""
    machine.counters.compare(claim, Comparison("event", counter, value, event=event))


def _own_counter(value, counter, target):
    if getattr(target, "area", "") == "C" and target.number != counter.number:
        return f"D may be {counter} itself, not another counter"
    return None


@command("DHSCR", "claim S1:DINT S2:HCOUNTER >D:POINT[Y M S C]", steps=10, section="6.10.4", cleared=True, check=_own_counter)
def dhscr(machine, claim, value, counter, target):
    """Turn D OFF in the moment in which the high-speed counter S2 counts to S1; D may be the counter itself."""
    machine.counters.compare(claim, Comparison("reset", counter, value, target=target))


@command("DHSZ", "claim S1:DINT S2:DINT S3:HCOUNTER >D:POINT*3", steps=13, section="6.10.5", cleared=True)
def dhsz(machine, claim, low, high, counter, target):
    """Show with each count in D, D+1, D+2 whether the high-speed counter S3 is below S1, from S1 to S2, or above S2."""
    machine.counters.compare(claim, Comparison("zone", counter, low, high, target=target))


@command("DHST", "claim S1:TABLE S2:INT[const]=1..128 S3:HCOUNTER", steps=10, section="6.10.6", cleared=True, faults=(RANGE,))
def dhst(machine, claim, table, records, counter):
    """Switch outputs by a table of S2 records (value, Y, state) from S1 on, one after the other, as the high-speed counter S3 meets them."""
    machine.counters.compare(claim, Comparison("outputs", counter, table=table, records=records))


@command("DHSP", "claim S1:TABLE S2:INT[const]=1..128 S3:HCOUNTER", steps=10, section="6.10.7", cleared=True, faults=(RANGE,))
def dhsp(machine, claim, table, records, counter):
    """Give SD180 the data of a table of S2 records (value, data) from S1 on, one after the other, as the high-speed counter S3 meets them."""
    machine.counters.compare(claim, Comparison("data", counter, table=table, records=records))


@command(
    "SPD", "claim S1:POINT[X]=0..5 S2:WORD >D:PLACE*3~", steps=7, section="6.10.8", cleared=True, faults=(OPERAND,),
    occupies=lambda model, operands: (operands[0].number,),
)  # fmt: skip
def spd(machine, claim, source, window, target):
    """D = the pulses that the input S1 got in the last S2 ms; D+1 counts the present ones, D+2 their time in ms."""
    if not window:
        raise Fault(OPERAND)
    machine.meters.measure(claim, source.number, window, target, machine.clock[0])


@command("PLSY", "claim S1:DINT S2:DINT >D:PULSE", steps=9, section="6.10.9", cleared=True, faults=(OPERAND,))
def plsy(machine, claim, hertz, pulses, output):
    """Put out S2 pulses of S1 Hz on D, without end when S2 is 0; the frequency may change on the way."""
    outputs, now = machine.outputs, machine.clock[0]
    axis = outputs.owner(claim, output)
    if not 1 <= hertz <= FASTEST or pulses < 0:
        if axis is not None:
            outputs.refrain(axis, claim, now)
        raise Fault(OPERAND)
    if axis is None:
        return
    if axis.claim is None or (not axis.segments and not axis.completes):
        outputs.start(axis, claim, (Segment(now, hertz, pulses or None),), now, completes=pulses > 0)
    elif axis.segments and axis.segments[-1].hertz != hertz:
        running = axis.segments[-1]
        left = None if running.pulses is None else running.pulses - running.started(now)
        if left != 0:
            outputs.replace(axis, (Segment(now, hertz, left),), now)


@command("PLSR", "claim S1:WORD S2:DINT S3:WORD >D1:PULSE", steps=10, section="6.10.10", cleared=True, faults=(OPERAND, RAMP))
def plsr(machine, claim, hertz, pulses, ramp, output):
    """Put out S2 pulses on D1 with up to S1 Hz, reached and left in ten steps that take S3 ms."""
    outputs, now = machine.outputs, machine.clock[0]
    if pulses < 110:
        raise Fault(OPERAND)
    axis = outputs.owner(claim, output)
    if axis is None:
        return
    if axis.claim is None:
        warning = 0 if 10 <= hertz <= 20_000 else OPERAND
        hertz = min(max(hertz, 10), 20_000)
        work = hertz * max(ramp, machine.model.least_ramp_ms)
        fitting = min(max(work, 100_000), pulses * 909)
        if fitting != hertz * ramp:
            warning = warning or RAMP
        outputs.start(axis, claim, stepped(now, hertz, pulses, fitting), now, completes=True, warning=warning)
    if axis.warning:
        raise Fault(axis.warning)


@command("PLS", "claim S1:BLOCK~ S2:DINT >D1:PULSE", steps=7, section="6.10.11", faults=(OPERAND, RANGE))
def pls(machine, claim, first, steps, output):
    """Put out an envelope on D1: S2 steps of frequency and pulses from the D register S1 on, with ramps between them."""
    outputs, now = machine.outputs, machine.clock[0]
    axis = outputs.owner(claim, output)
    if not 0 <= steps <= 255:
        raise Fault(OPERAND)
    if axis is None or axis.claim is not None or not steps:
        return
    words = machine.memory.lists["D"]
    if not 0 <= first <= len(words) - 4 * steps - 5:
        raise Fault(RANGE)
    pairs = [join(words[place], words[place + 1]) for place in range(first, first + 4 * steps + 2, 2)]
    low, up, down = words[first + 4 * steps + 2 : first + 4 * steps + 5]
    plan = envelope(now, list(zip(pairs[:-1:2], pairs[1::2], strict=True)), low, pairs[-1], up, down)
    if plan is None or pairs[-1] > FASTEST:
        raise Fault(OPERAND)
    outputs.start(axis, claim, plan, now, completes=True)


@command("PWM", "claim S1:INT S2:INT >D:PULSE", steps=7, section="6.10.12", cleared=True, faults=(OPERAND,))
def pwm(machine, claim, width, period, output):
    """Put out pulses on D that are S1 ms wide and S2 ms apart; both may change on the way."""
    outputs, now = machine.outputs, machine.clock[0]
    axis = outputs.owner(claim, output)
    if not 0 <= width <= period or period < 1:
        if axis is not None:
            outputs.refrain(axis, claim, now)
        raise Fault(OPERAND)
    if axis is None:
        return
    if not axis.segments:
        outputs.start(axis, claim, (Wave(now, width * 1000, period * 1000),), now)
    else:
        axis.segments = (axis.segments[0].changed(width * 1000, period * 1000, now),)
