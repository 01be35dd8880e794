"""Conditions of transitions and actions: in words, and as small contacts beside the bar of a transition."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from . import svg as s
from .flows import single
from .labels import EDGES, Label, Labels, compares, inverted, sign
from .layout import Layout, Placed, Size
from .lettering import cut, width
from .rungs import Block, Contact, Gate, Item, Parallel, Series, Word
from .symbols import bars, gate_path, group

LONGEST = 190


# -- in words ---------------------------------------------------------------------------------------------------


def phrase(condition: Series, labels: Labels) -> str:
    """A condition in words: "Start and not (Busy or D10 < 12)", "Leaving falls"; empty for none."""
    return _series(condition.items, labels)


def _series(items: Sequence[Item], labels: Labels) -> str:
    words: list[str] = []
    for item in items:
        if isinstance(item, Gate):
            whole = _enclosed(" and ".join(words))
            words = [f"not {whole}" if item.word.mnemonic == "INV" else f"{whole} {'rises' if item.word.mnemonic == 'EU' else 'falls'}"]
        elif isinstance(item, Contact):
            words.append(_contact(item.word, labels))
        elif isinstance(item, Block):
            inner = _series(item.flow.items, labels)
            words.append(_enclosed(inner) if " or " in inner else inner)
        elif isinstance(item, Parallel):
            ways = " or ".join(_series(_items(way), labels) for way in item.ways)
            words.append(_enclosed(ways) if len(items) > 1 else ways)
    return " and ".join(words)


def _enclosed(words: str) -> str:
    """Words in parentheses, if they are several and not enclosed as a whole already."""
    depth = 0
    for place, letter in enumerate(words):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and place < len(words) - 1 and words[0] == "(":
            break
    else:
        if words.startswith("("):
            return words
    return f"({words})" if " " in words else words


def _items(way: Series | Contact | Block) -> Sequence[Item]:
    return (way,) if isinstance(way, Contact) else way.flow.items if isinstance(way, Block) else way.items


def _contact(word: Word, labels: Labels) -> str:
    if compares(word):
        return compare_words(word, labels)
    label = labels.contact(word)
    name = label.name or label.address
    if word.mnemonic in EDGES:
        return f"{name} {'rises' if EDGES[word.mnemonic] == 'EU' else 'falls'}"
    return f"not {name}" if inverted(word) else name


def compare_words(word: Word, labels: Labels) -> str:
    """A comparison with names where there are any."""
    left, right = (labels.of(word, place) for place in range(2))
    return f"{left.name or left.address} {sign(word)} {right.name or right.address}"


# -- as small contacts ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Small:
    """The lengths of the small contacts for `Layout`: bars of 16 px, 10 apart, with the name above."""

    labels: Labels
    lead: float = 0
    bar: float = 10
    drop: float = 0
    row: float = 32
    gap: float = 4

    def contact(self, word: Word) -> Size:
        if compares(word):
            room = width(compare_words(word, self.labels), 12) + 14
            return Size(room + 14, 11, 11, 7, room + 7)
        room = max(30, min(LONGEST, _label_width(self.labels.contact(word))) + 12)
        return Size(room, 24, 9, room / 2 - 5, room / 2 + 5)

    def gate(self, word: Word) -> Size:
        return Size(26, 9, 9, 8, 18)

    def output(self, word: Word) -> Size:
        raise AssertionError("a condition has no outputs")


def _label_width(label: Label) -> float:
    return (width(label.name) + 4 if label.name else 0) + width(label.address, 11 if label.name else 12, mono=True)


class Condition:
    """A transition's condition as it is drawn from (0, 0) to the right; `kind` is always, single or ladder."""

    def __init__(self, condition: Series, labels: Labels):
        self.condition, self.labels = condition, labels
        self.one = single(condition)
        self.placed: Placed | None = None
        if not condition.items:
            self.kind, self.width, self.up, self.down = "always", 40.0, 9.0, 9.0
        elif self.one and not compares(self.one[0]):
            room = 34 + min(LONGEST, _label_width(labels.contact(self.one[0])))
            self.kind, self.width, self.up, self.down = "single", room, 13.0, 13.0
        else:
            layout = Layout(Small(labels))
            size = layout.row_size(condition)
            self.placed, self.net = layout.place_row(condition)
            self.kind, self.width, self.up, self.down = "ladder", size.width, max(13.0, size.up + 2), max(13.0, size.down + 2)

    def words(self) -> list[Word]:
        """Its contacts and edges."""
        if self.placed:
            return [symbol.item.word for symbol in self.placed.symbols]
        return [word for word in self.one or () if word]

    def draw(self, prefix: str) -> str:
        """The small contacts at rest."""
        if self.kind == "always":
            return s.text(4, 4, "always", "el-edge")
        if self.kind == "single":
            return self._single(prefix)
        return self._ladder(prefix)

    def _single(self, prefix: str) -> str:
        word, edge = self.one
        label = self.labels.contact(word)
        pulse = edge.mnemonic if edge else EDGES.get(word.mnemonic)
        mark = gate_path(pulse, 13, 0, 0.68) if pulse else ""
        slash = "M9 6.5l8 -13" if inverted(word) else ""
        content = bars(8, 0, 10, 16) + (s.element("path", None, class_="mod", d=slash + mark) if slash or mark else "")
        address = f'<tspan class="el-addr{"" if label.name else " alone"}">{s.escape(label.address)}</tspan>'
        name = cut(label.name, LONGEST - width(label.address, 11, True) - 4) + " " if label.name else ""
        content += s.element("text", s.escape(name) + address, class_="el-name", x=33, y=4)
        wires = s.element("path", None, id=f"{prefix}i{word.position}", class_="wire", d="M0 0H8")
        wires += s.element("path", None, id=f"{prefix}o{word.position}", class_="wire", d="M18 0H26")
        return wires + group(content, "contact open", word, self.labels, prefix)

    def _ladder(self, prefix: str) -> str:
        parts = []
        nets: dict[int, list[str]] = {}
        for x1, y1, x2, y2, net in self.placed.wires:
            nets.setdefault(net, []).append(f"M{s.number(x1)} {s.number(y1)}" + (f"H{s.number(x2)}" if y1 == y2 else f"V{s.number(y2)}"))
        first = self.words()[0].position
        for net, paths in nets.items():
            parts.append(s.element("path", None, id=f"{prefix}n{first}.{net}", class_="wire", d="".join(paths)))
        parts += [self._symbol(symbol, prefix) for symbol in self.placed.symbols]
        return "".join(parts)

    def _symbol(self, symbol, prefix: str) -> str:
        word, size = symbol.item.word, symbol.size
        x, y = symbol.x + size.enter, symbol.y
        if isinstance(symbol.item, Gate):
            content = bars(x, y, 10, 16) + s.element("path", None, class_="mod", d=gate_path(word.mnemonic, x + 5, y, 0.68))
        elif compares(word):
            room = size.leave - size.enter
            content = bars(x, y, room, 18) + s.text(x + room / 2, y + 4, compare_words(word, self.labels), "el-name mid")
        else:
            label = self.labels.contact(word)
            mark = f"M{s.number(x + 1)} {s.number(y + 6.5)}l8 -13" if inverted(word) else ""
            if word.mnemonic in EDGES:
                mark = gate_path(EDGES[word.mnemonic], x + 5, y, 0.68)
            slash = s.element("path", None, class_="mod", d=mark) if mark else ""
            address = f'<tspan class="el-addr{"" if label.name else " alone"}">{s.escape(label.address)}</tspan>'
            name = cut(label.name, LONGEST - width(label.address, 11, True) - 4) + " " if label.name else ""
            content = bars(x, y, 10, 16) + slash + s.element("text", s.escape(name) + address, class_="el-name mid", x=x + 5, y=y - 12)
        return group(content, "contact open", word, self.labels, prefix)
