"""The timing chart of a failing moment: some lanes over some seconds, as data, as SVG and as text. The lanes at fault are marked."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import floor, log10
from typing import Any

from ..views.svg import element, number, text
from .rules import Finding, Rule, worded
from .run import STEP, Trace
from .signals import Signal, value_at

MOST_LANES = 12
MARGIN_S = 2.0  # before and behind the stretch at fault at least
LONGEST_S = 60.0  # so much of a long stretch is shown from its beginning


@dataclass(frozen=True)
class Lane:
    """One signal in the chart. `kind` is bit, word (a curve) or text (segments); `changes` are (second, value), the first at the chart's start."""

    name: str
    address: str
    kind: str
    changes: tuple[tuple[float, Any], ...]
    marked: bool = False


@dataclass(frozen=True)
class Chart:
    """`lanes` from second `start` to `end` of the run; `bad` is the stretch at fault and `moment` when it was known."""

    start: float
    end: float
    moment: float
    bad: tuple[float, float]
    note: str
    lanes: tuple[Lane, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> "Chart":
        """The chart that `as_dict` gave."""
        lanes = tuple(
            Lane(lane["name"], lane["address"], lane["kind"], tuple(map(tuple, lane["changes"])), lane["marked"]) for lane in data["lanes"]
        )
        return cls(data["start"], data["end"], data["moment"], tuple(data["bad"]), data["note"], lanes)

    def svg(self, prefix: str = "chart") -> str:
        """The picture; `prefix` makes its ids unique on a page. Its style is the report's."""
        return _Drawing(self, prefix).picture()

    def __str__(self) -> str:
        return as_text(self)


def chart_of(trace: Trace, rule: Rule, finding: Finding) -> Chart:
    """The seconds around a finding: the rule's lanes, marked, and those of the machine that change there."""
    since, until = trace.seconds(finding.since), trace.seconds(max(finding.until, finding.scan))
    moment = trace.seconds(finding.scan)
    shown_until = min(until, max(since + LONGEST_S, moment))
    margin = max(MARGIN_S, 0.3 * (shown_until - since))
    first = max(0, round((since - margin) / trace.period_s))
    last = min(trace.end, round((shown_until + margin) / trace.period_s))
    marked, shown = ({trace.aliases.get(name, name) for name in names} for names in (rule.marked, (*rule.marked, *rule.lanes)))
    chosen = [lane for lane in trace.places if lane in shown]
    others = [lane for lane in trace.places if lane not in shown and lane != STEP and _moves(trace.lane(lane), first, last)]
    chosen += others[: max(0, MOST_LANES - len(chosen))]
    order = [lane for lane in sorted(trace.places, key=_outputs_first) if lane in chosen and lane != STEP]
    if STEP in trace.places:
        order.append(STEP)
    lanes = tuple(_lane(trace, lane, first, last, lane in marked) for lane in order)
    stretch = max(finding.until - finding.since, 1) * trace.period_s
    note = f"{stretch:.3g} s" if stretch < 300 else f"{stretch / 60:.1f} min"
    return Chart(trace.seconds(first), trace.seconds(last), moment, (since, min(until, trace.seconds(last))), note, lanes)


def _outputs_first(lane: str) -> int:
    return {"X": 0, "Y": 1}.get(lane[0], 2)


def _moves(signal: Signal, first: int, last: int) -> bool:
    return any(first < scan <= last for scan, _ in signal)


def _lane(trace: Trace, lane: str, first: int, last: int, marked: bool) -> Lane:
    signal = trace.lane(lane)
    start = value_at(signal, first)
    changes = [(trace.seconds(first), start), *((trace.seconds(scan), value) for scan, value in signal if first < scan < last)]
    values = [value for _, value in changes]
    if lane == STEP:
        kind, address = "text", "S"
    elif all(isinstance(value, bool) for value in values):
        kind, address = "bit", lane if lane in trace.names else ""
    elif all(isinstance(value, (int, float)) for value in values):
        kind, address = "word", lane if lane in trace.names else ""
    else:
        kind, address = "text", ""
        changes = [(when, worded(value)) for when, value in changes]
    return Lane(trace.names.get(lane, lane), address, kind, tuple((when, _plain(value)) for when, value in changes), marked)


def _plain(value: Any) -> Any:
    return int(value) if isinstance(value, bool) else round(value, 6) if isinstance(value, float) else value


# -- text -----------------------------------------------------------------------------------------------------------

COLUMNS = 60


def as_text(chart: Chart, columns: int = COLUMNS) -> str:
    """The chart in letters: a bit is low or a bar, `>` marks a lane at fault, `^` the moment."""
    width = max(len(lane.name) + len(lane.address) + 1 for lane in chart.lanes)
    span = max(chart.end - chart.start, 1e-9)
    place = max(0, min(columns - 1, int((chart.moment - chart.start) / span * columns)))
    rows = []
    for lane in chart.lanes:
        cells = _bits(lane, chart, columns) if lane.kind == "bit" else _segments(lane, chart, columns)
        name = f"{lane.name} {lane.address}" if lane.address else lane.name
        rows.append(f"{'>' if lane.marked else ' '} {name:<{width}} {cells}")
    scale = f"{chart.start:.2f} s"
    rows.append(f"  {'':<{width}} {scale}{chart.end:>{columns - len(scale) - 2}.2f} s")
    rows.append(f"  {'':<{width}} {' ' * place}^ {chart.moment:.3f} s")
    return "\n".join(rows)


def _bits(lane: Lane, chart: Chart, columns: int) -> str:
    """`_` low, `█` high, `|` where a column holds a change and back (one scan is seen)."""
    span = (chart.end - chart.start) / columns
    cells = []
    for column in range(columns):
        start, end = chart.start + column * span, chart.start + (column + 1) * span
        values = {_at(lane, start), *(value for when, value in lane.changes if start <= when < end)}
        cells.append("|" if len(values) > 1 else "█" if values.pop() else "_")
    return "".join(cells)


def _segments(lane: Lane, chart: Chart, columns: int) -> str:
    """Values one behind the other, each from the column in which it begins."""
    span = (chart.end - chart.start) / columns
    cells = [" "] * columns
    if len(lane.changes) > columns // 6:  # a curve: its value at some places
        wanted = [(chart.start + column * span, _at(lane, chart.start + column * span)) for column in range(0, columns, 12)]
    else:
        wanted = list(lane.changes)
    for (when, value), behind in zip(wanted, [*wanted[1:], (chart.end, None)], strict=True):
        first, last = int((when - chart.start) / span), min(columns, int((behind[0] - chart.start) / span))
        words = f"|{value:g}" if isinstance(value, (int, float)) else f"|{value}"
        cells[first:last] = list(words[: last - first].ljust(last - first))
    return "".join(cells[:columns])


def _at(lane: Lane, when: float) -> Any:
    return value_at(list(lane.changes), when)


# -- picture --------------------------------------------------------------------------------------------------------

LEFT, RIGHT, WIDTH = 150, 20, 1000
TOP, BIT, CURVE = 58, 34, 60  # heights


class _Drawing:
    """One chart as SVG."""

    def __init__(self, chart: Chart, prefix: str):
        self.chart, self.prefix = chart, prefix
        self.heights = [CURVE if lane.kind == "word" else BIT for lane in chart.lanes]
        self.height = TOP + sum(self.heights) + 2
        self.scale = (WIDTH - LEFT - RIGHT) / max(chart.end - chart.start, 1e-9)

    def x(self, when: float) -> float:
        return LEFT + (min(max(when, self.chart.start), self.chart.end) - self.chart.start) * self.scale

    def picture(self) -> str:
        chart, parts = self.chart, [self._hatch(), self._time()]
        y = TOP
        for lane, height in zip(chart.lanes, self.heights, strict=True):
            parts += self._lane(lane, y, height)
            parts.append(element("path", class_="lane-rule", d=f"M0 {number(y + height + 0.5)}H{WIDTH}"))
            y += height
        at = self.x(chart.moment)
        flag = max(LEFT + 54, min(at, WIDTH - 54))
        mark = [
            element("path", d=f"M{number(at)} 22V{number(self.height - 1)}"),
            element("rect", x=flag - 54, y=4, width=108, height=18, rx=2),
            text(flag, 17, f"{chart.moment:,.3f} s", "fail-time", text_anchor="middle"),
        ]
        parts.append(element("g", "".join(mark), class_="fail-mark"))
        label = f"Timing chart around {chart.moment:.3f} s: {', '.join(lane.name for lane in chart.lanes if lane.marked)}"
        box = f"0 0 {WIDTH} {self.height}"
        return element(
            "svg", "".join(parts), xmlns="http://www.w3.org/2000/svg", class_="trace", viewBox=box, width=WIDTH, height=self.height,
            role="img", aria_label=label,
        )  # fmt: skip

    def _hatch(self) -> str:
        line = element("rect", class_="bad-line", width=2, height=8)
        pattern = element(
            "pattern", line, id=f"{self.prefix}-hatch", width=8, height=8, patternUnits="userSpaceOnUse", patternTransform="rotate(-45)"
        )
        return element("defs", pattern)

    def _time(self) -> str:
        parts = []
        for when in ticks(self.chart.start, self.chart.end):
            x = self.x(when)
            parts.append(element("path", class_="vgrid", d=f"M{number(x)} 52V{number(self.height)}"))
            parts.append(text(x, 42, f"{when:,.6g}", "ax", text_anchor="middle"))
        parts.append(element("path", class_="lane-rule", d=f"M0 {TOP - 0.5}H{WIDTH}"))
        return "".join(parts)

    def _lane(self, lane: Lane, y: float, height: float) -> list[str]:
        middle = y + height / 2 + 4
        name = lane.name if len(lane.name) <= 14 else f"{lane.name[:13]}…"
        parts = [text(16, middle, name, "lane-name"), text(LEFT - 12, middle, lane.address, "lane-addr", text_anchor="end")]
        draw = {"bit": self._bit, "word": self._curve, "text": self._bus}[lane.kind]
        if lane.marked:
            first, last = (self.x(when) for when in self.chart.bad)
            width = max(last - first, 3)
            box = {"x": first, "y": y + 2, "width": width, "height": height - 4}
            parts.append(element("rect", class_="bad", **box))
            parts += draw(lane, y, height)
            parts.append(element("rect", class_="bad-hatch", fill=f"url(#{self.prefix}-hatch)", **box))
            parts.append(element("path", class_="bad-lane", d=f"M3 {number(y + 3)}V{number(y + height - 3)}"))
        else:
            parts += draw(lane, y, height)
        return parts

    def _stretches(self, lane: Lane) -> list[tuple[float, float, Any]]:
        ends = [when for when, _ in lane.changes[1:]] + [self.chart.end]
        return [(self.x(when), self.x(end), value) for (when, value), end in zip(lane.changes, ends, strict=True)]

    def _bit(self, lane: Lane, y: float, height: float) -> list[str]:
        high, low = y + 8, y + height - 8
        parts, line, bars = [], [], []
        for first, last, value in self._stretches(lane):
            line.append(f"{'L' if line else 'M'}{number(first)} {number(high if value else low)}H{number(last)}")
            if value:
                last = max(last, first + 3)  # one scan is seen
                parts.append(element("rect", class_="hi-fill", x=first, y=high, width=last - first, height=low - high))
                bars.append(f"M{number(first)} {number(high)}H{number(last)}")
        parts.append(element("path", class_="bit-line", d="".join(line)))
        if bars:
            parts.append(element("path", class_="hi-line", d="".join(bars)))
        return parts

    def _curve(self, lane: Lane, y: float, height: float) -> list[str]:
        values = [value for _, value in lane.changes]
        low, high = min(values), max(values)
        span = (high - low) or 1

        def at(value: float) -> str:
            return number(y + height - 10 - (value - low) / span * (height - 24))

        points = [f"{number(self.x(when))} {at(value)}" for when, value in _thinned(lane.changes, 400)]
        d = f"M{'L'.join(points)}H{number(self.x(self.chart.end))}" if len(values) > 8 else self._stairs(lane, at)
        labels = [text(LEFT + 6, y + 12, f"{high:,.6g}", "ax")]
        if high != low:
            labels.append(text(LEFT + 6, y + height - 2, f"{low:,.6g}", "ax"))
        return [element("path", class_="word-line", d=d), *labels]

    def _stairs(self, lane: Lane, at) -> str:
        return "".join(
            f"{'L' if place else 'M'}{number(first)} {at(value)}H{number(last)}"
            for place, (first, last, value) in enumerate(self._stretches(lane))
        )

    def _bus(self, lane: Lane, y: float, height: float) -> list[str]:
        parts = []
        for first, last, value in self._stretches(lane):
            if not value:
                parts.append(element("path", class_="bit-line", d=f"M{number(first)} {number(y + height / 2)}H{number(last)}"))
                continue
            parts.append(element("rect", class_="bus steps", x=first, y=y + 8, width=max(last - first, 2), height=height - 16, rx=2))
            room = int((last - first) / 6.8)
            words = str(value) if len(str(value)) <= room else f"{str(value)[: room - 1]}…" if room > 3 else ""
            if words:
                parts.append(text((first + last) / 2, y + height / 2 + 4, words, "bus-text steps", text_anchor="middle"))
        return parts


def _thinned(changes: Sequence[tuple[float, Any]], most: int) -> list[tuple[float, Any]]:
    """At most so many points of a curve, the last one among them."""
    stride = -(-len(changes) // most)
    return [*changes[::stride], changes[-1]]


def ticks(start: float, end: float) -> list[float]:
    """Round times for the scale, five to twelve of them."""
    span = max(end - start, 1e-6)
    step = 10 ** floor(log10(span / 5))
    for factor in (1, 2, 5, 10):
        if span / (step * factor) <= 12:
            step *= factor
            break
    first = floor(start / step) + (start % step > 1e-9)
    return [round(place * step, 9) for place in range(first, floor(end / step + 1e-9) + 1)]
