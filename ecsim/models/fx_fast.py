"""The fast side of H1U and H2U as data: high-speed counters and their inputs, interrupt labels, pulse catch (manual 3.6 and 3.8)."""

from .model import FastCounter

_SINGLE = {
    **{235 + number: (number,) for number in range(6)},
    241: (0, 1), 242: (2, 3), 243: (4, 5), 244: (0, 1, 6), 245: (2, 3, 7),
}  # fmt: skip
_PAIRS = ((0, 1), (0, 1, 2), (3, 4, 5), (0, 1, 2, 6), (3, 4, 5, 7))


def _counter(mode: str, inputs: tuple[int, ...], khz: int) -> FastCounter:
    counting = 1 if mode == "single" else 2
    reset, start = (*inputs[counting:], None, None)[:2]
    return FastCounter(mode, inputs[:counting], reset, start, khz, hardware=False)


# X0 and X1 have the filter of 20 us, X2 to X5 that of 50 us; C251 counts up to 50 kHz.
FAST_COUNTERS = {
    **{number: _counter("single", inputs, 50 if inputs[0] < 2 else 10) for number, inputs in _SINGLE.items()},
    **{246 + place: _counter("up/down", inputs, 50 if inputs[0] < 2 else 10) for place, inputs in enumerate(_PAIRS)},
    **{251 + place: _counter("phases", inputs, 50 if inputs[0] < 2 else 10) for place, inputs in enumerate(_PAIRS)},
}

# 3.8: label -> the mask that forbids it. I000 to I501: the hundreds are the input, the last digit tells a rising edge.
EDGES = {100 * number + rising: (number, bool(rising)) for number in range(6) for rising in (0, 1)}
TIMED = {100 * timer + ms: ms for timer in (6, 7, 8) for ms in range(1, 100)}
_MATCHES = range(10, 70, 10)  # I010 to I060, of HSCS
_MASKED = {
    **{event: 8050 + number for event, (number, _) in EDGES.items()},
    **{event: 8050 + event // 100 for event in TIMED},
    **dict.fromkeys(_MATCHES, 8059),
}
# I502 to I506, the ends of pulses at Y0 to Y4: here a relay lets them ask (docs/decisions.md).
EVENTS = _MASKED | {502 + output: 8090 + output for output in range(5)}

RELAYS = {"capture": 8170, "fourfold": 7944}  # M(7944 + n) for C(n): M8195 for C251
H2U = {
    "fast_counters": FAST_COUNTERS, "events": EVENTS, "masked_events": frozenset(_MASKED), "edge_events": EDGES, "timed_ms": TIMED,
    "captures": 6, "captures_when_enabled": True,
}  # fmt: skip
H1U = H2U | {"events": {event: relay for event, relay in _MASKED.items() if event not in TIMED}, "timed_ms": {}}
