"""6.9: the real-time clock: reading and setting it, sums of times, a running-time meter, comparisons of dates and times.

A time is three registers: hour, minute, second. A date is three registers: year, month, day.
"""

from collections.abc import Callable
from datetime import date

from ..errors import CLOCK, OPERAND, Fault
from .compare import COMPARISONS
from .define import command, value

DAY = 24 * 60 * 60
SECOND_US = 1_000_000


@command("TRD", "-> D:WORD[D V]*7", steps=3, section="6.9.1")
def trd(machine):
    """D and the six registers after it = year, month, day, hour, minute, second and weekday (0 is Sunday) of the clock."""
    return machine.rtc.read(machine.clock[0])


@command("TWR", "S:WORD[D V]*7", steps=3, section="6.9.2", faults=(CLOCK,))
def twr(machine, s):
    """Set the clock to year, month, day, hour, minute, second and weekday from S on, in every scan with flow."""
    machine.rtc.write(*s, now=machine.clock[0])


def seconds_of(time: list[int]) -> int:
    """A time of day in seconds; what is none is error 64."""
    hour, minute, second = time
    if not (0 <= hour <= 23 and 0 <= minute <= 59 and 0 <= second <= 59):
        raise Fault(OPERAND)
    return 3600 * hour + 60 * minute + second


def _time(seconds: int) -> list[int]:
    return [seconds // 3600, seconds // 60 % 60, seconds % 60]


_TIMES = "S1:WORD[D SD V]*3 S2:WORD[D SD V]*3 -> D:WORD[D V]*3 zero"


@value("TADD", f"{_TIMES} carry", steps=7, section="6.9.3", faults=(OPERAND,))
def tadd(s1, s2):
    """D = S1 + S2 as times of day; from 24 hours on a day is taken off and carry is set."""
    days, seconds = divmod(seconds_of(s1) + seconds_of(s2), DAY)
    return _time(seconds), seconds == 0, days > 0


@value("TSUB", f"{_TIMES} borrow", steps=7, section="6.9.4", faults=(OPERAND,))
def tsub(s1, s2):
    """D = S1 - S2 as times of day; below 0 a day is added and borrow is set."""
    days, seconds = divmod(seconds_of(s1) - seconds_of(s2), DAY)
    return _time(seconds), seconds == 0, days < 0


@command("HOUR", "S:INT=0..32767 D1:INT[D V]*2 D2:BOOL[Y M S LM]! now scan state -> D1 D2 state", steps=8, section="6.9.5")
def hour(flow, limit, meter, alarm, now, scan, state):
    """D1 = the hours that the flow has been ON, D1+1 = the seconds of the hour begun; D2 is ON from S hours on.

    Time counts from one execution to the next scan's: what is jumped over or switched off by MC does not count.
    """
    hours, second, state = run_on(flow, *meter, 0x8000, now, scan, state)  # 6.9.5: after 32767 hours it begins again at 0
    return [hours, second], (hours >= limit if flow else alarm), state


def run_on(flow, hours, second, end, now, scan, state):
    """A running-time meter, which begins again at 0 after `end` hours, after one more execution: hours, seconds and its state."""
    since, last, rest = state or (None, 0, 0)
    if since is not None and scan - last <= 1:
        rest += now - since
    whole, rest = divmod(rest, SECOND_US)
    more, second = divmod(second + whole, 3600)
    hours += more
    return hours - end if hours >= end else hours, second, (now if flow else None, scan, rest)


def day_of(day: list[int]) -> list[int]:
    """A date as it stands; what the Gregorian calendar does not have is error 64."""
    try:
        date(*day)
    except ValueError:
        raise Fault(OPERAND) from None
    return day


def _comparing(compare: Callable, known: Callable, what: str) -> Callable:
    """The function of one comparison of dates or times."""

    def compared(s1, s2):
        first, second = known(s1), known(s2)
        return compare(first, second)

    relation = (compare.__doc__ or "").removeprefix("Closed while ").rstrip(".")
    compared.__doc__ = f"D is ON when {relation} as {what}, OFF otherwise."
    return compared


for _prefix, _known, _what, _section in (("D", day_of, "dates", "6.9.6"), ("T", seconds_of, "times of day", "6.9.7")):
    for _sign, _compare in COMPARISONS.items():
        value(
            f"{_prefix}CMP{_sign}", "S1:INT[D SD V]*3 S2:INT[D SD V]*3 -> D:BOOL", steps=7, section=_section, faults=(OPERAND,)
        )(_comparing(_compare, _known, _what))  # fmt: skip
