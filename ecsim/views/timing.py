"""Signals over time as pieces of SVG: what a stretch of a lane looks like, of a bit, of a word as a curve, of values that hold.

A piece is drawn from changes, (time in us, value), the first one the value at the beginning; None is no value. Where several
edges fall into one pixel a solid bar stands for them: what is too fast to be drawn is told, and never left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .labels import figure
from .lettering import width
from .svg import element, escape, number

LOW, HIGH = 28, 8  # of a bit in its lane
TOP, BOTTOM = 8, 30  # of a segment
CURVE_TOP, CURVE_BOTTOM = 10, 54
SLANT = 4  # half of a crossing between two segments
PIN = 10  # a pulse of one scan is drawn at least as wide
LETTERS = 11

Changes = Sequence[tuple[int, int | None]]


@dataclass(frozen=True, slots=True)
class Stretch:
    """A stretch of time, `begin` to `end` in us, and how many us a pixel holds; the last value holds until `known`, which may lie behind."""

    begin: int
    end: int
    us_per_px: float
    known: int = 0

    def x(self, time: float) -> float:
        """Where a moment stands in the piece."""
        return (time - self.begin) / self.us_per_px

    @property
    def width(self) -> float:
        return self.x(self.end)

    def segments(self, changes: Changes) -> list[tuple[float, float, int]]:
        """The values that hold in it, from x to x; the ends may lie outside."""
        after = [*changes[1:], (max(self.end, self.known), None)] if changes else []
        return [(self.x(time), self.x(later), value) for (time, value), (later, _) in zip(changes, after, strict=True) if value is not None]


def bit(changes: Changes, stretch: Stretch, scan_us: float) -> str:
    """A bit: a thin line low, a thick one with a wash high, a pin for one scan, a solid bar where a pixel holds several edges."""
    segments = stretch.segments(changes)
    highs = [(left, right) for left, right, value in segments if value]
    crowds = _crowds([x for high in highs for x in high])
    one_scan = 1.5 * scan_us / stretch.us_per_px
    pins, bars, blocks, low = [], set(), [], ""
    for place, (left, right) in enumerate(highs):
        before = highs[place - 1][1] if place else -PIN
        after = highs[place + 1][0] if place + 1 < len(highs) else right + PIN
        if right - left < PIN and right - left <= one_scan and min(left - before, after - right) >= PIN / 2:
            pins.append((left + right) / 2)
            continue
        bars |= {crowd for crowd in (crowds[2 * place], crowds[2 * place + 1]) if crowd[0] != crowd[1]}
        if crowds[2 * place] != crowds[2 * place + 1]:
            blocks.append((crowds[2 * place][1], crowds[2 * place + 1][0]))
    for left, right, value in segments:
        if not value and right - left >= 1:
            low += _clipped(left, right, stretch, LOW)
    low += "".join(f"M{number(x)} {LOW}V{HIGH}" for block in blocks for x in block if 0 <= x < stretch.width)
    pins = [x for x in pins if 0 <= x < stretch.width]
    return "".join(
        (
            _path("hi-fill", "".join(_bar(left, right, stretch) for left, right in blocks)),
            _path("bit-line", low),
            _path("hi-line", "".join(_clipped(left, right, stretch, HIGH) for left, right in blocks)),
            _path("dense", "".join(_bar(left, max(right, left + 1), stretch) for left, right in sorted(bars))),
            _path("pin", "".join(f"M{number(x)} {LOW}V{HIGH}" for x in pins)),
            _path("pin-head", "".join(f"M{number(x - PIN / 2)} {HIGH - 5}h{PIN}l-5 7z" for x in pins)),
        )
    )


def _crowds(edges: list[float]) -> list[tuple[float, float]]:
    """For each edge the first and the last of those that lie less than a pixel from one to the next."""
    found: list[tuple[float, float]] = []
    first = 0
    for place, x in enumerate(edges):
        if place + 1 == len(edges) or edges[place + 1] - x >= 1:
            found += [(edges[first], x)] * (place + 1 - first)
            first = place + 1
    return found


def curve(changes: Changes, stretch: Stretch, low: float, high: float) -> str:
    """A word as a line between two values; a pixel with several values is a line from the least to the greatest."""
    scale = (CURVE_BOTTOM - CURVE_TOP) / ((high - low) or 1)

    def y(value: float) -> str:
        return number(CURVE_BOTTOM - (value - low) * scale)

    segments = [segment for segment in stretch.segments(changes) if segment[1] > 0 and segment[0] < stretch.width]
    if not segments:
        return ""
    path, at = f"M{number(max(0.0, segments[0][0]))} {y(segments[0][2])}", 0
    while at + 1 < len(segments):
        first, x = at, segments[at + 1][0]
        while at + 1 < len(segments) and int(segments[at + 1][0]) == int(x):
            at += 1
        values = [value for _, _, value in segments[first : at + 1]]
        crowded = at - first > 1
        path += (
            f"H{number(int(x) + 0.5 if crowded else x)}" + (f"V{y(min(values))}V{y(max(values))}" if crowded else "") + f"V{y(values[-1])}"
        )
    return _path("word-line", f"{path}H{number(min(stretch.width, segments[-1][1]))}")


def bus(changes: Changes, stretch: Stretch, words: Callable[[int], str], kind: str = "") -> tuple[str, str]:
    """Values that hold as segments, crossing where they change, and their words, to be laid over all pieces.

    Segments too narrow for that are a solid bar; words stand where there is room for them, at the beginning of a segment.
    """
    fills, lines, bars, letters = "", "", "", ""
    middle = (TOP + BOTTOM) // 2
    for left, right, value in stretch.segments(changes):
        if right <= 0 or left >= stretch.width:
            continue
        begins, ends = left > 0, right < stretch.width
        if right - left < 2 * SLANT:
            bars += _bar(left, right, stretch, TOP, BOTTOM)
            continue
        a, b = max(0.0, left), min(stretch.width, right)
        inner_a, inner_b = a + SLANT * begins, b - SLANT * ends
        start = f"M{number(a)} {middle}L{number(inner_a)} {TOP}" if begins else f"M{number(a)} {TOP}"
        edge = f"H{number(inner_b)}" + (f"L{number(b)} {middle}L{number(inner_b)} {BOTTOM}" if ends else "")
        lower = f"{'' if ends else f'M{number(b)} {BOTTOM}'}H{number(inner_a)}" + (f"L{number(a)} {middle}" if begins else "")
        lines += start + edge + lower
        fills += start + edge + ("" if ends else f"V{BOTTOM}") + f"H{number(inner_a)}Z"
        said = words(value)
        if begins and said and width(said, LETTERS, True) + 2 * PIN <= right - left:
            letters += element("text", escape(said), class_=f"bus-text {kind}".rstrip(), x=left + PIN, y=middle + 4)
    extra = f" {kind}" if kind else ""
    return _path(f"bus-fill{extra}", fills) + _path(f"bus{extra}", lines) + _path(f"dense{extra}", bars), letters


def ticks(begin: int, least: int) -> tuple[int, int, int]:
    """The first mark of a scale, its step in us, at least `least`, and into how many parts a step is cut."""
    power = 10 ** (len(str(least)) - 1)
    step, parts = next((power * factor, parts) for factor, parts in ((1, 5), (2, 4), (5, 5), (10, 5)) if power * factor >= least)
    return -(-begin // step) * step, step, parts


def clock_text(us: int, step: int) -> str:
    """A moment beside a mark of a scale, in seconds with as many digits as the step needs."""
    digits = next(digits for digits in range(7) if step % 10 ** (6 - digits) == 0)
    return f"{us / 1e6:,.{digits}f}".replace("-", "−")


def nice_range(low: int, high: int) -> tuple[int, int]:
    """The scale of a curve: 0 and round numbers around what it shows, so that it seldom has to change."""
    return -_above(-low) if low < 0 else 0, _above(high) if high > 0 else 0


def _above(value: int) -> int:
    power = 10 ** (len(str(value)) - 1)
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= value)


def range_text(low: int, high: int) -> str:
    """What stands at the top line of a curve."""
    return figure(high if high > 0 else low)


def _path(class_: str, d: str) -> str:
    return f'<path class="{class_}" d="{d}"/>' if d else ""


def _bar(left: float, right: float, stretch: Stretch, top: float = HIGH, bottom: float = LOW) -> str:
    a, b = max(0.0, left), min(stretch.width, right)
    return f"M{number(a)} {top}H{number(b)}V{bottom}H{number(a)}Z" if b > a else ""


def _clipped(left: float, right: float, stretch: Stretch, y: float) -> str:
    a, b = max(0.0, left), min(stretch.width, right)
    return f"M{number(a)} {y}H{number(b)}" if b > a else ""
