"""The fast side of EC10 and EC20 as data: high-speed counters, interrupt events, relays and registers of chapters 8, 9 and 6.17."""

from .model import FastCounter, PulseOutput

_SINGLE = {236: (0,), 237: (1,), 238: (2,), 239: (3,), 240: (4,), 241: (5,), 242: (0, 2), 243: (3, 5), 244: (0, 2, 6), 245: (3, 5, 7)}
_PAIRS = ((0, 1), (0, 1, 2), (3, 4, 5), (0, 1, 2, 6), (3, 4, 5, 7))


def _counter(mode: str, inputs: tuple[int, ...], khz: int, hardware: bool) -> FastCounter:
    counting = 1 if mode == "single" else 2
    reset, start = (*inputs[counting:], None, None)[:2]
    return FastCounter(mode, inputs[:counting], reset, start, khz, hardware)


# 8.1.1: which inputs a counter has, the highest frequency in kHz, whether it can count in hardware (8.1.4).
FAST_COUNTERS = {
    **{number: _counter("single", inputs, 50 if number < 238 else 10, number < 238) for number, inputs in _SINGLE.items()},
    **{246 + place: _counter("up/down", inputs, 10 if place else 50, not place) for place, inputs in enumerate(_PAIRS)},
    **{251 + place: _counter("phases", inputs, 5 if place else 30, not place) for place, inputs in enumerate(_PAIRS)},
}

# 9.1: event -> the special relay that lets it ask for its interrupt program.
_EVENTS_EC20 = {
    **{sense + number: 40 + number for sense in (0, 10) for number in range(8)},
    **dict.fromkeys(range(20, 26), 65),
    **{event: event + 40 for event in (26, 27, 28)},
}
_EVENTS_EC10 = _EVENTS_EC20 | {18: 63, 19: 64, 29: 56, **{event: event + 18 for event in range(30, 38)}}

_EVENTS = {
    "edge_events": {number + 10 * (not rising): (number, rising) for number in range(8) for rising in (True, False)},
    "timed_registers": {26: 66, 27: 67, 28: 68},
    "power_loss_event": 29,
}

RELAYS = {"capture": 90, "table done": 185}
REGISTERS = {
    "pulses of all": 54, "base frequency": 84, "top frequency": 85, "ramp time": 87,
    "table output": 180, "table value": 182, "table record": 184,
}  # fmt: skip
# 6.17.6: SD84 to SD87; appendix 2: SD88 and SD89. 100000 = 1 * 65536 + 34464
INITIAL = {84: 5000, 85: 1, 86: 34464 - 65536, 87: 1000, 88: 100, 89: 100}

# The greatest frequencies. 8.1.4: of a counter with DHSZ or another comparison, and of all counters and SPD together in either case.
# 6.10.8: of SPD. 8.2: with pulse capture. 9.4: of inputs that ask for interrupts.
LIMITS = {
    "kHz compared single": 10, "kHz compared phases": 5, "kHz zone single": 5, "kHz zone phases": 4,
    "kHz together": 80, "kHz compared together": 30, "kHz zone together": 20, "kHz metered": 10, "kHz captured together": 80,
    "Hz interrupting": 200, "Hz interrupting together": 1000,
}  # fmt: skip


def _pulse_outputs(**more: int) -> tuple[PulseOutput, ...]:
    """Y0 and Y1; of EC10 the clear signal goes to Y2 and Y3, SD56 and SD57 tell the steps of envelopes."""
    return tuple(
        PulseOutput(80 + n, 82 + n, 50 + 2 * n, 80 + 2 * n, 18 + n, **{name: first + n for name, first in more.items()}) for n in range(2)
    )


EC20 = {"fast_counters": FAST_COUNTERS, "events": _EVENTS_EC20, **_EVENTS, "pulse_outputs": _pulse_outputs()}
EC10 = {
    "fast_counters": FAST_COUNTERS, "events": _EVENTS_EC10, **_EVENTS,
    "pulse_outputs": _pulse_outputs(clear=2, segment=56), "least_ramp_ms": 50,
}  # fmt: skip
RELAYS_EC10 = {"clear signal": 85}
