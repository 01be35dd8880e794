"""The symbols of ladder and chart as SVG: contacts, coils, function boxes. Each is drawn at rest, a class on its group lights it."""

from ..devices import Bits, Constant, Device, Name
from ..instructions import TABLE
from ..instructions.spelling import told
from ..models import Model
from . import svg as s
from .labels import COILS, EDGES, GATES, Label, Labels, constant_value, contact_words, figure, inverted, output_words, sign
from .lettering import cut, width
from .rungs import Word

BOX, LINE, PAD = 188, 18, 12
# The kinds of operand that are shown as a value on its way to a preset.
COUNTING = frozenset({"TIMER", "COUNTER", "DCOUNTER", "HCOUNTER"})


# -- contacts ---------------------------------------------------------------------------------------------------


def contact(word: Word, labels: Labels, x: float, y: float, room: float) -> str:
    """A contact with its middle at (x, y), its name and address above."""
    mark = f"M{s.number(x - 6)} {s.number(y + 9)}l12 -18" if inverted(word) else ""
    if word.mnemonic in EDGES:
        mark = gate_path(EDGES[word.mnemonic], x, y, 1)
    return (
        bars(x - 8, y, 16, 24) + (s.element("path", None, class_="mod", d=mark) if mark else "") + above(labels.contact(word), x, y, room)
    )


def gate(word: Word, x: float, y: float) -> str:
    """An element that changes the flow: an arrow for an edge, a stroke for the inversion, and its word."""
    return (
        bars(x - 8, y, 16, 24)
        + s.element("path", None, class_="mod", d=gate_path(word.mnemonic, x, y, 1))
        + s.text(x, y - 19, GATES[word.mnemonic], "el-edge mid")
    )


def gate_path(gate: str, x: float, y: float, scale: float) -> str:
    """The mark between the bars of a gate (EU, ED, INV); scale 1 in the ladder, smaller in a chart."""
    if gate == "INV":
        return f"M{s.number(x - 5 * scale)} {s.number(y)}h{s.number(10 * scale)}"
    up = 1 if gate == "EU" else -1
    head = 4 * scale
    return (
        f"M{s.number(x)} {s.number(y + up * 8 * scale)}V{s.number(y - up * 7 * scale)}"
        f"m{s.number(-head)} {s.number(up * 4.5 * scale)}l{s.number(head)} {s.number(-up * 4.5 * scale)}l{s.number(head)} {s.number(up * 4.5 * scale)}"
    )


def compare(word: Word, labels: Labels, x: float, y: float, size: float, prefix: str) -> str:
    """A compare contact from x on: operands inside, names above, values below."""
    left, right = labels.of(word, 0), labels.of(word, 1)
    parts = [bars(x, y, size, 28), s.text(x + size / 2, y + 4, compare_text(word), "cmp-text")]
    if left.name:
        parts.append(s.text(x + 2, y - 21, cut(left.name, size / 2 if right.name else size), "el-name"))
    if right.name:
        parts.append(s.text(x + size - 2, y - 21, cut(right.name, size / 2 if left.name else size), "el-name end"))
    if any(isinstance(operand, Device | Bits) for operand in word.operands):
        values = [_value_span(word, place, prefix) for place in range(2)]
        parts.append(s.element("text", f" {s.escape(sign(word)[-1])} ".join(values), class_="el-value mid", x=x + size / 2, y=y + 29))
    return "".join(parts)


def compare_text(word: Word) -> str:
    """What stands inside a compare contact."""
    return f"{word.operands[0]} {sign(word)} {word.operands[1]}"


def compare_width(word: Word) -> float:
    """How wide a compare contact is drawn."""
    return max(100, 4 * round((width(compare_text(word), 12, True) + 20) / 4))


def bars(x: float, y: float, size: float, height: float) -> str:
    """The two bars of a contact from x on, and the field between them."""
    top = s.number(y - height / 2)
    gap = s.element("rect", None, class_="gap", x=x, y=y - height / 2, width=size, height=height)
    return gap + f'<path class="bars" d="M{s.number(x)} {top}v{s.number(height)}M{s.number(x + size)} {top}v{s.number(height)}"/>'


def above(label: Label, x: float, y: float, room: float) -> str:
    """A name with its address below it, or the address alone."""
    if not label.name:
        return s.text(x, y - 18, cut(label.address, room, 12, True), "el-addr alone mid")
    return s.text(x, y - 32, cut(label.name, room), "el-name mid") + s.text(x, y - 18, label.address, "el-addr mid")


