"""The ladder of a program: every network as a rung, as SVG, as text and with the power flow of a scan."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from ..assembler.program import Network, Program, Unit, is_label
from ..devices import Bits, Device
from ..instructions import TABLE
from ..models import Model, get_model
from . import svg as s
from . import symbols
from .labels import COILS, Labels, compares
from .ladder_live import Live
from .ladder_text import draw
from .layout import Layout, Size, Symbol
from .lettering import cut, width
from .rungs import Gate, Output, Rung, Word, depth, instruction_list, rung, unit_of

# Lengths in px, as the look has them.
MARGIN, RAIL_STEP, RIGHT_RAIL, EDGE, PLATE = 64, 22, 944, 16, 38
TITLE_LINE, BUS_ROW, HEAD = 18, 52, 34
LETTERS = {"net-title": 13, "note": 12}  # their sizes in px, tokens.css
NATURAL, NARROW, WITH_NOTES, NOTES = 960, 700, 1100, 282
CELLS = (112, 104, 96, 88, 80)  # a contact's cell: the widest where there is room, a narrower one where a panel then needs no scrolling
KEPT = 3  # sheets of a ladder
DEEPEST = 80  # a tree nested deeper is listed instead of drawn


def ladder(part: Program | Unit | Network, program: Program | None = None) -> Ladder:
    """The ladder of a program, of one of its units or of one network; for a unit or network the program gives the names."""
    if isinstance(part, Program):
        return Ladder(part.units, part)
    if isinstance(part, Unit):
        return Ladder([part], program)
    if program is None:
        raise TypeError("a network alone does not know its instructions: write ladder(network, program)")
    unit = unit_of(part, program)
    whole = Ladder([unit], program)
    return whole[next(place for place, network in enumerate(unit.networks) if network is part)]


@dataclass(frozen=True, slots=True)
class Entry:
    """One network of a ladder; `heading` is what stands over it where a unit begins that is not alone."""

    unit: Unit
    labels: Labels
    rung: Rung
    words: tuple[Word, ...]
    heading: str = ""
    drawn: bool = True  # as contacts and coils; else a row on the bus, or a list


class Ladder:
    """Networks one below the other. A drawing: `svg()` gives the picture at rest, `state(plc)` what changes in it."""

    def __init__(self, units: Sequence[Unit], program: Program | None = None):
        self.program = program
        self.model = program.model if program else get_model("EC20")
        self.entries: list[Entry] = []
        for unit in units:
            if unit.closed:
                continue  # a password closes it (2.1.11)
            labels = Labels(unit, program)
            for place, network in enumerate(unit.networks):
                tree = rung(unit, network)
                over = heading(unit) if len(units) > 1 and not place else ""
                self.entries.append(Entry(unit, labels, tree, tuple(tree.words), over, is_drawn(tree)))
        self._sizes: dict[tuple[float, int], Size] = {}
        self._layouts: dict[tuple[float, int], Layout] = {}
        self._rights: dict[float, dict[int, float]] = {}
        self._sheets: dict[int | None, Sheet] = {}
        self._drawn: int | None = None

    def __getitem__(self, which: int | slice) -> Ladder:
        """Some of the networks, counted from 0 in the order in which they are shown."""
        part = Ladder([], self.program)
        part.model = self.model
        part.entries = self.entries[which] if isinstance(which, slice) else [self.entries[which]]
        return part

    def __len__(self) -> int:
        return len(self.entries)

    @property
    def rungs(self) -> list[Rung]:
        """The networks as trees."""
        return [entry.rung for entry in self.entries]

    def instruction_list(self) -> list[Word]:
        """The instructions that the ladder is drawn from."""
        return instruction_list(self.rungs)

    def svg(self, prefix: str = "", width: int | None = None) -> str:
        """The picture at rest, `width` px wide or as much more as the program needs; every id begins with `prefix`."""
        self._drawn = width
        return self.sheet(width).picture(prefix)

    def state(self, moment) -> dict[str, str]:
        """What changes in the picture last drawn, by "key:attribute"; `moment` is the Plc.

        While the Plc traces, the power of its last scan is shown; else only what contacts, coils and registers hold.
        """
        return self.sheet(self._drawn).state(moment)

    def sheet(self, width: int | None = None) -> Sheet:
        """The ladder laid out for a width, from which single networks can be had; the last few widths are kept."""
        if width not in self._sheets:
            if len(self._sheets) >= KEPT:
                del self._sheets[next(iter(self._sheets))]
            self._sheets[width] = Sheet(self, width)
        return self._sheets[width]

    def layout(self, entry: Entry, cell: float) -> Layout:
        """What lays out a network of a unit with a width of cell."""
        key = cell, id(entry.labels)
        if key not in self._layouts:
            self._layouts[key] = Layout(Lengths(entry.labels, cell))
        return self._layouts[key]

    def size(self, number: int, cell: float) -> Size:
        """The least room of a network with a width of cell."""
        if (cell, number) not in self._sizes:
            entry = self.entries[number]
            self._sizes[cell, number] = self.layout(entry, cell).size(entry.rung)
        return self._sizes[cell, number]

    def rail(self, number: int, cell: float) -> float:
        """Where a network with a width of cell needs the right rail, at the least."""
        return MARGIN + RAIL_STEP * len(railed(self.entries[number].rung)) + self.size(number, cell).width

    def rights(self, cell: float) -> dict[int, float]:
        """Where each drawn network needs the right rail."""
        if cell not in self._rights:
            self._rights[cell] = {number: self.rail(number, cell) for number, entry in enumerate(self.entries) if entry.drawn}
        return self._rights[cell]

    def _repr_svg_(self) -> str:
        return s.standalone(self.svg())

    def __str__(self) -> str:
        return draw(self)

    def __repr__(self) -> str:
        return f"<Ladder, {len(self)} network{'s' if len(self) != 1 else ''}>"


def heading(unit: Unit) -> str:
    """A unit's name with what a call gives it, or the event that it serves."""
    word = {"MAIN": "Main program", "SUBROUTINE": "Subroutine", "INTERRUPT": "Interrupt program"}[unit.kind]
    name = "" if unit.kind == "MAIN" and unit.name.upper() == "MAIN" else f" {unit.name}"
    parameters = f" ({', '.join(f'{v.name} : {v.type.name}' for v in unit.parameters)})" if unit.parameters else ""
    return f"{word}{name}{parameters}" + (f", event {unit.event}" if unit.event is not None else "")


