"""Where everything of a rung lies, in any unit of length: symbols, wires, the dots of branches, and what carries power to each.

A rung is laid out from left to right with its outputs against the right rail. Each wire belongs to a net; how the power of
the nets follows from what a scan recorded is kept as a short list of operations (`Power`), so that a frame costs little.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Protocol

from .rungs import Block, Contact, Fork, Gate, Item, Output, Parallel, Rung, Series, Word

Recorded = Sequence[bool | None] | Mapping[int, bool]  # by position
RAIL = 0  # the net of the left rail


@dataclass(frozen=True, slots=True)
class Size:
    """The room of a thing: its width, what it needs above and below its wire; where the wire enters and leaves it."""

    width: float
    up: float = 0
    down: float = 0
    enter: float = 0
    leave: float = 0


class Metrics(Protocol):
    """The lengths of one kind of drawing."""

    lead: float  # from the left rail to the first cell
    bar: float  # from a parallel's bar to the next cell
    drop: float  # from the bar of several outputs to the first of them
    row: float  # least distance of two wires
    gap: float  # least distance of what stands below one wire and above the next

    def contact(self, word: Word) -> Size: ...

    def gate(self, word: Word) -> Size: ...

    def output(self, word: Word) -> Size: ...


@dataclass(slots=True)
class Symbol:
    """A contact, gate or output in its place: the left edge of its cell, the height of its wire, and its nets."""

    item: Contact | Gate | Output
    x: float
    y: float
    size: Size
    before: int
    after: int


@dataclass(slots=True)
class Power:
    """How the power of a rung's nets follows from a trace, net 0 being the left rail; in an order that can be computed."""

    steps: list[tuple[str, int, tuple[int, ...], int]] = field(default_factory=list)  # (kind, net, from nets, position)
    count: int = 1

    def net(self, kind: str, sources: tuple[int, ...], position: int = -1) -> int:
        self.steps.append((kind, self.count, sources, position))
        self.count += 1
        return self.count - 1

    def solve(self, rail: bool, flow: Recorded, closed: Recorded, first: int = 0) -> list[bool]:
        """Which nets carry power; `flow` and `closed` begin with the instruction at position `first`."""
        power = [False] * self.count
        if rail:
            power[RAIL] = True
            for kind, net, sources, position in self.steps:
                if kind == "contact":
                    power[net] = power[sources[0]] and bool(closed[position - first])
                elif kind == "gate":
                    power[net] = power[sources[0]] and bool(flow[position - first])
                else:
                    power[net] = any(power[source] for source in sources)
        return power


@dataclass(slots=True)
class Placed:
    """A rung laid out from (0, 0), where its first wire leaves the left rail."""

    symbols: list[Symbol] = field(default_factory=list)
    wires: list[tuple[float, float, float, float, int]] = field(default_factory=list)
    dots: list[tuple[float, float, int]] = field(default_factory=list)
    power: Power = field(default_factory=Power)