def beside(label: Label, x: float, y: float, room: float) -> str:
    """A name and its address behind it on one line."""
    if not label.name:
        return f'<text class="el-addr alone" x="{s.number(x)}" y="{s.number(y)}">{s.escape(cut(label.address, room, 12, True))}</text>'
    name = cut(label.name, max(24, room - 6 - width(label.address, 11, True)))
    return f'<text class="el-name" x="{s.number(x)}" y="{s.number(y)}">{s.escape(name)} <tspan class="el-addr">{s.escape(label.address)}</tspan></text>'


# -- coils and boxes --------------------------------------------------------------------------------------------


def coil(word: Word, labels: Labels, x: float, y: float, prefix: str) -> str:
    """A coil with its middle at (x, y); a set or reset coil tells the bit, which may differ from the flow."""
    letter = COILS[word.mnemonic]
    arcs = f"M{s.number(x - 7)} {s.number(y - 12)}a14 14 0 0 0 0 24M{s.number(x + 7)} {s.number(y - 12)}a14 14 0 0 1 0 24"
    parts = [s.element("circle", None, class_="core", cx=x, cy=y, r=9), s.element("path", None, class_="bars", d=arcs)]
    if letter:
        parts.append(s.text(x, y + 4, letter, "letter"))
        parts.append(s.text(x + 20, y - 6, "", "el-bit", id=f"{prefix}b{word.position}"))
    return "".join(parts) + above(labels.of(word, 0), x, y, 88)


def counts(word: Word) -> bool:
    """Whether a box shows a value on its way to a preset."""
    specs = TABLE[word.mnemonic].operands
    return len(specs) == 2 and specs[0].kind in COUNTING


def preset_text(word: Word) -> str:
    """The preset of a counting box as it is shown: its figure, or the device that holds it."""
    value = constant_value(word.operands[1])
    return str(word.operands[1]) if value is None else figure(value)


def value_room(word: Word) -> float:
    """The room for "3 of 5" when it is longest."""
    preset = constant_value(word.operands[1])
    return width(f"{figure(32767 if preset is None else preset)} of {preset_text(word)}", 12) + 8


def box_height(word: Word) -> tuple[float, float]:
    """How far a function box reaches above its wire, and its height."""
    if counts(word):
        return 23, 62
    lines = len(box_lines(word))
    return (17, 34) if lines < 2 else (23, 36 + LINE * lines)


def box_head(word: Word) -> str:
    """What is printed bold in a box: the mnemonic, of a call with the routine's name."""
    return " ".join([word.name, *(str(operand) for operand in word.operands[:1] if isinstance(operand, Name))])


def box_lines(word: Word) -> list[int]:
    """The operands that a box lists."""
    return [place for place, operand in enumerate(word.operands) if not isinstance(operand, Name)]


def box(word: Word, labels: Labels, x: float, y: float, prefix: str, model: Model) -> str:
    """A function box from x on, its wire at y."""
    up, height = box_height(word)
    frame = s.element("rect", None, class_="frame", x=x, y=y - up, width=BOX, height=height, rx=2)
    if counts(word):
        return frame + _counting(word, labels, x, y, prefix, model)
    lines = box_lines(word)
    if len(lines) < 2:
        return frame + _short(word, labels, x, y, prefix, lines)
    parts = [frame, s.text(x + PAD, y - 5, box_head(word), "op")]
    roles = labels.roles(word)
    indent = max([16, *(width(roles[place], 11) for place in lines)]) + 8
    for n, place in enumerate(lines):
        row = y + 16 + LINE * n
        parts.append(s.text(x + PAD, row, roles[place], "el-role"))
        parts.append(beside(labels.of(word, place), x + PAD + indent, row, BOX - 2 * PAD - indent - 52))
        parts.append(_value(word, place, x + BOX - PAD, row, prefix))
    return "".join(parts)


def _short(word: Word, labels: Labels, x: float, y: float, prefix: str, lines: list[int]) -> str:
    head = box_head(word)
    parts = [s.text(x + PAD, y + 4.5, head, "op")]
    if lines:
        start = max(40, width(head, 12, True) + 10)
        parts.append(beside(labels.of(word, lines[0]), x + PAD + start, y + 4.5, BOX - 2 * PAD - start - 40))
        parts.append(_value(word, lines[0], x + BOX - PAD, y + 4.5, prefix))
    return "".join(parts)