@dataclass(frozen=True)
class Lengths:
    """The look's lengths for `Layout`: a contact of 16 px in a cell of 112, coils of 28, boxes of 188."""

    labels: Labels
    cell: float = 112
    lead: float = 12
    drop: float = 28
    row: float = 64
    gap: float = 6

    @property
    def bar(self) -> float:
        """From the bar of a parallel to the next cell."""
        return 20 if self.cell == CELLS[0] else 14

    def names(self, word: Word) -> float:
        """The room above a contact or coil: for name and address, or for the address alone."""
        return 44 if self.labels.of(word, 0).name else 30

    def contact(self, word: Word) -> Size:
        if compares(word):
            box = symbols.compare_width(word)
            side = 34 if self.cell > 104 else 26
            values = any(isinstance(operand, Device | Bits) for operand in word.operands)
            return Size(box + 2 * side, 34, 36 if values else 18, side, side + box)
        return Size(self.cell, self.names(word), 14, self.cell / 2 - 8, self.cell / 2 + 8)

    def gate(self, word: Word) -> Size:
        cell = self.cell if self.cell == CELLS[0] else 72
        return Size(cell, 32, 14, cell / 2 - 8, cell / 2 + 8)

    def output(self, word: Word) -> Size:
        if word.mnemonic in COILS:
            return Size(88, self.names(word), 14, 31, 57)
        up, height = symbols.box_height(word)
        return Size(symbols.BOX + EDGE, up, height - up, 0, symbols.BOX)


@dataclass(frozen=True, slots=True)
class Rail:
    """The piece of a left rail that lies in one network.

    `position` is of an instruction that is executed while the rail is live; -1 for the main one.
    """

    key: str
    position: int
    x: float
    top: float
    bottom: float


@dataclass(slots=True)
class Strip:
    """One network in its place on a sheet."""

    number: int
    entry: Entry
    top: float
    wire: float  # the height of its first wire
    height: float
    left: float  # the rail it hangs on
    regions: tuple[tuple[str, int], ...]  # those that draw a rail of their own
    rails: list[Rail] = field(default_factory=list)

    @property
    def above(self) -> float:
        """Where its room begins: with the heading over it."""
        return self.top - (HEAD if self.entry.heading else 0)

    @property
    def bottom(self) -> float:
        """Where its room ends."""
        return self.top + self.height


