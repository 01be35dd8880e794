"""Help while a program is typed: completion, the operands of an instruction, and what is wrong with the text. For the editor and for `%%il`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from ecsim.assembler import assemble
from ecsim.assembler.reader import HEADERS, RawUnit, Source, read
from ecsim.devices import Bits, Device, number_text
from ecsim.errors import ProgramError
from ecsim.instructions import Definition
from ecsim.instructions.signature import OperandSpec
from ecsim.instructions.spelling import instructions_of
from ecsim.models import Model

MOST = 60  # completions that are offered at once
_WORD = re.compile(r"[^\s,]+")


class Option(NamedTuple):
    """One completion: what is put in, what kind of word it is, and a few words about it."""

    text: str
    kind: str
    about: str


class Mark(NamedTuple):
    """A problem in the text: line and column from 1, how many characters it spoils, the sentence, the manual's section."""

    line: int
    column: int
    length: int
    words: str
    section: str


def marks(text: str, model: Model) -> list[Mark]:
    """Every problem of a text, none where it can be downloaded."""
    try:
        assemble(text, model)
    except ProgramError as error:
        lines = text.split("\n")
        return [_mark(problem, lines) for problem in error.problems]
    return []


def _mark(problem, lines: list[str]) -> Mark:
    line = min(max(problem.line, 1), len(lines))
    written = lines[line - 1].split("//")[0]
    word = _WORD.match(written, problem.column - 1) if problem.column else None
    if word is None:  # the line as a whole
        start = len(written) - len(written.lstrip())
        column, length = start + 1, max(1, len(written.strip()))
    else:
        column, length = word.start() + 1, len(word[0])
    return Mark(line, column, length, f"{problem.message}; {problem.hint}" if problem.hint else problem.message, problem.section)


class Place:
    """Where the cursor stands in a text: the word before it, the words of its line, and what the text declares."""

    def __init__(self, text: str, at: int, model: Model):
        self.model = model
        before = text[:at]
        line = before.rpartition("\n")[2]
        self.commented = "//" in line or _open_comment(before)
        self.word = re.search(r"[^\s,]*$", line)[0]
        self.start = at - len(self.word)
        self.words = _WORD.findall(line[: len(line) - len(self.word)])
        self.source: Source = read(text, syntax=model.syntax)
        self.unit = self._unit(before.count("\n") + 1)

    def _unit(self, line: int) -> RawUnit | None:
        return next((unit for unit in reversed(self.source.units) if unit.line <= line), None)

    @property
    def definition(self) -> Definition | None:
        """The instruction of the line, once its word is written."""
        return instructions_of(self.model).get(self.words[0].upper()) if self.words else None

    def options(self) -> list[Option]:
        """What the word before the cursor may become: instructions at the line's begin, else what fits the operand."""
        if self.commented:
            return []
        offered = self._operands() if self.words else self._firsts()
        typed = self.word.casefold()
        found = {option.text: option for option in offered if option.text.casefold().startswith(typed) and option.text != self.word}
        return list(found.values())[:MOST]

    def _firsts(self) -> Iterator[Option]:
        for mnemonic, row in instructions_of(self.model).items():
            yield Option(mnemonic, "op", row.title)
        for header in ("VAR_GLOBAL", "END_VAR") if self.model.syntax.pointers else sorted(HEADERS):
            yield Option(header, "keyword", "")

    def _operands(self) -> Iterator[Option]:
        row, place = self.definition, len(self.words) - 1
        if row is None:
            return
        if row.mnemonic == "CALL":
            yield from self._routines() if place == 0 else self._of_areas(None)
        elif place < len(row.operands):
            yield from self._of_areas(row.operands[place])

    def _routines(self) -> Iterator[Option]:
        for unit in self.source.units:
            if unit.kind == "SUBROUTINE":
                yield Option(unit.name, "name", "subroutine")

    def _of_areas(self, spec: OperandSpec | None) -> Iterator[Option]:
        """Variables, the devices that the text speaks of already, and each area's next free device."""
        areas = None if spec is None else spec.areas
        parse = self.model.syntax.parse
        used: dict[str, set[int]] = {}
        for variable in self.source.globals:
            device = _parsed(parse, variable.what)
            if isinstance(device, Device) and (areas is None or device.area in areas):
                yield Option(variable.name, "name", f"{device} {variable.comment}".strip())
        for variable in self.unit.variables if self.unit else ():
            if spec is None or variable.what == spec.type.name:
                yield Option(f"#{variable.name}", "name", f"{variable.role.lower()} {variable.what} {variable.comment}".strip())
        names = {variable.what.upper(): variable.name for variable in self.source.globals}
        for unit in self.source.units:
            for statement in unit.statements:
                for word in statement.operands:
                    operand = _parsed(parse, word.upper())
                    if isinstance(operand, Device):
                        used.setdefault(operand.area, set()).add(operand.number)
                    kind = f"Kn{operand.area}" if isinstance(operand, Bits) else getattr(operand, "area", None)
                    if isinstance(operand, Device | Bits) and (areas is None or kind in areas) and word != self.word:
                        yield Option(str(operand), "device", names.get(str(operand), "used in this program"))
        for area in spec.order if spec else ():
            if area in self.model.areas:
                room = self.model.areas[area]
                first = next((number for number in range(room.end(0)) if number not in used.get(area, ())), 0)
                yield Option(f"{area}{number_text(area, first)}", "device", f"the first one unused, of {room.span}")

    def signature(self) -> dict | None:
        """The instruction of the line with its operands, and which of them is being typed; None where there is none."""
        row = self.definition
        if row is None or self.commented:
            return None
        return {
            "mnemonic": self.words[0].upper(),
            "title": row.title,
            "section": row.section,
            "at": len(self.words) - 1,
            "operands": [[spec.name, _use(spec)] for spec in row.operands],
        }


def _use(spec: OperandSpec) -> str:
    words = {"const": "constant", "routine": "subroutine", "text": "text"}
    limits = f", {spec.range[0]} to {spec.range[1]}" if spec.range else ""
    return f"{spec.type.name}{', written' if spec.written else ''}{limits}: {' '.join(words.get(area, area) for area in spec.order)}"


def _parsed(parse, word: str):
    try:
        return parse(word)
    except ValueError:
        return None


def _open_comment(before: str) -> bool:
    """Whether the end of a text lies in a block comment."""
    code = re.sub(r"/\*.*?\*/|\(\*.*?\*\)|//[^\n]*", "", before, flags=re.DOTALL)
    return "/*" in code or "(*" in code
