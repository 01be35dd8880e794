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

RELAYS = {"capture": 8170}
H2U = {"fast_counters": FAST_COUNTERS}
