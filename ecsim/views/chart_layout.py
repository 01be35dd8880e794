"""Where everything of a flow lies, in any unit of length: steps below one another, branches side by side, jumps as arrows.

A flow is read as nested branches as far as it is one. What does not nest (a way into the middle of another branch, a way
back, a way into another flow) is a jump: an arrow with the name of its target. So every program can be drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Protocol

from ..devices import Device
from .flows import Flow, Step, Transition
from .rungs import Word

DEEPEST = 40  # branches nested deeper are reached by jumps


@dataclass(eq=False)
class Node:
    """A step or a join of a flow. A step that is only joined has no STL of its own and no contents."""

    devices: tuple[Device, ...]
    order: int
    step: Step | None = None
    legs: list[Leg] = field(default_factory=list)

    @property
    def joins(self) -> bool:
        return len(self.devices) > 1


@dataclass(eq=False)
class Leg:
    """A way on from a node; without a transition the way from a step to its join. A goal that is no node is jumped to."""

    transition: Transition | None
    goals: list[Node | Word]


@dataclass(frozen=True, slots=True)
class Jump:
    """The end of a way: the step or join where it goes on, or that it ends."""

    target: Device | None
    join: bool = False

    def __str__(self) -> str:
        return "end" if self.target is None else f"join {self.target}" if self.join else str(self.target)


@dataclass(frozen=True, slots=True)
class Mark:
    """Something in its place: a Node (step or join), a Transition (its bar) or a Jump; (x, y) is the middle of its upper edge."""

    what: Node | Transition | Jump
    x: float
    y: float


@dataclass(slots=True)
class Sketch:
    """A part of a chart around its axis x = 0, from y = 0 downwards; `open` tells that its way goes on below."""

    left: float = 0
    right: float = 0
    height: float = 0
    open: bool = False
    steps: int = 0
    marks: list[Mark] = field(default_factory=list)
    lines: list[tuple[float, float, float, float, bool]] = field(default_factory=list)  # the last: double

    def line(self, x1: float, y1: float, x2: float, y2: float, double: bool = False) -> None:
        if double or (x1, y1) != (x2, y2):
            self.lines.append((x1, y1, x2, y2, double))
            self.left, self.right = max(self.left, -x1, -x2), max(self.right, x1, x2)

    def mark(self, what: Node | Transition | Jump, x: float, y: float, left: float, right: float) -> None:
        self.marks.append(Mark(what, x, y))
        self.left, self.right = max(self.left, left - x), max(self.right, right + x)

    def include(self, other: Sketch, x: float, y: float) -> None:
        self.marks += [Mark(mark.what, mark.x + x, mark.y + y) for mark in other.marks]
        self.lines += [(x1 + x, y1 + y, x2 + x, y2 + y, double) for x1, y1, x2, y2, double in other.lines]
        self.left, self.right = max(self.left, other.left - x), max(self.right, other.right + x)
        self.steps += other.steps


class Metrics(Protocol):
    """The lengths of one kind of chart."""

    above: float  # from a step to the bar of its transition
    below: float  # from the bar to what follows
    diverge: float  # from a step or bar to a line of divergence
    enter: float  # from such a line to the step below it
    merge: float  # from a merging line to what follows
    overhang: float
    double: float  # the distance of a double line's strokes
    pitch: float
    skip: float
    free: float  # between two branches
    jump: float

    def snap(self, x: float) -> float: ...

    def node(self, node: Node) -> tuple[float, float, float]: ...  # left, right, height

    def transition(self, transition: Transition) -> tuple[float, float, float, float]: ...  # left, right, up, down

    def arrow(self, jump: Jump) -> tuple[float, float]: ...  # left, right


# -- the graph of a flow ----------------------------------------------------------------------------------------


def graph(flow: Flow) -> list[Node]:
    """The nodes of a flow in the program's order, tied to one another by their legs."""
    nodes: list[Node] = []
    own: dict[Device, Node] = {}
    for step in flow.steps:
        for device in step.devices if step.joins else ():
            if device not in own and not any(other.devices == (device,) for other in flow.steps):
                own[device] = Node((device,), len(nodes))
                nodes.append(own[device])
        node = Node(step.devices, len(nodes), step)
        nodes.append(node)
        if not step.joins:
            own.setdefault(step.devices[0], node)
    for node in nodes:
        for transition in node.step.transitions if node.step else ():
            goals: list[Node | Word] = [own.get(word.operands[0], word) if not transition.ends else word for word in transition.targets]
            node.legs.append(Leg(transition, goals))
    for join in nodes:
        for device in join.devices if join.joins else ():
            own[device].legs.append(Leg(None, [join]))
    return nodes


# -- laying out -------------------------------------------------------------------------------------------------


