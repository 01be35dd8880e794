"""The sequential function chart of a program's STL sections, as SVG, as text and with the steps that are active."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from ..assembler.program import Program, Unit
from ..devices import Device
from ..models import Model, get_model
from . import svg as s
from .chart_layout import ChartLayout, Jump, Node, Sketch
from .chart_live import ChartLive
from .chart_text import draw
from .conditions import Condition, phrase
from .flows import Action, Flow, Part, Step, Transition, part_list, parts
from .labels import Labels
from .lettering import cut, width
from .rungs import Word
from .symbols import counts, group, preset_text, value_room

EDGE, BETWEEN, NATURAL = 12, 40, 960
STEP, HIGH, ROW, LETTER, TIME = 58, 40, 26, 20, 54
BAND, SLACK = 480, 16  # the height of a band, and by how much its signs reach beyond their places
KEPT = 4  # sheets of a chart, each for a width
ACTION, LONGEST, BAR = 124, 320, 12


def chart(part: Program | Unit, program: Program | None = None) -> Chart:
    """The chart of a program's main unit; for a unit alone the program gives the names."""
    if isinstance(part, Program):
        return Chart(part.main, part)
    return Chart(part, program)


class Chart:
    """Flows of steps. A drawing: `svg()` gives the picture at rest, `state(plc)` what changes in it."""

    def __init__(self, unit: Unit, program: Program | None = None):
        self.unit, self.program = unit, program
        self.model: Model = program.model if program else get_model("EC20")
        self.labels = Labels(unit, program)
        self.parts: tuple[Part, ...] = () if unit.closed else parts(unit)  # a password closes it (2.1.11)
        self._sheets: dict[int | None, ChartSheet] = {}
        self._drawn: int | None = None

    @property
    def flows(self) -> list[Flow]:
        """The flows, without the ladder blocks between them."""
        return [part for part in self.parts if isinstance(part, Flow)]

    @property
    def steps(self) -> list[Step]:
        """Every STL of every flow, in order."""
        return [step for flow in self.flows for step in flow.steps]

    def instruction_list(self) -> list[Word]:
        """The instructions of the whole unit, ladder blocks and flows."""
        return part_list(self.parts)

    def svg(self, prefix: str = "", width: int | None = None) -> str:
        """The picture at rest, `width` px wide or as much more as a flow needs; every id begins with `prefix`."""
        self._drawn = width
        return self.sheet(width).picture(prefix)

    def state(self, moment) -> dict[str, str]:
        """What changes in the picture last drawn, by "key:attribute".

        `moment` is the Plc, or a Session, which also knows since when each step is active.
        """
        return self.sheet(self._drawn).live.state(moment)

    def sheet(self, width: int | None = None) -> ChartSheet:
        """The chart laid out for a width, from which single bands can be had; the last few widths are kept."""
        if width not in self._sheets:
            if len(self._sheets) >= KEPT:
                del self._sheets[next(iter(self._sheets))]
            self._sheets[width] = ChartSheet(self, width)
        return self._sheets[width]

    def _repr_svg_(self) -> str:
        return s.standalone(self.svg())

    def __str__(self) -> str:
        return draw(self)

    def __repr__(self) -> str:
        count, flows = len(self.steps), len(self.flows)
        return f"<Chart, {count} step{'s' if count != 1 else ''} in {flows} flow{'s' if flows != 1 else ''}>"


# -- lengths ----------------------------------------------------------------------------------------------------