def _counting(word: Word, labels: Labels, x: float, y: float, prefix: str, model: Model) -> str:
    timer = word.operands[0]
    right = x + BOX - PAD
    base = model.timer_base_us(timer.number) / 1000 if isinstance(timer, Device) and timer.area == "T" else 0
    address = "" if isinstance(word.operands[1], Constant) else f' <tspan class="el-addr">{s.escape(preset_text(word))}</tspan>'
    preset = _value_span(word, 1, prefix) + address
    value = f'<tspan id="{prefix}v{word.position}.0"></tspan><tspan class="dim"> of {preset}</tspan>'
    return "".join(
        [
            s.text(x + PAD, y - 5, word.name, "op"),
            s.text(right, y - 5, f"{base:g} ms" if base else "", "el-addr end"),
            beside(labels.of(word, 0), x + PAD, y + 16, BOX - 2 * PAD - value_room(word)),
            s.element("text", value, class_="el-value end", x=right, y=y + 16),
            s.element("rect", None, class_="bar", x=x + PAD, y=y + 25, width=BOX - 2 * PAD, height=5),
            s.element("rect", None, class_="bar-on", id=f"{prefix}r{word.position}", x=x + PAD, y=y + 25, width=0, height=5),
        ]
    )


def _value(word: Word, place: int, x: float, y: float, prefix: str) -> str:
    """The present value of a device at the right end of a line."""
    if not isinstance(word.operands[place], Device | Bits):
        return ""
    return s.text(x, y, "", "el-value end", id=f"{prefix}v{word.position}.{place}")


def _value_span(word: Word, place: int, prefix: str) -> str:
    """A value within a line: of a device the present one, of a constant itself."""
    if isinstance(word.operands[place], Device | Bits):
        return f'<tspan id="{prefix}v{word.position}.{place}"></tspan>'
    value = constant_value(word.operands[place])
    return s.escape(figure(value) if value is not None else str(word.operands[place]))


# -- what goes with all of them ---------------------------------------------------------------------------------


def forced_mark(position: int, x: float, y: float, w: float, h: float, prefix: str) -> tuple[str, str]:
    """The hatched frame that lies below an element, and the badge above it; both are shown only while a device of it is forced."""
    n = s.number
    plate = f'<rect class="forced-plate" x="{n(x)}" y="{n(y)}" width="{n(w)}" height="{n(h)}" rx="3" fill="url(#{prefix}hatch)"/>'
    face = f'<rect class="forced-face" x="{n(x + 6)}" y="{n(y + 3)}" width="{n(w - 12)}" height="{n(h - 6)}"/>'
    badge = f'<rect class="forced-badge" x="{n(x + w - 17)}" y="{n(y - 7)}" width="30" height="15" rx="2"/>'
    letters = f'<text id="{prefix}g{position}" class="forced-text" x="{n(x + w - 2)}" y="{n(y + 4)}">F</text>'
    return (
        f'<g id="{prefix}f{position}" class="forced">{plate}{face}</g>',
        f'<g id="{prefix}h{position}" class="forced">{badge}{letters}</g>',
    )


def definitions(prefix: str) -> str:
    """What stands once in each picture: the pattern of what is forced."""
    line = '<rect class="hatch-line" width="3" height="7"/>'
    return f'<defs><pattern id="{prefix}hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">{line}</pattern></defs>'


def spoken(word: Word, labels: Labels) -> str:
    """An element in words, without its state."""
    definition = TABLE[word.mnemonic]
    if word.mnemonic in GATES:
        return GATES[word.mnemonic] + (" edge" if word.mnemonic != "INV" else " flow")
    return contact_words(word, labels) if definition.form == "contact" else output_words(word, labels)


def tip(word: Word, labels: Labels) -> str:
    """What the pointer learns about an element: itself in words, what it does, its comment, its step."""
    own = "" if labels.unit.kind == "MAIN" or not labels.own(word) else labels.unit.name
    row = TABLE[word.mnemonic]
    does = told(labels.program.model, row, row.title) if labels.program else row.title
    lines = [spoken(word, labels), does, *labels.comment(word), f"step {word.step}" if word.step >= 0 else ""]
    lines.append(f"a value of {own}'s own is there only after a call in the scan that is shown" if own else "")
    return s.tip("\n".join(filter(None, lines)))


def group(content: str, class_: str, word: Word, labels: Labels, prefix: str) -> str:
    """The group of one element: its id, what it is in words, and where it stands in the program."""
    device = next((str(operand) for operand in word.operands if isinstance(operand, Device | Bits)), None)
    marks = {"data_position": str(word.position), "data_device": device, "role": "button", "aria_label": spoken(word, labels)}
    return s.element("g", tip(word, labels) + content, id=f"{prefix}e{word.position}", class_=class_, **marks)


def forcible(word: Word) -> list[str]:
    """The devices of an element that can be forced."""
    return [
        str(operand)
        for operand in word.operands
        if isinstance(operand, Device) and operand.index is None and operand.area not in ("T", "C")
    ]
