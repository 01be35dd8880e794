"""The program as highlighted instruction list, with line numbers, step numbers, names and comments."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

from ..assembler.program import Instruction, Program, Region, Unit, is_label
from ..devices import Bits, Constant, Device, IndexedConstant, Name
from . import svg as s
from .labels import Labels
from .lettering import columns, padded

MNEMONIC, OPERANDS = 6, 22


def listing(part: Program | Unit, program: Program | None = None) -> Listing:
    """The listing of a program or of one of its units; for a unit alone the program gives the names."""
    return Listing(part, part if isinstance(part, Program) else program)


@dataclass(frozen=True, slots=True)
class Row:
    """One line: its number in the source, its first program step, the words with their kinds, and its comment."""

    line: int
    step: int | None
    words: tuple[tuple[str, str], ...]  # (class, text)
    comment: str = ""
    key: str = ""  # of a line that can be lit; of an instruction "l" and its position
    region: tuple[int, ...] = ()  # the step, or the joined steps, that it belongs to

    @property
    def text(self) -> str:
        return "".join(text for _, text in self.words)


BLANK = Row(0, None, ())


class Listing:
    """Lines of a program. A drawing in HTML: `html()` gives it at rest, `state(plc)` the lines of active steps."""

    def __init__(self, part: Program | Unit, program: Program | None = None):
        self.program = program
        self.rows: list[Row] = []
        if isinstance(part, Program):
            self.rows += self._globals(part)
            bare = len(part.units) == 1 and not part.variables
            pointers = bool(part.model.syntax.pointers)  # units begin and end with instructions of their own
            for unit in part.units:
                self.rows += [BLANK] if pointers and self.rows else []
                self.rows += self._unit(unit, headed=not (bare or pointers))
        else:
            self.rows += self._unit(part, headed=False)

    # -- rows ---------------------------------------------------------------------------------------------------

    def _globals(self, program: Program) -> Iterator[Row]:
        if not program.variables:
            return
        yield _keyword("VAR_GLOBAL")
        room = max(columns(name) for name in program.variables)
        for variable in program.variables.values():
            words = (("name", "  " + padded(variable.name, room)), ("keyword", " AT "), _device(str(variable.device), variable.device))
            yield Row(variable.line, None, words, variable.comment)
        yield _keyword("END_VAR")

    def _unit(self, unit: Unit, headed: bool) -> Iterator[Row]:
        word = "PROGRAM" if unit.kind == "MAIN" else unit.kind
        if headed and self.rows:
            yield BLANK
        if headed:
            event = f" EVENT {unit.event}" if unit.event is not None else ""
            yield Row(unit.line, None, (("keyword", word), ("name", f" {unit.name}"), ("keyword", event)))
            for variable in unit.variables.values():
                yield Row(
                    variable.line,
                    None,
                    (("keyword", f"VAR_{variable.role} "), ("name", variable.name), ("keyword", f" : {variable.type.name}")),
                    variable.comment,
                )
        labels, steps = Labels(unit, self.program), _steps_of(unit)
        if unit.closed:
            yield Row(0, None, (("comment", "// closed by a password"),))
        for index, instruction in enumerate(() if unit.closed else unit.instructions):
            region = steps.get(index, ())
            lines = unit.titles[index].split("\n") if index in unit.titles else []
            if index and (lines or _opens(instruction)):
                yield Row(0, None, (), key=f"g{instruction.position}", region=() if _opens(instruction) else region)
            for n, line in enumerate(lines):
                words = (("comment", f"// {line}".rstrip()),)
                yield Row(instruction.line - len(lines) + n, None, words, key=f"c{instruction.position}.{n}", region=region)
            yield self._instruction(instruction, labels, region)
        if headed:
            yield _keyword(f"END_{word}")

    def _instruction(self, instruction: Instruction, labels: Labels, region: tuple[int, ...]) -> Row:
        if is_label(instruction.name, instruction.written):
            label = (("op", str(instruction)),)
            return Row(instruction.line, instruction.step, label, instruction.comment, f"l{instruction.position}", region)
        words = [("step" if _opens(instruction) else "op", padded(instruction.name, MNEMONIC - 1 if instruction.written else 0))]
        for text, operand in zip(instruction.written, instruction.operands, strict=True):
            kind, text = _device(text, operand)
            words += [("", " "), (kind, text)]
        others = [_other(text, operand, labels) for text, operand in zip(instruction.written, instruction.operands, strict=True)]
        comment = ", ".join(filter(None, [" ".join(filter(None, others)), instruction.comment]))
        return Row(instruction.line, instruction.step, tuple(words), comment, f"l{instruction.position}", region)

    # -- text ---------------------------------------------------------------------------------------------------

    def __str__(self) -> str:
        numbers = max((len(str(row.line)) for row in self.rows), default=1)
        steps = max((len(str(row.step)) for row in self.rows if row.step is not None), default=1)
        lines = []
        for row in self.rows:
            line = str(row.line) if row.line > 0 else ""
            step = "" if row.step is None else str(row.step)
            text = f"{padded(row.text, OPERANDS)}  // {row.comment}" if row.comment else row.text
            lines.append(f"{line:>{numbers}}  {step:>{steps}}  {text}".rstrip())
        return "\n".join(lines)

    def __repr__(self) -> str:
        count = sum(row.key[:1] == "l" for row in self.rows)
        return f"<Listing, {count} instruction{'s' if count != 1 else ''}>"

    # -- HTML ---------------------------------------------------------------------------------------------------

    def html(self, prefix: str = "") -> str:
        """The lines as an element of class "ec il"; every id begins with `prefix`."""
        return f'<div class="ec il" role="table" aria-label="Instruction list">{"".join(self._html_row(row, prefix) for row in self.rows)}</div>'

    @staticmethod
    def _html_row(row: Row, prefix: str) -> str:
        words = "".join(f'<span class="{kind}">{escape(text)}</span>' if kind else escape(text) for kind, text in row.words) or "&#8203;"
        comment = f"// {escape(row.comment)}" if row.comment else ""
        mark = f' id="{escape(prefix)}{row.key}"' if row.key else ""
        mark += f' data-position="{row.key[1:]}"' if row.key[:1] == "l" else ""
        alone = " alone" if row.key[:1] == "c" else ""
        return (
            f'<div class="row" role="row"{mark}><span class="cell line" role="cell">{row.line if row.line > 0 else ""}</span>'
            f'<span class="cell no" role="cell">{"" if row.step is None else row.step}</span>'
            f'<span class="cell{alone}" role="cell">{words}</span><span class="cell comment" role="cell">{comment}</span></div>'
        )

    def state(self, moment) -> dict[str, str]:
        """The class of each line, by "key:attribute": the lines of active steps are lit. `moment` is the Plc or a Session."""
        plc = getattr(moment, "plc", moment)
        steps = plc.memory.lists["S"]
        return {
            f"{row.key}:class": "row active" if plc.running and row.region and all(steps[number] for number in row.region) else "row"
            for row in self.rows
            if row.key
        }

    def _repr_html_(self) -> str:
        markup = self.html()
        return f"<style>{s.look('tokens.css')}\n{s.style(s.classes_of(markup) | {'il', 'active'})}</style>{markup}"


def _steps_of(unit: Unit) -> dict[int, tuple[int, ...]]:
    """By index of an instruction the steps it belongs to."""
    found: dict[int, tuple[int, ...]] = {}
    waiting = list(unit.nodes)
    while waiting:
        node = waiting.pop()
        if isinstance(node, Region):
            waiting += node.nodes
            if node.kind == "STL":
                found.update(dict.fromkeys(range(node.opening, node.closing), tuple(step.number for step in node.steps)))
    return found


def _opens(instruction: Instruction) -> bool:
    """Whether an instruction begins a step."""
    specs = instruction.definition.operands
    return bool(specs) and specs[0].kind == "STEP"


def _keyword(words: str) -> Row:
    return Row(0, None, (("keyword", words),))


def _device(text: str, operand) -> tuple[str, str]:
    """The kind of an operand as it is coloured, and its text."""
    if isinstance(operand, Constant | IndexedConstant):
        return "number", text
    if isinstance(operand, Device) and operand.area == "S":
        return "step", text
    if isinstance(operand, Name) or text.upper() != str(operand):
        return "name", text
    return "device", text


def _other(text: str, operand, labels: Labels) -> str:
    """Beside a name its device, beside a device its name."""
    if not isinstance(operand, Device | Bits):
        return ""
    return str(operand) if text.upper() != str(operand) else labels.names.get(str(operand), "")