@dataclass
class ChartLengths:
    """The look's lengths for `ChartLayout`."""

    labels: Labels
    model: Model
    above: float = 28
    below: float = 26
    diverge: float = 18
    enter: float = 22
    merge: float = 20
    overhang: float = 22
    double: float = 5
    pitch: float = 230
    skip: float = 176
    free: float = 20
    jump: float = 30
    longest: float = LONGEST
    drawn: dict[int, Condition] = field(default_factory=dict)

    def snap(self, x: float) -> float:
        return x

    def condition(self, transition: Transition) -> Condition:
        """The drawn condition of a transition."""
        if id(transition) not in self.drawn:
            self.drawn[id(transition)] = Condition(transition.condition, self.labels)
        return self.drawn[id(transition)]

    def node(self, node: Node) -> tuple[float, float, float]:
        actions = node.step.actions if node.step else ()
        room = max((action_width(action, self.labels, self.longest) for action in actions), default=0)
        if node.joins:
            chips = 40 + sum(chip_width(device) + 6 for device in node.devices) + 150
            return BAR, max(chips, 43 + room if actions else 0), 34 + ROW * len(actions)
        return STEP / 2 + TIME, max(STEP / 2 + (14 + room if actions else 8), self._name(node)), max(HIGH, ROW * len(actions))

    def _name(self, node: Node) -> float:
        """A step's name stands at its right where no action does."""
        name = self.labels.named(node.devices[0]).name
        return STEP / 2 + 10 + min(140, width(name)) if name and not (node.step and node.step.actions) else 0

    def transition(self, transition: Transition) -> tuple[float, float, float, float]:
        condition = self.condition(transition)
        return BAR + 2, BAR + 6 + condition.width + 6, condition.up + 14, condition.down + 13

    def arrow(self, jump: Jump) -> tuple[float, float]:
        return 8, 16 + width(str(jump), 13, True)


def chip_width(device: Device) -> float:
    return max(38, width(str(device), 11, True) + 14)


def action_words(action: Action, labels: Labels) -> tuple[str, str]:
    """What an action names, as name and address; a box with several operands has them all in the address."""
    places = [place for place, operand in enumerate(action.word.operands)]
    if counts(action.word) or len(places) == 1:
        label = labels.of(action.word, 0)
        return label.name, label.address
    words = [labels.of(action.word, place) for place in places]
    return "", " ".join(label.name or label.address for label in words)


def action_letter(action: Action) -> float:
    """How wide the cell of an action's qualifier is."""
    return max(LETTER, width(action.qualifier, 11, True) + 10)


def action_condition(action: Action, labels: Labels) -> str:
    words = phrase(action.condition, labels)
    return f"when {words}" if words else ""


def action_width(action: Action, labels: Labels, longest: float = LONGEST) -> float:
    """How wide an action is drawn."""
    name, address = action_words(action, labels)
    room = action_letter(action) + 16 + (width(name) + 4 if name else 0) + width(address, 11, True)
    room += value_room(action.word) if counts(action.word) else 0
    when = action_condition(action, labels)
    room += width(when, 11) + 10 if when else 0
    return min(longest, max(ACTION, room))


Line = tuple[float, float, float, float, bool]  # x1, y1, x2, y2, twice


# -- a sheet ----------------------------------------------------------------------------------------------------


@dataclass
class Band:
    """What begins within BAND px of a sheet's height, and from where to where it reaches, in px."""

    top: float
    bottom: float
    marks: list[tuple[Node | Transition | Jump, float, float]] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)

    def reach(self, top: float, bottom: float) -> None:
        self.top, self.bottom = min(self.top, top), max(self.bottom, bottom)


