"""The ladder in box-drawing characters, for terminals and for outputs that are compared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..assembler.program import is_label
from .canvas import Canvas
from .labels import COILS, EDGES, Label, Labels, compares, inverted, sign
from .layout import Layout, Size, Symbol
from .lettering import columns, padded
from .rungs import Gate, Output, Word

if TYPE_CHECKING:
    from .ladder import Entry, Ladder

RAIL, RAIL_STEP, RIGHT, COIL = 6, 2, 79, 9
_GATES = {"EU": "↑", "ED": "↓", "INV": "¬"}


@dataclass(frozen=True)
class Cells:
    """Lengths in character cells for `Layout`; a symbol enters and leaves at the cells of its first and last sign."""

    labels: Labels
    lead: int = 1
    bar: int = 1
    drop: int = 2
    row: int = 1
    gap: int = 1

    def contact(self, word: Word) -> Size:
        label = above(word, self.labels)
        return _cell(len(contact_text(word)), label)

    def gate(self, word: Word) -> Size:
        return _cell(3, [])

    def output(self, word: Word) -> Size:
        if word.mnemonic in COILS:
            return _cell(3, above(word, self.labels), COIL)
        size = columns(box_text(word, self.labels))
        return Size(size + 2, 0, 0, 0, size - 1)


def _cell(symbol: int, label: list[str], least: int = 0) -> Size:
    width = max([least, symbol + 2, *(columns(words) + 2 for words in label)])
    enter = (width - symbol) // 2
    return Size(width, len(label), 0, enter, enter + symbol - 1)


def above(word: Word, labels: Labels) -> list[str]:
    """What stands over a contact or coil: its name, then its address; over a comparison the names alone."""
    if compares(word):
        names = [labels.of(word, place).name for place in range(2)]
        return [f"{names[0] or word.operands[0]} {sign(word)} {names[1] or word.operands[1]}"] if any(names) else []
    label = labels.contact(word)
    return [label.name, label.address] if label.name else [label.address]


def contact_text(word: Word) -> str:
    """A contact between its bars."""
    if compares(word):
        return f"┤{word.operands[0]} {sign(word)} {word.operands[1]}├"
    if word.mnemonic in EDGES:
        return f"┤{_GATES[EDGES[word.mnemonic]]}├"
    return "┤/├" if inverted(word) else "┤ ├"


def box_text(word: Word, labels: Labels) -> str:
    """A function box on one line: the mnemonic and its operands."""
    operands = [_inline(labels.of(word, place)) for place in range(len(word.operands))]
    return f"[{' '.join([word.name, *operands])}]"


def _inline(label: Label) -> str:
    return f"{label.name}({label.address})" if label.name else label.address


def draw(ladder: Ladder) -> str:
    """The whole ladder, at least 80 columns wide."""
    from .ladder import is_bus, is_drawn, railed

    layouts = {id(e.labels): Layout(Cells(e.labels)) for e in ladder.entries}
    needed = [
        RAIL + RAIL_STEP * len(railed(e.rung)) + int(layouts[id(e.labels)].size(e.rung).width) for e in ladder.entries if is_drawn(e.rung)
    ]
    right = max([RIGHT, *needed])
    canvas = Canvas()
    row = 0
    for place, entry in enumerate(ladder.entries):
        if entry.heading:
            row += 1 if place else 0
            canvas.write(row, 0, entry.heading)
            row += 2
        rails = [RAIL + RAIL_STEP * n for n in range(len(railed(entry.rung)) + 1)]
        top = row
        canvas.write(row, 0, padded(str(entry.rung.number + 1), RAIL - 2, ">"))
        for line in entry.rung.title.split("\n") if entry.rung.title else []:
            canvas.write(row, rails[-1] + 2, line)
            row += 1
        if not is_drawn(entry.rung):  # the program step stands below the network's number
            row += not entry.rung.title
            canvas.write(row, 0, padded(str(entry.rung.words[0].step), RAIL - 2, ">"))
        if is_drawn(entry.rung):
            row = _rung(canvas, layouts[id(entry.labels)], entry, rails[-1], right, row)
        elif is_bus(entry.rung):
            row = _bus(canvas, entry, rails[-1], row)
        else:
            row = _list(canvas, entry, rails[-1], row)
        for x in (*rails, right):
            canvas.through(x, top, row - 1)
        row = _between(canvas, ladder, place, right, row)
    return canvas.text()


def _between(canvas: Canvas, ladder: Ladder, place: int, right: int, row: int) -> int:
    """The blank line between two networks, with the rails that go on through it; the row behind it."""
    from .ladder import opens, railed

    following = ladder.entries[place + 1] if place + 1 < len(ladder.entries) else None
    if following is None or following.heading:
        return row
    mine, others = railed(ladder.entries[place].rung), railed(following.rung)
    for x in (RAIL, right):
        canvas.through(x, row, row)
    for n, region in enumerate(others):
        x = RAIL + RAIL_STEP * (n + 1)
        if n < len(mine) and mine[n] == region and not opens(following.rung):
            canvas.through(x, row, row)
        elif opens(ladder.entries[place].rung):
            canvas.vertical(x, row - 1, row)
            canvas.through(x, row, row)
    return row + 1


def _rung(canvas: Canvas, layout: Layout, entry: Entry, rail: int, right: int, row: int) -> int:
    """One network from a row on; the row behind it."""
    size = layout.size(entry.rung)
    row += not size.up and not entry.rung.title  # the number has a line of its own
    placed = layout.place(entry.rung, right - rail)
    wire = row + int(size.up)
    canvas.write(wire, 0, padded(str(entry.rung.words[0].step), RAIL - 2, ">"))
    for x1, y1, x2, y2, _ in placed.wires:
        if y1 == y2:
            canvas.horizontal(wire + int(y1), rail + int(x1), rail + int(x2))
        else:
            canvas.vertical(rail + int(x1), wire + int(y1), wire + int(y2))
    for symbol in placed.symbols:
        _symbol(canvas, entry.labels, symbol, rail, wire)
    return wire + int(size.down) + 1


def _symbol(canvas: Canvas, labels: Labels, symbol: Symbol, rail: int, wire: int) -> None:
    word = symbol.item.word
    row, start = wire + int(symbol.y), rail + int(symbol.x + symbol.size.enter)
    label: list[str] = []
    if isinstance(symbol.item, Gate):
        letters = f"┤{_GATES[word.mnemonic]}├"
    elif isinstance(symbol.item, Output) and word.mnemonic not in COILS:
        letters = box_text(word, labels)
    elif isinstance(symbol.item, Output):
        letters, label = f"({COILS[word.mnemonic] or ' '})", above(word, labels)
    else:
        letters, label = contact_text(word), above(word, labels)
    canvas.write(row, start, letters)
    middle = start + (columns(letters) - 1) // 2
    for n, words in enumerate(label):
        canvas.middle(row - len(label) + n, middle, words)


def _bus(canvas: Canvas, entry: Entry, rail: int, row: int) -> int:
    words = entry.rung.words
    letters = "".join(f"[{w}]" if is_label(w.name, w.written) else box_text(w, entry.labels) for w in words)
    canvas.horizontal(row, rail, rail + RAIL_STEP + 2)
    canvas.write(row, rail + RAIL_STEP + 2, letters)
    return row + 1


def _list(canvas: Canvas, entry: Entry, rail: int, row: int) -> int:
    for word in entry.rung.words:
        canvas.write(row, rail + 2, str(word))
        row += 1
    return row
