"""FNC 88 of H1U and H2U: the PID loop of 6.11.1 with its settings in 25 registers."""

from ..errors import OPERAND, Fault
from .control import controlled
from .define import FX, value

LIMITS = 20  # S3+20 to S3+23 are the limits, S3+24 the alarms
TUNING = 4  # bit of S3+1: automatic tuning


@value(
    "FX:PID",
    "S1:INT[D] S2:INT[D] S3:INT[D]*25 D:INT[D] s3 now state -> S3 D state",
    steps=9,
    section="FNC 88",
    models=FX,
    faults=(OPERAND,),
)
def pid(setpoint, measured, block, output, place, now, state):
    """D becomes the output of a PID loop with the set point S1, the measured value S2 and the settings from S3 on.

    S3 to S3+6 are sample time (ms), mode, filter (%), gain (%), integral time (100 ms), derivative gain (%) and time (10 ms); S3+7 to
    S3+19 belong to the loop; behind them stand the greatest rise and fall of the input, the limits of the output and the alarms.
    Automatic tuning (bit 4 of the mode) is not simulated and is an operation error.
    """
    if block[1] >> TUNING & 1:
        raise Fault(OPERAND)
    return controlled(setpoint, measured, block, output, place, now, state, LIMITS)