class ChartSheet:
    """A chart laid out for one width: flows side by side as far as they fit, then below one another.

    A page that shows only a part of a large chart takes the `shell` and those of the `bands` that it looks at.
    """

    def __init__(self, chart: Chart, asked: int | None):
        self.labels, self.model, self.unit = chart.labels, chart.model, chart.unit
        asked = asked or NATURAL
        self.lengths = ChartLengths(chart.labels, chart.model, longest=min(LONGEST, max(ACTION, asked - 2 * EDGE - TIME - STEP - 22)))
        self.places: list[tuple[Sketch, float, float]] = []  # each sketch with its axis and top
        sketches = [sketch for flow in chart.flows for sketch in ChartLayout(self.lengths).flow(flow)]
        x, top, low, self.width = float(EDGE), float(EDGE), float(EDGE), float(asked)
        for sketch in sketches:
            room = sketch.left + sketch.right
            if x > EDGE and x + room > asked - EDGE:
                x, top = float(EDGE), low + BETWEEN
            self.places.append((sketch, x + sketch.left, top))
            self.width = max(self.width, x + room + EDGE)
            low = max(low, top + sketch.height)
            x += room + BETWEEN
        self._centre(asked)
        self.height = low + EDGE
        self.bands, self._long = self._in_bands()
        self.live = ChartLive(self, chart.program)

    def _centre(self, asked: float) -> None:
        """A single flow stands in the middle of the sheet, as far as it is narrower."""
        if len(self.places) == 1:
            sketch, _, top = self.places[0]
            free = self.width - 2 * EDGE - sketch.left - sketch.right
            self.places[0] = (sketch, EDGE + sketch.left + max(0.0, free) / 2, top)

    def marks(self) -> Iterator[tuple[Node | Transition | Jump, float, float]]:
        """Everything that is drawn, in its place on the sheet."""
        for sketch, x, y in self.places:
            for mark in sketch.marks:
                yield mark.what, x + mark.x, y + mark.y

    def lines(self) -> Iterator[Line]:
        """Every line in its place on the sheet."""
        for sketch, x, y in self.places:
            for x1, y1, x2, y2, twice in sketch.lines:
                yield x + x1, y + y1, x + x2, y + y2, twice

    @staticmethod
    def band_of(y: float) -> int:
        """The number of the band in which a height lies."""
        return int(y // BAND)

    def _in_bands(self) -> tuple[list[Band], list[Line]]:
        """The bands, and the lines that are longer than one."""
        bands = [Band(BAND * number, BAND * (number + 1)) for number in range(self.band_of(self.height) + 1)]
        long = []
        for what, x, y in self.marks():
            if isinstance(what, Transition):
                up, down = self.lengths.transition(what)[2:]
            else:
                up, down = 0, self.lengths.jump if isinstance(what, Jump) else self.lengths.node(what)[2]
            band = bands[self.band_of(y)]
            band.marks.append((what, x, y))
            band.reach(y - up - SLACK, y + down + SLACK)
        for line in self.lines():
            low, high = sorted((line[1], line[3]))
            if high - low > BAND:
                long.append(line)
                continue
            band = bands[self.band_of(low)]
            band.lines.append(line)
            band.reach(low, high + SLACK)
        return bands, long

    def boxes(self) -> dict[str, tuple[int, int, int]]:
        """Each step's box: its left and top edge in px, and the number of its band."""
        nodes = ((what, x, y) for what, x, y in self.marks() if isinstance(what, Node) and not what.joins)
        return {str(node.devices[0]): (round(x - STEP / 2), round(self._box_top(node, y)), self.band_of(y)) for node, x, y in nodes}

    # -- the picture --------------------------------------------------------------------------------------------

    def picture(self, prefix: str) -> str:
        """The root `<svg>` at rest with all bands."""
        return self._root(self._content(self.marks(), self.lines(), prefix))

    def shell(self) -> str:
        """The root `<svg>` in its whole size, with nothing but the lines that are longer than a band."""
        return self._root("".join(self._paths(self._long)))

    def band(self, number: int, prefix: str) -> str:
        """One band at rest, in its place on the sheet."""
        band = self.bands[number]
        return s.element("g", self._content(band.marks, band.lines, prefix))

    def _root(self, content: str) -> str:
        count = sum(isinstance(what, Node) and not what.joins for what, _, _ in self.marks())
        label = f"Chart of {self.unit.name}, {count} step{'s' if count != 1 else ''}"
        size = {"width": self.width, "height": self.height, "viewBox": f"0 0 {s.number(self.width)} {s.number(self.height)}"}
        return s.element("svg", content, xmlns="http://www.w3.org/2000/svg", class_="ec sfc", role="img", aria_label=label, **size)

    def _content(self, marks: Iterable[tuple[Node | Transition | Jump, float, float]], lines: Iterable[Line], prefix: str) -> str:
        plates, symbols = [], []
        for what, x, y in marks:
            if isinstance(what, Transition):
                plates.append(self._plate(what, x, y, prefix))
                symbols.append(self._transition(what, x, y, prefix))
            elif isinstance(what, Jump):
                symbols.append(self._jump(what, x, y))
            else:
                symbols += self._join(what, x, y, prefix) if what.joins else self._step(what, x, y, prefix)
        return "".join([*plates, *self._paths(lines), *symbols])

    def _paths(self, lines: Iterable[Line]) -> Iterator[str]:
        plain, double = [], []
        for x1, y1, x2, y2, twice in lines:
            for offset in (0, self.lengths.double) if twice else (0,):
                start = f"M{s.number(x1)} {s.number(y1 + offset)}"
                path = start + (f"H{s.number(x2)}" if y1 == y2 else f"V{s.number(y2)}")
                (double if twice else plain).append(path)
        if plain:
            yield s.element("path", None, class_="link", d="".join(plain))
        if double:
            yield s.element("path", None, class_="link dbl", d="".join(double))

    def _step(self, node: Node, x: float, y: float, prefix: str) -> Iterator[str]:
        device = node.devices[0]
        label, left = self.labels.named(device), x - STEP / 2
        actions = node.step.actions if node.step else ()
        y = self._box_top(node, y)
        program_step = f"program step {node.step.opening.words[0].step}" if node.step else ""
        parts = [s.tip("\n".join(filter(None, [str(label), node.step.title if node.step else "", program_step])))]
        parts.append(s.element("rect", None, class_="box", x=left, y=y, width=STEP, height=HIGH, rx=2))
        if device.number < self.model.initial_steps:
            parts.append(s.element("rect", None, class_="inner", x=left + 3.5, y=y + 3.5, width=STEP - 7, height=HIGH - 7, rx=1))
        parts.append(s.text(x, y + 24.5, str(device), "step-id"))
        parts.append(s.element("circle", None, class_="token", cx=x, cy=y + 31, r=3.25))
        yield s.element("g", "".join(parts), id=f"{prefix}{device}", class_="step", data_device=str(device), aria_label=str(label))
        yield s.text(left - 9, y + 24, "", "step-time end", id=f"{prefix}t{device}")
        octagon = f"M{s.number(left - 6.3)} {s.number(y - 11)}h6.6l4.7 4.7v6.6l-4.7 4.7h-6.6l-4.7 -4.7v-6.6z"
        yield s.element("path", None, id=f"{prefix}k{device}", class_="breakpoint none", d=octagon)
        if actions:
            yield f'<path class="link" d="M{s.number(x + STEP / 2)} {s.number(y + 20)}h14"/>'
            top = y + 20 - ROW * len(actions) / 2 if len(actions) < 3 else y + 20 - ROW / 2
            yield from self._actions(actions, x + STEP / 2 + 14, top, prefix)
        elif label.name:
            yield s.text(x + STEP / 2 + 10, y + 24, cut(label.name, 140), "el-name")

    @staticmethod
    def _box_top(node: Node, y: float) -> float:
        """A step's box stands in the middle of one or two actions, beside the first of more."""
        rows = len(node.step.actions) if node.step else 0
        return y + (ROW * rows - HIGH) / 2 if rows < 3 and ROW * rows > HIGH else y

    def _actions(self, actions: tuple[Action, ...], x: float, y: float, prefix: str) -> Iterator[str]:
        room = max(action_width(action, self.labels, self.lengths.longest) for action in actions)
        for row, action in enumerate(actions):
            yield self._action(action, x, y + ROW * row, room, prefix)

    def _action(self, action: Action, x: float, y: float, room: float, prefix: str) -> str:
        letter = action_letter(action)
        name, address = action_words(action, self.labels)
        when = action_condition(action, self.labels)
        right = x + room - 8
        free, taken = room - letter - 16, 0.0
        parts = [
            s.element("rect", None, class_="frame", x=x, y=y, width=room, height=ROW),
            s.element("rect", None, class_="q", x=x, y=y, width=letter, height=ROW),
            s.text(x + letter / 2, y + 17, action.qualifier, "q-text"),
        ]
        if counts(action.word):
            preset = s.escape(preset_text(action.word))
            taken = value_room(action.word)
            value = f'<tspan id="{prefix}v{action.word.position}"></tspan><tspan class="dim"> of {preset}</tspan>'
            parts.append(s.element("text", value, class_="el-value end", x=right, y=y + 17))
            free -= taken
        if when:
            named = (width(name) + 4 if name else 0) + width(address, 11, True) + 10
            words = cut(when, max(40, free - named) + 1, 11)
            parts.append(s.text(right - taken, y + 17, words, "el-edge end"))
            free -= width(words, 11) + 8
        address = cut(address, free - (width(name) + 4 if name else 0) + 2, 11, True)
        alone = "" if name else " alone"
        size = "" if name else ' style="font-size:11px"' if len(action.word.operands) > 1 else ""
        letters = (s.escape(cut(name, free)) + " " if name else "") + f'<tspan class="el-addr{alone}"{size}>{s.escape(address)}</tspan>'
        parts.append(s.element("text", letters, class_="el-name", x=x + letter + 8, y=y + 17))
        return group("".join(parts), "action", action.word, self.labels, prefix)

    def _plate(self, transition: Transition, x: float, y: float, prefix: str) -> str:
        condition = self.lengths.condition(transition)
        high = condition.up + condition.down
        return s.element(
            "rect", None, id=f"{prefix}p{transition.position}", class_="wait-plate",
            x=x + 4, y=y - condition.up, width=condition.width + BAR + 12, height=high, rx=3,
        )  # fmt: skip

    def _transition(self, transition: Transition, x: float, y: float, prefix: str) -> str:
        condition = self.lengths.condition(transition)
        words = phrase(transition.condition, self.labels) or "always"
        bar = s.element(
            "path", None, id=f"{prefix}b{transition.position}", class_="tbar", d=f"M{s.number(x - BAR)} {s.number(y)}h{2 * BAR}"
        )
        inside = s.element("g", condition.draw(prefix), class_="cond", transform=f"translate({s.number(x + BAR + 6)} {s.number(y)})")
        return s.element("g", s.tip(words) + bar + inside, data_position=str(transition.position))

    def _join(self, node: Node, x: float, y: float, prefix: str) -> Iterator[str]:
        left = x + 20
        yield s.text(left, y + 21, "join", "el-edge")
        left += 30
        for device in node.devices:
            room = chip_width(device)
            inside = s.element("rect", None, x=left, y=y + 8, width=room, height=18, rx=2) + s.text(
                left + room / 2, y + 21, str(device), ""
            )
            yield s.element("g", inside, id=f"{prefix}j{node.step.opening.words[0].position}.{device}", class_="arrive")
            left += room + 6
        yield s.text(left + 4, y + 21, "", "el-edge", id=f"{prefix}w{node.step.opening.words[0].position}")
        if node.step.actions:
            yield from self._actions(node.step.actions, x + 43, y + 34, prefix)

    def _jump(self, jump: Jump, x: float, y: float) -> str:
        """A solid arrow with its target; the end of a flow is an arrow onto a line."""
        arrow = s.element("path", None, class_="arrow", d=f"M{s.number(x - 6)} {s.number(y + 2)}h12l-6 12z")
        if jump.target is None:
            return (
                arrow
                + f'<path class="link dbl" d="M{s.number(x - 10)} {s.number(y + 15)}h20"/>'
                + s.text(x + 16, y + 14, str(jump), "el-edge")
            )
        return arrow + s.text(x + 16, y + 13, str(jump), "step-id")