class Sheet:
    """A ladder laid out for one width. Where each network lies is known at once; a network is placed and drawn when it is asked for."""

    def __init__(self, ladder: Ladder, asked: int | None):
        asked = asked or NATURAL
        self.ladder = ladder
        self.model: Model = ladder.model
        self.program = ladder.program
        with_notes = asked >= WITH_NOTES
        self.cell, needed = self._fit(asked)
        self.right = max(min(RIGHT_RAIL, asked - NOTES) if with_notes else asked - EDGE, needed)
        self.notes = self.right + 24 if with_notes else 0
        self.width = max(asked, self.right + (NOTES if with_notes else EDGE))
        self.strips: list[Strip] = []
        top = 8.0
        for number, entry in enumerate(ladder.entries):
            self.strips.append(self._strip(number, entry, top + (HEAD if entry.heading else 0)))
            top = self.strips[-1].bottom
        self.height = top + 8
        self._lay_rails()
        self._lives: dict[int, Live] = {}

    def _fit(self, asked: int) -> tuple[float, float]:
        """The widest cell with which every network has room, and where the right rail must then be.

        A network that has room with a wide cell has it with a narrower one, too.
        """
        cells = CELLS if asked < NARROW else CELLS[:1]
        rights = self.ladder.rights(cells[0])
        needed = max(rights.values(), default=0)
        if needed <= asked - EDGE:
            return cells[0], needed
        wide = sorted((number for number, right in rights.items() if right > asked - EDGE), key=rights.__getitem__, reverse=True)
        for cell in cells[1:]:
            if all(self.ladder.rail(number, cell) <= asked - EDGE for number in wide):
                return cell, asked - EDGE
        cell = CELLS[1] if asked < NARROW else CELLS[0]
        return cell, max(self.ladder.rail(number, cell) for number in wide)

    def _strip(self, number: int, entry: Entry, top: float) -> Strip:
        rung = entry.rung
        title = entry.words[0].title
        titles = title.count("\n") + 1 if title else 0
        lines = 14 + TITLE_LINE * titles - 10 if titles else 0
        regions = railed(rung)
        if entry.drawn:
            size = self.ladder.size(number, self.cell)
            wire = max(lines + size.up + 8, 56)
            height = wire + size.down + 14
        elif is_bus(rung):
            wire, height = lines + 28, lines + BUS_ROW
        else:
            wire = lines + 34
            height = lines + 36 + symbols.LINE * len(entry.words)
        if self.notes:
            height = max(height, 10 + TITLE_LINE * len(remarks(entry)))
        return Strip(number, entry, top, top + wire, height, MARGIN + RAIL_STEP * len(regions), regions)

    def _lay_rails(self) -> None:
        """Give each strip its pieces of the left rails: the main one, and those that MC and STL open inside it."""
        count = 0
        opened: list[tuple[int, int, int, float]] = []  # number, first position, first strip, where it begins
        for number, strip in enumerate(self.strips):
            if strip.entry.heading or number == 0:
                main, count = count, count + 1
            strip.rails.append(Rail(f"rail{main}.{number}", -1, float(MARGIN), strip.top, strip.bottom))
            while len(opened) < len(strip.regions):
                # A rail begins beside the row that opens it, where that is shown.
                beside = number > 0 and not strip.entry.heading
                begin = self.strips[number - 1].wire if beside else strip.top
                opened.append((count, strip.entry.words[0].position, number - beside, begin))
                count += 1
            after = self.strips[number + 1] if number + 1 < len(self.strips) else None
            following = after.regions if after and not after.entry.heading else ()
            fresh = after is not None and opens(after.entry.rung)
            while opened and (strip.regions[: len(opened)] != following[: len(opened)] or (fresh and len(opened) > len(following))):
                rail, first, begins, top = opened.pop()
                x = float(MARGIN + RAIL_STEP * (len(opened) + 1))
                for piece in self.strips[begins : number + 1]:
                    bottom = piece.bottom - 4 if piece is strip else piece.bottom
                    piece.rails.append(Rail(f"rail{rail}.{piece.number}", first, x, max(top, piece.top), bottom))

    def live(self, number: int) -> Live:
        """What changes in a network."""
        if number not in self._lives:
            strip = self.strips[number]
            layout = self.ladder.layout(strip.entry, self.cell)
            placed = layout.place(strip.entry.rung, self.right - strip.left) if strip.entry.drawn else None
            self._lives[number] = Live(strip, placed, self.model)
        return self._lives[number]

    def state(self, moment, numbers: Iterable[int] | None = None) -> dict[str, str]:
        """What changes in the networks of some numbers, or in all, as a Plc has it now."""
        memory, running = moment.memory, moment.running
        same = self.program is None or moment.program is self.program
        trace = moment.trace if running and moment.tracing and same else None
        forced = moment.forced
        entries: dict[str, str] = {}
        for number in range(len(self.strips)) if numbers is None else numbers:
            self.live(number).put(entries, memory, trace, running, forced)
        return entries

    # -- the picture --------------------------------------------------------------------------------------------

    def picture(self, prefix: str) -> str:
        """The root `<svg>` at rest with all networks."""
        return self.shell(prefix, "".join(self.network(number, prefix) for number in range(len(self.strips))))

    def shell(self, prefix: str, content: str = "") -> str:
        """The root `<svg>` in its whole size, with the networks that are given."""
        units = ", ".join(dict.fromkeys(strip.entry.unit.name for strip in self.strips))
        label = f"Ladder of {units}, {len(self.strips)} network{'s' if len(self.strips) != 1 else ''}"
        size = {"width": self.width, "height": self.height, "viewBox": f"0 0 {s.number(self.width)} {s.number(self.height)}"}
        content = symbols.definitions(prefix) + content
        return s.element("svg", content, xmlns="http://www.w3.org/2000/svg", class_="ec ladder", role="img", aria_label=label, **size)

    def network(self, number: int, prefix: str) -> str:
        """One network at rest, in its place on the sheet."""
        strip = self.strips[number]
        rung, top = strip.entry.rung, strip.top
        parts = [s.text(18, top - 12, strip.entry.heading, "unit-title")] if strip.entry.heading else []
        parts += self._frame(strip, prefix)
        parts.append(s.text(18, top + 14, str(rung.number + 1), "net-no"))
        for line, words in enumerate(rung.title.split("\n") if rung.title else []):
            parts.append(self._title(words, strip.left + 16, top + 14 + TITLE_LINE * line, "note" if line else "net-title"))
        parts.append(s.text(MARGIN - 12, strip.wire + 4, str(strip.entry.words[0].step), "step-no end"))
        parts.append(self._region(strip, prefix))
        live = self.live(number)
        if live.placed:
            parts += [self._symbol(strip, symbol, prefix) for symbol in live.placed.symbols]
            parts += self._wires(live, prefix)
        else:
            parts += self._bus(strip, prefix) if is_bus(rung) else self._list(strip)
        if self.notes:
            room = self.width - self.notes - 12
            for line, words in enumerate(remarks(strip.entry)):
                parts.append(s.text(self.notes, top + 14 + TITLE_LINE * line, cut(words, room), "note" if line else "note note-1"))
        return s.element("g", "".join(parts), class_="net", data_network=str(rung.number), data_unit=strip.entry.unit.name)

    def _title(self, words: str, x: float, y: float, class_: str) -> str:
        """A line of a title as far as there is room before the right rail; the whole of it is the tip of a shortened one."""
        shown = cut(words, self.right - x - 8, LETTERS[class_])
        return s.element("text", s.escape(shown) + (s.tip(words) if shown != words else ""), class_=class_, x=x, y=y)

    def _frame(self, strip: Strip, prefix: str) -> Iterator[str]:
        """The line above a network, and its pieces of the rails."""
        if strip.number and not strip.entry.heading:
            yield f'<path class="hair" d="M0 {s.number(strip.top + 0.5)}H{s.number(self.width)}"/>'
        yield f'<path class="rail-right" d="M{s.number(self.right)} {s.number(strip.top)}V{s.number(strip.bottom)}"/>'
        for rail in strip.rails:
            path = f"M{s.number(rail.x)} {s.number(rail.top)}V{s.number(rail.bottom)}"
            yield s.element("path", None, id=prefix + rail.key, class_="rail", d=path)

    def _region(self, strip: Strip, prefix: str) -> str:
        """What encloses the network, in the margin: a step as its box, MC and FOR as a word."""
        region = strip.entry.rung.region
        if not region:
            return ""
        kind, number = region[-1]
        if kind != "STL":
            return s.text(18, strip.top + 32, f"{kind} {level(self.model, number)}" if kind == "MC" else kind, "step-no")
        box = s.element("rect", None, class_="box", x=12, y=strip.top + 21, width=40, height=20, rx=2)
        return s.element("g", box + s.text(32, strip.top + 35, f"S{number}", "step-id small"), id=f"{prefix}m{strip.number}", class_="step")

    def _wires(self, live: Live, prefix: str) -> Iterator[str]:
        """Two paths for all wires and two for all dots, dead and live."""
        for letter, class_ in (("w", "wire"), ("o", "node"), ("p", "wire on"), ("q", "node on")):
            key = f"{letter}{live.number}"
            yield s.element("path", None, id=prefix + key, class_=class_, d=live.rest[f"{key}:d"])

    def _symbol(self, strip: Strip, symbol: Symbol, prefix: str) -> str:
        word, labels = symbol.item.word, strip.entry.labels
        x, y = strip.left + symbol.x, strip.wire + symbol.y
        middle = x + symbol.size.width / 2
        around = middle - 29, y - 46, 58, 64
        if isinstance(symbol.item, Gate):
            class_, content = "contact open", symbols.gate(word, middle, y)
        elif isinstance(symbol.item, Output) and word.mnemonic in COILS:
            class_, content = "coil open", symbols.coil(word, labels, middle, y, prefix)
        elif isinstance(symbol.item, Output):
            class_, content = "fbox open", symbols.box(word, labels, x, y, prefix, self.model)
            up, height = symbols.box_height(word)
            around = x - 7, y - up - 5, symbols.BOX + 14, height + 10
        elif compares(word):
            box = symbol.size.leave - symbol.size.enter
            class_, content = "contact open", symbols.compare(word, labels, x + symbol.size.enter, y, box, prefix)
            around = x + symbol.size.enter - 9, y - 36, box + 18, 72
        else:
            class_, content = "contact open", symbols.contact(word, labels, middle, y, symbol.size.width - 6)
        if symbols.forcible(word):
            plate, badge = symbols.forced_mark(word.position, *around, prefix)
            content = plate + content + badge
        return symbols.group(content, class_, word, labels, prefix)

    def _bus(self, strip: Strip, prefix: str) -> Iterator[str]:
        """A row of boxes on the bus: STL, RET, MCR, NEXT, LBL."""
        x, y = strip.left + PLATE, strip.wire
        yield s.element(
            "path", None, id=f"{prefix}x{strip.number}", class_="wire", d=f"M{s.number(strip.left)} {s.number(y)}H{s.number(x)}"
        )
        for word in strip.entry.words:
            label = strip.entry.labels.of(word, 0) if word.operands else None
            if is_step(word):
                letters, class_, size = label.address, "step", max(58, width(label.address, 13, True) + 16)
                inside = s.element("rect", None, class_="box", x=x, y=y - 14, width=size, height=28, rx=2) + s.text(
                    x + size / 2, y + 4.5, letters, "step-id"
                )
                yield symbols.group(inside, class_, word, strip.entry.labels, prefix)
                if label.name:
                    yield s.text(x + size + 8, y + 4, label.name, "el-name")
                    size += 8 + width(label.name)
            else:
                letters = str(word) if is_label(word.name, word.written) else f"{word.name} {label.address}" if label else word.name
                size = max(84, width(letters, 12, True) + 24)
                frame = s.element("rect", None, class_="frame", x=x, y=y - 14, width=size, height=28, rx=2)
                yield symbols.group(frame + s.text(x + 12, y + 4.5, letters, "op"), "fbox open", word, strip.entry.labels, prefix)
            x += size + 12

    def _list(self, strip: Strip) -> Iterator[str]:
        """A rung that is nested too deep to be drawn: its instructions."""
        height = 12 + symbols.LINE * len(strip.entry.words)
        yield s.element("rect", None, class_="frame", x=strip.left + 16, y=strip.wire - 18, width=240, height=height, rx=2)
        for line, word in enumerate(strip.entry.words):
            yield s.text(strip.left + 28, strip.wire + symbols.LINE * line, str(word), "op")


