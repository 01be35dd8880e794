"""FNC 162 to 169: sums of times, reading and setting the clock, the hour meter, in T, C and D."""

from ..errors import CLOCK, OPERAND
from ..values import join, split
from .clock import hour, run_on, tadd, trd, tsub, twr
from .define import FX, command, value

_TIMES = "S1:WORD[T C D]*3 S2:WORD[T C D]*3 -> D:WORD[T C D]*3 zero"
_ALARM = "D2:BOOL[Y M S]! now scan state -> D1 D2 state"

value("FX:TADD", f"{_TIMES} carry", steps=7, section="FNC 162", models=FX, faults=(OPERAND,))(tadd)
value("FX:TSUB", f"{_TIMES} borrow", steps=7, section="FNC 163", models=FX, faults=(OPERAND,))(tsub)
command("FX:TRD", "-> D:WORD[T C D]*7", steps=3, section="FNC 166", models=FX)(trd)
command("FX:TWR", "S:WORD[T C D]*7", steps=3, section="FNC 167", models=FX, faults=(CLOCK,))(twr)
command("FX:HOUR", f"S:INT=0..32767 D1:INT[D]*2 {_ALARM}", steps=7, section="FNC 169", models=FX)(hour)


@command("FX:DHOUR", f"S:DINT=0..2147483647 D1:INT[D]*3 {_ALARM}", steps=13, section="FNC 169", models=FX)
def dhour(flow, limit, meter, alarm, now, scan, state):
    """D1 and D1+1 = the hours that the flow has been ON, D1+2 = the seconds of the hour begun; D2 is ON from S hours on."""
    low, high, second = meter
    hours, second, state = run_on(flow, join(high, low), second, 0x8000_0000, now, scan, state)
    high, low = split(hours)
    return [low, high, second], (hours >= limit if flow else alarm), state