class ChartLayout:
    """Lays one flow out with the lengths of one kind of chart."""

    def __init__(self, metrics: Metrics):
        self.metrics = metrics
        self.placed: set[Node] = set()
        self.lined: set[Node] = set()  # joins whose double line is drawn already
        self.depth = 0

    def flow(self, flow: Flow) -> list[Sketch]:
        """The flow as one sketch for each step that no other leads to downwards."""
        return [self.chain(node, None) for node in graph(flow) if node not in self.placed]

    def chain(self, node: Node | None, stop: Node | None) -> Sketch:
        """A node and all that follows, down to `stop`, which is left out."""
        self.depth += 1
        out, y = Sketch(), 0.0
        while node is not None:
            if node in self.placed:  # another branch came first
                y = self._arrow(out, 0, y, Jump(node.devices[0], node.joins))
                break
            y = self._place(out, y, node)
            legs = [(leg, self._goals(leg, node, stop)) for leg in node.legs]
            if not legs:
                break
            if len(legs) == 1:
                y, node = self._follow(out, y, *legs[0], stop)
            else:
                y, node = self._select(out, y, legs, stop)
        out.height = y
        self.depth -= 1
        return out

    def _place(self, out: Sketch, y: float, node: Node) -> float:
        m = self.metrics
        self.placed.add(node)
        left, right, height = m.node(node)
        if node.joins and node not in self.lined:
            out.line(-m.overhang, y, m.overhang, y, True)
            y += m.double
        out.mark(node, 0, y, left, right)
        out.line(0, y, 0, y + height)
        out.steps += not node.joins
        return y + height

    def _goals(self, leg: Leg, node: Node, stop: Node | None) -> list[Node | Jump]:
        """Where a leg goes: to `stop`, to a node that is to be placed below, or by a jump."""
        goals: list[Node | Jump] = []
        for goal in leg.goals:
            if isinstance(goal, Node) and (goal is stop or (goal not in self.placed and goal.order > node.order and self.depth < DEEPEST)):
                goals.append(goal)
            elif isinstance(goal, Node):
                goals.append(Jump(goal.devices[0], goal.joins))
            else:
                goals.append(Jump(None if leg.transition.ends else goal.operands[0]))
        return goals

    def _follow(self, out: Sketch, y: float, leg: Leg, goals: Sequence[Node | Jump], stop: Node | None) -> tuple[float, Node | None]:
        """Go down a leg: the height reached and the node to go on with; with neither node nor jump the way is open."""
        y = self._transit(out, y, leg)
        if len(goals) > 1:
            return self._diverge(out, y, goals, stop)
        goal = goals[0]
        if isinstance(goal, Jump):
            return self._arrow(out, 0, y, goal), None
        if goal is stop:
            out.open = True
            return y, None
        if not leg.transition and not goal.joins:
            return y, goal
        if goal.joins and goal not in self.lined:
            out.line(0, y, 0, y + self.metrics.diverge)
            return y + self.metrics.diverge, goal
        return y, goal

    def _transit(self, out: Sketch, y: float, leg: Leg) -> float:
        """The bar of a leg's transition on the axis; the height where the way goes on."""
        if leg.transition is None:
            return y
        m = self.metrics
        left, right, up, down = m.transition(leg.transition)
        bar = y + max(m.above, up)
        end = bar + max(m.below, down)
        out.mark(leg.transition, 0, bar, left, right)
        out.line(0, y, 0, end)
        return end

    def _arrow(self, out: Sketch, x: float, y: float, jump: Jump) -> float:
        out.mark(jump, x, y, *self.metrics.arrow(jump))
        return y + self.metrics.jump

    # -- branches -----------------------------------------------------------------------------------------------

    def _diverge(self, out: Sketch, y: float, goals: Sequence[Node | Jump], stop: Node | None) -> tuple[float, Node | None]:
        """Parallel branches between double lines."""
        m = self.metrics
        meeting = self._meeting([[goal] for goal in goals], stop)
        if meeting is not None and meeting.joins:
            self.lined.add(meeting)
        subs = []
        for goal in goals:
            sub = Sketch()
            sub.line(0, 0, 0, m.enter)
            if isinstance(goal, Jump):
                sub.height = self._arrow(sub, 0, m.enter, goal)
            elif goal is (meeting or stop):
                sub.height, sub.open = m.enter, True
            else:
                inner = self.chain(goal, meeting or stop) if goal not in self.placed else None
                if inner is None:
                    sub.height = self._arrow(sub, 0, m.enter, Jump(goal.devices[0], goal.joins))
                else:
                    sub.include(inner, 0, m.enter)
                    sub.height, sub.open = m.enter + inner.height, inner.open
            subs.append(sub)
        places = self._side_by_side(subs, straight=False)
        out.line(min(*places, 0) - m.overhang, y, max(*places, 0) + m.overhang, y, True)
        return self._gather(out, y + m.double, subs, places, meeting, stop)

    def _select(self, out: Sketch, y: float, legs: list[tuple[Leg, list[Node | Jump]]], stop: Node | None) -> tuple[float, Node | None]:
        """One of several ways: a single line above, and below where ways meet again."""
        m = self.metrics
        goals = [goals for _, goals in legs]
        down = [place for place, each in enumerate(goals) if any(isinstance(goal, Node) for goal in each)]
        if len(down) == 1 and len(goals[down[0]]) == 1:
            return self._beside(out, y, legs, down[0], stop)
        meeting = self._meeting(goals, stop)
        if meeting is not None and meeting.joins:
            self.lined.add(meeting)
        subs = []
        for leg, each in legs:
            sub = Sketch()
            again = [
                goal
                if isinstance(goal, Jump) or goal not in self.placed or goal is stop or goal is meeting
                else Jump(goal.devices[0], goal.joins)
                for goal in each
            ]
            height, node = self._follow(sub, 0, leg, again, meeting or stop)
            if node is not None:
                rest = self.chain(node, meeting or stop)
                sub.include(rest, 0, height)
                height, sub.open = height + rest.height, rest.open
            sub.height = height
            subs.append(sub)
        places = self._side_by_side(subs, straight=sum(sub.steps > 0 for sub in subs) < 2)
        top = y + m.diverge
        out.line(0, y, 0, top)
        out.line(min(*places, 0), top, max(*places, 0), top)
        return self._gather(out, top, subs, places, meeting, stop)

    def _beside(
        self, out: Sketch, y: float, legs: list[tuple[Leg, list[Node | Jump]]], main: int, stop: Node | None
    ) -> tuple[float, Node | None]:
        """One way goes on straight, the others are jumps at its right."""
        m = self.metrics
        top = y + m.diverge
        out.line(0, y, 0, top)
        leg, goals = legs[main]
        clear = m.transition(leg.transition)[1] if leg.transition else 0
        clear = max([clear, *(m.node(goal)[1] for goal in goals if isinstance(goal, Node) and goal is not stop)])
        x = 0.0
        lowest = top
        for place, (side, each) in enumerate(legs):
            if place == main:
                continue
            sub = Sketch()
            height, _ = self._follow(sub, 0, side, each, stop)
            x += max(m.skip, clear + m.free + sub.left)
            out.include(sub, x, top)
            clear, lowest = sub.right, max(lowest, top + height)
        out.line(0, top, x, top)
        y, node = self._follow(out, top, leg, goals, stop)
        # What follows the next node must not meet the jumps beside it.
        low = lowest - (m.node(node)[2] + m.above / 2 if node is not None else 0)
        if low > y:
            if node is not None or out.open:
                out.line(0, y, 0, low)
            y = low
        return y, node

    def _gather(
        self, out: Sketch, top: float, subs: list[Sketch], places: list[float], meeting: Node | None, stop: Node | None
    ) -> tuple[float, Node | None]:
        """Put branches side by side below a line and bring those that go on together again."""
        m = self.metrics
        for sub, x in zip(subs, places, strict=True):
            out.include(sub, x, top)
        bottom = top + max(sub.height for sub in subs)
        going = [(sub, x) for sub, x in zip(subs, places, strict=True) if sub.open]
        if not going:
            return bottom, None
        join = meeting is not None and meeting.joins
        low = bottom + (m.diverge - m.double if join else 0)
        for sub, x in going:
            out.line(x, top + sub.height, x, low)
        xs = [x for _, x in going]
        if join:
            out.line(min(xs) - m.overhang, low, max(xs) + m.overhang, low, True)
            if meeting is stop:
                out.open = True
                return low, None
            return low + m.double, meeting
        out.line(min(*xs, 0), low, max(*xs, 0), low)
        if meeting is None or meeting is stop:
            out.open = True
            return low, None
        out.line(0, low, 0, low + m.merge)
        return low + m.merge, meeting

    def _side_by_side(self, subs: list[Sketch], straight: bool) -> list[float]:
        """The axes of branches: the one with steps straight on and the others at its right, or all around the middle."""
        m = self.metrics
        order = list(range(len(subs)))
        if straight:
            order.sort(key=lambda place: subs[place].steps == 0)
        places = [0.0] * len(subs)
        for before, place in pairwise(order):
            pitch = m.pitch if subs[before].steps and subs[place].steps else m.skip
            places[place] = places[before] + max(pitch, subs[before].right + subs[place].left + m.free)
        if straight:
            return places
        full = [x for sub, x in zip(subs, places, strict=True) if sub.steps] or places
        middle = len(full) // 2
        shift = full[middle] if len(full) % 2 else m.snap((full[middle - 1] + full[middle]) / 2)
        return [x - shift for x in places]

    def _meeting(self, ways: Sequence[Sequence[Node | Jump]], stop: Node | None) -> Node | None:
        """Where ways come together again: the first node that all of them reach, or at least two."""
        reaches = [self._reach([goal for goal in way if isinstance(goal, Node)], stop) for way in ways]
        reaches = [reach for reach in reaches if reach]
        if len(reaches) < 2:
            return None
        common = set.intersection(*reaches) or {node for reach in reaches for node in reach if sum(node in other for other in reaches) > 1}
        return min(common, key=lambda node: node.order, default=None)

    def _reach(self, goals: Iterable[Node], stop: Node | None) -> set[Node]:
        """The nodes below some nodes that are still to be placed, and `stop` where it is reached."""
        found: set[Node] = set()
        waiting = list(goals)
        while waiting:
            node = waiting.pop()
            if node in found or (node in self.placed and node is not stop):
                continue
            found.add(node)
            if node is not stop:
                waiting += [goal for leg in node.legs for goal in leg.goals if isinstance(goal, Node) and goal.order > node.order]
        return found