class Layout:
    """Lays rungs out with the lengths of one kind of drawing."""

    def __init__(self, metrics: Metrics):
        self.metrics = metrics

    # -- sizes --------------------------------------------------------------------------------------------------

    def size(self, rung: Rung) -> Size:
        """The least room of a rung between the rails."""
        size = self._path(rung.flow.items)
        return Size(self.metrics.lead + size.width, size.up, size.down)

    def _item(self, item: Item) -> Size:
        if isinstance(item, Contact):
            return self.metrics.contact(item.word)
        if isinstance(item, Gate):
            return self.metrics.gate(item.word)
        if isinstance(item, Block):
            return self._row(item.flow.items)
        return self._parallel(item)

    def _row(self, items: Sequence[Item]) -> Size:
        """Inputs one behind the other."""
        sizes = [self._item(item) for item in items]
        return Size(sum(s.width for s in sizes), max((s.up for s in sizes), default=0), max((s.down for s in sizes), default=0))

    def _parallel(self, item: Parallel) -> Size:
        sizes = [self._row(_way(way)) for way in item.ways]
        return Size(max(s.width for s in sizes) + 2 * self.metrics.bar, sizes[0].up, self._stack(sizes)[-1] + sizes[-1].down)

    def _path(self, items: Sequence[Item]) -> Size:
        """Inputs and the outputs behind them."""
        inputs, tails = _parted(items)
        head = self._row(inputs)
        if not tails:
            return head
        sizes = [self._tail(tail) for tail in tails]
        rows = self._stack(sizes)
        width = head.width + self._branching(inputs, tails) + max(s.width for s in sizes)
        return Size(width, max(head.up, sizes[0].up), max(head.down, rows[-1] + sizes[-1].down))

    def _branching(self, inputs: Sequence[Item], tails: Sequence[Sequence[Item]]) -> float:
        """The room for the bar at which the tails of a path part."""
        if len(tails) < 2:
            return 0
        if all(map(_is_output, tails)):
            return self.metrics.drop
        return 2 * self.metrics.bar if inputs else self.metrics.bar

    def _tail(self, tail: Sequence[Item]) -> Size:
        return self.metrics.output(tail[0].word) if _is_output(tail) else self._path(tail)

    def _stack(self, sizes: Sequence[Size]) -> list[float]:
        """The heights of wires one below the other, the first at 0."""
        rows = [0.0]
        for above, below in pairwise(sizes):
            rows.append(rows[-1] + max(self.metrics.row, above.down + below.up + self.metrics.gap))
        return rows

    # -- places -------------------------------------------------------------------------------------------------

    def place(self, rung: Rung, right: float) -> Placed:
        """A rung between the rails, the right one at `right`."""
        placed = Placed()
        self._place_path(placed, rung.flow.items, 0, self.metrics.lead, 0, RAIL, right)
        return placed

    def row_size(self, flow: Series) -> Size:
        """The room of contacts alone, as in the condition of a transition."""
        return self._row(flow.items)

    def place_row(self, flow: Series) -> tuple[Placed, int]:
        """Contacts alone from (0, 0) on, and the net behind the last of them."""
        placed = Placed()
        pen, _, net = self._place_row(placed, flow.items, 0, 0, 0, RAIL, RAIL)
        end = self._row(flow.items).width
        _wire(placed, pen, 0, end, 0, net)
        return placed, net

    def _place_row(
        self, placed: Placed, items: Sequence[Item], pen: float, x: float, y: float, net: int, base: int
    ) -> tuple[float, float, int]:
        """Inputs from the cell at x on, the wire so far ending at `pen`; the new pen, cell and net.

        `base` is the net of what a recorded flow is relative to: the left rail, or in a block the wire that it begins at.
        """
        for item in items:
            size = self._item(item)
            if isinstance(item, Contact | Gate):
                _wire(placed, pen, y, x + size.enter, y, net)
                position = item.word.position
                after = (
                    placed.power.net("contact", (net,), position)
                    if isinstance(item, Contact)
                    else placed.power.net("gate", (base,), position)
                )
                placed.symbols.append(Symbol(item, x, y, size, net, after))
                pen, net = x + size.leave, after
            elif isinstance(item, Block):
                pen, _, net = self._place_row(placed, item.flow.items, pen, x, y, net, net)
            else:
                pen, net = self._place_parallel(placed, item, pen, x, y, net)
            x += size.width
        return pen, x, net

    def _place_parallel(self, placed: Placed, item: Parallel, pen: float, x: float, y: float, net: int) -> tuple[float, int]:
        ways = [_way(way) for way in item.ways]
        sizes = [self._row(way) for way in ways]
        rows = [y + row for row in self._stack(sizes)]
        left = x + self.metrics.bar
        right = left + max(s.width for s in sizes)
        _wire(placed, pen, y, left, y, net)
        ends = []
        for way, row in zip(ways, rows, strict=True):
            end, _, after = self._place_row(placed, way, left, left, row, net, net)
            _wire(placed, end, row, right, row, after)
            ends.append(after)
        together = placed.power.net("or", tuple(ends))
        for place in range(1, len(rows)):
            _wire(placed, left, rows[place - 1], left, rows[place], net)
            below = ends[-1] if place == len(rows) - 1 else placed.power.net("or", tuple(ends[place:]))
            _wire(placed, right, rows[place - 1], right, rows[place], below)
        for place, row in enumerate(rows[:-1]):
            placed.dots.append((left, row, net))
            placed.dots.append((right, row, placed.power.net("or", tuple(ends[place:])) if place else together))
        return right, together

    def _place_path(self, placed: Placed, items: Sequence[Item], pen: float, x: float, y: float, net: int, right: float) -> None:
        inputs, tails = _parted(items)
        pen, x, net = self._place_row(placed, inputs, pen, x, y, net, RAIL)
        if len(tails) < 2:
            if tails:
                self._place_tail(placed, tails[0], pen, x, y, net, right)
            else:
                _wire(placed, pen, y, x, y, net)
            return
        sizes = [self._tail(tail) for tail in tails]
        rows = [y + row for row in self._stack(sizes)]
        if all(map(_is_output, tails)):
            bar = min(right - size.width + size.enter for size in sizes) - self.metrics.drop
        else:
            bar = x + (self.metrics.bar if inputs else 0)
            x = bar + self.metrics.bar
        _wire(placed, pen, y, bar, y, net)
        for place, (tail, row) in enumerate(zip(tails, rows, strict=True)):
            if place:
                _wire(placed, bar, rows[place - 1], bar, row, net)
            if place < len(rows) - 1:
                placed.dots.append((bar, row, net))
            self._place_tail(placed, tail, bar, x, row, net, right)

    def _place_tail(self, placed: Placed, tail: Sequence[Item], pen: float, x: float, y: float, net: int, right: float) -> None:
        if not _is_output(tail):
            self._place_path(placed, tail, pen, x, y, net, right)
            return
        size = self.metrics.output(tail[0].word)
        x = right - size.width
        _wire(placed, pen, y, x + size.enter, y, net)
        placed.symbols.append(Symbol(tail[0], x, y, size, net, net))
        _wire(placed, x + size.leave, y, right, y, net)


def _way(way: Series | Contact | Block) -> Sequence[Item]:
    """What lies on one way of a parallel."""
    return (way,) if isinstance(way, Contact) else way.flow.items if isinstance(way, Block) else way.items


def _is_output(tail: Sequence[Item]) -> bool:
    return len(tail) == 1 and isinstance(tail[0], Output)


def _parted(items: Sequence[Item]) -> tuple[Sequence[Item], list[Sequence[Item]]]:
    """The inputs at the head, and what hangs behind them: outputs, branches, and the rest of a cascade."""
    place = next((n for n, item in enumerate(items) if isinstance(item, Output | Fork)), len(items))
    return items[:place], list(_tails(items[place:]))


def _tails(items: Sequence[Item]) -> Iterator[Sequence[Item]]:
    for place, item in enumerate(items):
        if isinstance(item, Output):
            yield (item,)
        elif isinstance(item, Fork):
            for branch in item.branches:
                yield from _tails(branch.items)
        else:
            yield items[place:]
            return


def _wire(placed: Placed, x1: float, y1: float, x2: float, y2: float, net: int) -> None:
    if x1 != x2 or y1 != y2:
        placed.wires.append((x1, y1, x2, y2, net))
