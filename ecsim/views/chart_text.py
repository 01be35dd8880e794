"""The chart in box-drawing characters, for terminals and for outputs that are compared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .canvas import DOWN, UP, Canvas
from .chart_layout import ChartLayout, Jump, Node, Sketch
from .conditions import phrase
from .flows import Action, Transition
from .labels import Labels
from .lettering import columns, cut_columns, padded

if TYPE_CHECKING:
    from .sfc import Chart

LONGEST = 48  # columns of an action or condition
HALF = 3  # a step's box reaches so many cells to each side of its axis


@dataclass(frozen=True)
class ChartCells:
    """Lengths in character cells for `ChartLayout`."""

    labels: Labels
    above: int = 1
    below: int = 1
    diverge: int = 0
    enter: int = 1
    merge: int = 1
    overhang: int = 3
    double: int = 0
    pitch: int = 14
    skip: int = 10
    free: int = 2
    jump: int = 1

    def snap(self, x: float) -> float:
        return int(x)

    def node(self, node: Node) -> tuple[float, float, float]:
        if node.joins:
            return 2, 3 + columns(join_text(node)), 2
        actions = node.step.actions if node.step else ()
        room = max((4 + columns(action_text(action, self.labels)) for action in actions), default=0)
        name = self.labels.named(node.devices[0]).name
        return HALF, HALF + max(room, 2 + columns(name) if name and not actions else 0), max(3, 1 + len(actions))

    def transition(self, transition: Transition) -> tuple[float, float, float, float]:
        return 1, 3 + columns(condition_text(transition, self.labels)), 1, 1

    def arrow(self, jump: Jump) -> tuple[float, float]:
        return 0, 2 + columns(str(jump))


def action_text(action: Action, labels: Labels) -> str:
    """An action on one line: qualifier, what it acts on, and when."""
    operands = [labels.of(action.word, place) for place in range(len(action.word.operands))]
    words = " ".join([action.qualifier, *(f"{label.name}({label.address})" if label.name else label.address for label in operands)])
    when = phrase(action.condition, labels)
    return cut_columns(f"{words}, when {when}" if when else words, LONGEST)


def condition_text(transition: Transition, labels: Labels) -> str:
    return cut_columns(phrase(transition.condition, labels) or "always", LONGEST)


def join_text(node: Node) -> str:
    return f"join {' '.join(map(str, node.devices))}"


def draw(chart: Chart) -> str:
    """All flows below one another."""
    pictures = []
    for flow in chart.flows:
        for sketch in ChartLayout(ChartCells(chart.labels)).flow(flow):
            pictures.append(_sheet(chart, sketch))
    return "\n\n".join(pictures)


def _sheet(chart: Chart, sketch: Sketch) -> str:
    canvas = Canvas()
    axis = int(sketch.left) + 2
    doubles = []
    for x1, y1, x2, y2, double in sketch.lines:
        start, end = axis + int(x1), axis + int(x2)
        if double:
            doubles.append((int(y1), start, end))
        elif y1 == y2:
            canvas.horizontal(int(y1), start, end)
        else:
            canvas.vertical(start, int(y1), int(y2))
    for row, start, end in doubles:
        for column in range(start, end + 1):
            sides = canvas.lines.get((row, column), 0)
            canvas.write(row, column, {UP: "╧", DOWN: "╤", UP | DOWN: "╪"}.get(sides & (UP | DOWN), "═"))
    for mark in sketch.marks:
        _mark(canvas, chart, mark.what, axis + int(mark.x), int(mark.y))
    return canvas.text()


def _mark(canvas: Canvas, chart: Chart, what: Node | Transition | Jump, x: int, y: int) -> None:
    if isinstance(what, Transition):
        canvas.write(y, x - 1, f"─┼─ {condition_text(what, chart.labels)}")
    elif isinstance(what, Jump):
        canvas.write(y, x, f"▼ {what}")
    elif what.joins:
        canvas.write(y + 1, x + 2, join_text(what))
    else:
        _step(canvas, chart, what, x, y)


def _step(canvas: Canvas, chart: Chart, node: Node, x: int, y: int) -> None:
    device = node.devices[0]
    initial = device.number < chart.model.initial_steps
    entered = canvas.lines.get((y, x), 0) & UP
    left = canvas.lines.get((y + 2, x), 0) & DOWN
    line, side, corners, joints = ("═", "║", "╔╗╚╝", "╧╤") if initial else ("─", "│", "┌┐└┘", "┴┬")
    half = line * (HALF - 1)
    canvas.write(y, x - HALF, corners[0] + half + (joints[0] if entered else line) + half + corners[1])
    canvas.write(y + 1, x - HALF, side + padded(str(device), 2 * HALF - 1, "^") + side)
    canvas.write(y + 2, x - HALF, corners[2] + half + (joints[1] if left else line) + half + corners[3])
    actions = node.step.actions if node.step else ()
    for row, action in enumerate(actions):
        if row == 0:
            canvas.write(y + 1, x + HALF, "╟─" if initial else "├─")
        canvas.write(y + 1 + row, x + HALF + 3, action_text(action, chart.labels))
    name = chart.labels.named(device).name
    if name and not actions:
        canvas.write(y + 1, x + HALF + 2, name)
