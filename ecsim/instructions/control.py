"""6.11: control: a PID loop and three waveforms."""

from math import copysign, floor
from typing import NamedTuple

from ..errors import OPERAND, Fault
from .define import command, value

INT_LOW, INT_HIGH = -0x8000, 0x7FFF


class Settings(NamedTuple):
    """The 20 registers from S3 on, by name. Percentages as they stand, times in milliseconds."""

    period_ms: int  # Ts
    reverse: bool
    input_alarm: bool
    output_alarm: bool
    limited: bool
    filter_percent: int
    gain_percent: int  # Kp
    integral_ms: int  # TI, 0 for none
    derivative_percent: int  # KD
    derivative_ms: int  # TD, 0 for none
    most_rise: int
    most_fall: int
    upper: int  # the limits of the output, or how far it may rise and fall in one sample
    lower: int


class Loop(NamedTuple):
    """What a PID loop carries from one sample to the next."""

    samples: int  # 1 to 32767 and round again; S3+7 holds the same
    due_us: int  # when the next sample is taken
    filtered: float  # PVf[n-1]
    filtered_before: float  # PVf[n-2]
    error: float  # EV[n-1]
    derivative: float  # D[n-1]
    output: float  # MV with its fraction


def settings(block, limits):
    """What the registers from S3 on say, the four limits from the place `limits` on; a setting outside its range is error 64."""
    period, mode, smoothing, gain, integral, kd, td, *_ = block
    legal = period >= 1 and 0 <= smoothing <= 99 and gain >= 1 and integral >= 0 and 0 <= kd <= 100 and td >= 0
    output_alarm, limited = mode >> 2 & 1 == 1, mode >> 5 & 1 == 1
    if output_alarm and limited:  # 6.11.1: both ON count as both OFF
        output_alarm = limited = False
    found = Settings(
        period,
        mode & 1 == 1,
        mode >> 1 & 1 == 1,
        output_alarm,
        limited,
        smoothing,
        gain,
        100 * integral,
        kd,
        10 * td,
        *block[limits : limits + 4],
    )
    if found.input_alarm:
        legal = legal and min(found.most_rise, found.most_fall) >= 0
    if output_alarm:
        legal = legal and min(found.upper, found.lower) >= 0
    if limited:
        legal = legal and found.upper >= found.lower
    if not legal:
        raise Fault(OPERAND)
    return found


def rounded(number):
    """The nearest whole number, halves away from zero."""
    return int(copysign(floor(abs(number) + 0.5), number))


def sampled(given, setpoint, measured, loop):
    """One sample of the velocity form: the loop after it, and how far the output has moved."""
    filtered = measured + given.filter_percent * (loop.filtered - measured) / 100
    direction = -1 if given.reverse else 1
    error = direction * (loop.filtered - setpoint)
    bend = direction * (filtered + loop.filtered_before - 2 * loop.filtered)
    lag = given.derivative_percent * given.derivative_ms / 100
    derivative = (given.derivative_ms * bend + lag * loop.derivative) / (given.period_ms + lag)
    integral = given.period_ms * error / given.integral_ms if given.integral_ms else 0
    output = loop.output + given.gain_percent * (error - loop.error + integral + derivative) / 100
    upper, lower = (given.upper, given.lower) if given.limited else (INT_HIGH, INT_LOW)
    output = max(lower, min(output, upper))
    return Loop(loop.samples % INT_HIGH + 1, loop.due_us, filtered, loop.filtered, error, derivative, output), output - loop.output


def alarms(given, rise, climb):
    """The bits of S3+19: input risen, input fallen, output risen, output fallen by more than is allowed."""
    bits = 0
    if given.input_alarm:
        bits |= (rise > given.most_rise) | (-rise > given.most_fall) << 1
    if given.output_alarm:
        bits |= (climb > given.upper) << 2 | (-climb > given.lower) << 3
    return bits


@value("PID", "S1:INT[D] S2:INT[D] S3:INT[D]*20 D:INT[D] s3 now state -> S3 D state", steps=9, section="6.11.1", faults=(OPERAND,))
def pid(setpoint, measured, block, output, place, now, state):
    """D becomes the output of a PID loop with the set point S1, the measured value S2 and the settings from S3 on.

    One sample in each sample time. S3+7 counts the samples; when it is cleared the loop begins anew, from what D holds.
    """
    return controlled(setpoint, measured, block, output, place, now, state, 15)


def controlled(setpoint, measured, block, output, place, now, state, limits):
    """The block, the output and the loops after a scan; four limits and the word of alarms stand from the place `limits` on."""
    loops = state or {}
    loop = loops.get(place)
    if loop is None or loop.samples != block[7]:
        loop = Loop(0, now, measured, measured, 0, 0, output)
    if now < loop.due_us:
        return block, output, state
    given = settings(block, limits)
    if rounded(loop.output) != output:  # D was written by others: the loop goes on from there
        loop = loop._replace(output=output)
    after, climb = sampled(given, setpoint, measured, loop)
    due_us = loop.due_us + 1000 * given.period_ms
    after = after._replace(due_us=due_us if due_us > now else now + 1000 * given.period_ms)
    alarm = alarms(given, after.filtered - loop.filtered, climb) if given.input_alarm or given.output_alarm else block[limits + 4]
    block = [*block[:7], after.samples, *block[8 : limits + 4], alarm]
    return block, rounded(after.output), {**loops, place: after}


def point(start, end, place, steps):
    """The value at one of the steps from start to end, halves rounded up."""
    return start + (2 * (end - start) * place + steps) // (2 * steps)


WAVEFORM = "S1:INT S2:INT D1:INT[D V] S3:INT=1..32767 >D2:BOOL state -> D1 state"


@command("RAMP", WAVEFORM, steps=12, section="6.11.2", counted="waveforms")
def ramp(flow, s1, s2, d1, s3, state):
    """D1 goes from S1 to S2 in S3 steps, one in each scan with flow, and stays there with D2 ON; a new flow begins it again."""
    if not flow:
        return d1, False, False
    place = min(state, s3)
    return point(s1, s2, place, s3), place == s3 or s1 == s2, place + 1


@command("HACKLE", WAVEFORM, steps=12, section="6.11.3", counted="waveforms")
def hackle(flow, s1, s2, d1, s3, state):
    """D1 goes from S1 to S2 in S3 steps, one in each scan with flow, over and over; D2 is ON in the last scan of each tooth."""
    if not flow:
        return d1, False, False
    place = state if state <= s3 else 0
    return point(s1, s2, place, s3), place == s3 or s1 == s2, place + 1


@command("TRIANGLE", WAVEFORM, steps=12, section="6.11.4", counted="waveforms")
def triangle(flow, s1, s2, d1, s3, state):
    """D1 goes from S1 to S2 and back in S3 steps each, one in each scan with flow, over and over; D2 is ON whenever it is back."""
    if not flow:
        return d1, False, False
    place = state if state <= 2 * s3 else 1
    return point(s1, s2, min(place, 2 * s3 - place), s3), place == 2 * s3 or s1 == s2, place + 1