# -- what kind of row a rung is ---------------------------------------------------------------------------------


def is_bus(rung: Rung) -> bool:
    """Whether it stands on the left bus without a flow: STL, RET, MCR, NEXT, LBL."""
    return TABLE[rung.head.mnemonic].bus


def is_drawn(rung: Rung) -> bool:
    """Whether it is laid out as contacts and coils."""
    return not is_bus(rung) and depth(rung.flow) <= DEEPEST


def level(model: Model, number: int) -> str:
    """The number of a structure as the family writes it: 3, N3."""
    return f"{model.syntax.pointers.get('NEST', '')}{number}"


def is_step(word: Word) -> bool:
    """Whether it opens a step."""
    return bool(word.operands) and TABLE[word.mnemonic].operands[0].kind == "STEP"


def opens(rung: Rung) -> bool:
    """Whether it is the row that opens a step."""
    return is_step(rung.head)


def railed(rung: Rung) -> tuple[tuple[str, int], ...]:
    """The regions around a rung that draw a rail of their own: MC and STL."""
    return tuple(region for region in rung.region if region[0] != "FOR")


def remarks(entry: Entry) -> list[str]:
    """The comments of a network's instructions, each behind what it speaks of."""
    found = []
    for word in entry.words:
        if word.comment:
            about = str(entry.labels.of(word, 0)) if word.operands else word.name
            found.append(f"{about}: {word.comment}")
    return found
