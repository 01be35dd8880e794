"""Help while a program is typed: completion, the operands of an instruction, and what is wrong with the text. For the editor and for `%%il`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import NamedTuple

from ecsim.assembler import assemble
from ecsim.assembler.operands import Refused, Resolver
from ecsim.assembler.reader import HEADERS, RawUnit, Source, code_of, read
from ecsim.devices import Bits, Device, Operand, Pointer, number_text
from ecsim.errors import ProgramError
from ecsim.instructions import TABLE, Definition
from ecsim.instructions.spelling import choices_of, instructions_of, pulse_forms_of, section_of, told
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
        return [_mark(problem, lines, model) for problem in error.problems]
    return []


def _mark(problem, lines: list[str], model: Model) -> Mark:
    line = min(max(problem.line, 1), len(lines))
    written = code_of(lines[line - 1], model.syntax)
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
        self.resolver = Resolver(model, {})
        before = text[:at]
        line = before.rpartition("\n")[2]
        self.commented = code_of(line, model.syntax) != line or _open_comment(before)
        self.word = re.search(r"[^\s,]*$", line)[0]
        self.start = at - len(self.word)
        self.words = _WORD.findall(line[: len(line) - len(self.word)])
        self.source: Source = read(text, syntax=model.syntax)
        name = self.words[0].upper() if self.words else ""
        self.row, self.choice = self._rows().get(name), choices_of(model).get(name)
        self.known = [self._known(word) for word in self.words[1:]]
        self.unit = self._unit(before.count("\n") + 1)

    def _unit(self, line: int) -> RawUnit | None:
        return next((unit for unit in reversed(self.source.units) if unit.line <= line), None)

    def _rows(self) -> dict[str, Definition]:
        return instructions_of(self.model) | pulse_forms_of(self.model)

    def _known(self, word: str) -> Operand | None:
        """The operand that a word or a global variable's name stands for."""
        meant = next((variable.what for variable in self.source.globals if variable.name.casefold() == word.casefold()), word)
        return _parsed(self.model.syntax.parse, meant.upper())

    def _forms(self, *more: Operand) -> tuple[Definition, ...]:
        """The rows that the line's instruction may be with the operands before the cursor, and more of them; the usual one first."""
        if self.choice:
            return tuple(TABLE[key] for key in dict.fromkeys(self.choice.behind((*self.known, *more))))
        return (self.row,) if self.row else ()

    def _areas(self, row: Definition, place: int) -> list[str]:
        """Where an operand of a form may lie, without the devices with which another form is meant."""
        room = self.model.areas

        def meant(area: str) -> bool:
            return any(row in self._forms(Device(area, number)) for number in range(room[area].count))

        here = self.choice and place == len(self.known)
        return [area for area in self.resolver.areas(row.operands[place]) if not here or area not in room or meant(area)]

    def _takes(self, operand: Device | Bits) -> bool:
        """Whether a form that is open takes an operand where the cursor stands."""
        place = len(self.known)
        for row in self._forms(operand):
            try:
                self.resolver.check(row.operands[place], operand, str(operand))
                return True
            except (IndexError, Refused):
                continue
        return False

    def options(self) -> list[Option]:
        """What the word before the cursor may become: instructions at the line's begin, else what fits the operand."""
        if self.commented:
            return []
        offered = self._operands() if self.words else self._firsts()
        typed = self.word.casefold()
        found = {option.text: option for option in offered if option.text.casefold().startswith(typed) and option.text != self.word}
        return list(found.values())[:MOST]

    def _firsts(self) -> Iterator[Option]:
        for name, row in self._rows().items():
            if name not in self.model.syntax.pointers.values():  # these are written with their number
                yield Option(name, "op", told(self.model, row, row.title))
        for header in ("VAR_GLOBAL", "END_VAR") if self.model.syntax.pointers else sorted(HEADERS):
            yield Option(header, "keyword", "")

    def _operands(self) -> Iterator[Option]:
        place = len(self.known)
        if self.row and self.row.mnemonic == "CALL":
            yield from self._routines() if place == 0 else () if self.model.syntax.pointers else self._devices((), lambda operand: True)
            return
        specs = [row.operands[place] for row in self._forms() if place < len(row.operands)]
        letters = {self.model.syntax.pointers.get(spec.kind) for spec in specs} - {None}
        if letters:
            yield from self._pointers(letters)
        if specs:
            areas = dict.fromkeys(area for row in self._forms() if place < len(row.operands) for area in self._areas(row, place))
            yield from self._devices(areas, self._takes, {spec.type.name for spec in specs})

    def _routines(self) -> Iterator[Option]:
        for unit in self.source.units:
            if unit.kind == "SUBROUTINE":
                yield Option(unit.name, "name", "subroutine")

    def _operands_used(self) -> dict[str, None]:
        """The words that stand for operands in the text, each once."""
        return dict.fromkeys(word for unit in self.source.units for statement in unit.statements for word in statement.operands)

    def _pointers(self, letters: set[str]) -> Iterator[Option]:
        """The pointers with these letters that the text has already."""
        for word in self._operands_used():
            operand = _parsed(self.model.syntax.parse, word.upper())
            if isinstance(operand, Pointer) and operand.letter in letters and word != self.word:
                yield Option(str(operand), "name", "used in this program")

    def _devices(self, areas: Iterable[str], takes: Callable[[Device | Bits], bool], types: set[str] | None = None) -> Iterator[Option]:
        """Variables, the devices that the text speaks of already, and each area's next free device, as far as they are taken."""
        parse = self.model.syntax.parse
        used: dict[str, set[int]] = {}
        for variable in self.source.globals:
            device = _parsed(parse, variable.what.upper())
            if isinstance(device, Device) and takes(device):
                yield Option(variable.name, "name", f"{device} {variable.comment}".strip())
        for variable in self.unit.variables if self.unit else ():
            if types is None or variable.what in types:
                yield Option(f"#{variable.name}", "name", f"{variable.role.lower()} {variable.what} {variable.comment}".strip())
        names = {variable.what.upper(): variable.name for variable in self.source.globals}
        for word in self._operands_used():
            operand = _parsed(parse, word.upper())
            if isinstance(operand, Device):
                used.setdefault(operand.area, set()).add(operand.number)
            if isinstance(operand, Device | Bits) and word != self.word and takes(operand):
                yield Option(str(operand), "device", names.get(str(operand), "used in this program"))
        for area in areas:
            room = self.model.areas.get(area)
            numbers = (n for n in range(room.end(0)) if n not in used.get(area, ()) and takes(Device(area, n))) if room else ()
            for first in islice(numbers, 1):
                yield Option(f"{area}{number_text(area, first)}", "device", f"the first one unused, of {room.span}")

    def signature(self) -> dict | None:
        """The instruction of the line with its operands, and which of them is being typed; None where there is none."""
        forms = self._forms()
        if not forms or self.commented:
            return None
        row, name = forms[0], self.words[0].upper()
        uses = [
            " or ".join(dict.fromkeys(self._use(form, place) for form in forms if place < len(form.operands) and self._areas(form, place)))
            for place in range(len(row.operands))
        ]
        return {
            "mnemonic": name,
            "title": told(self.model, row, row.title),
            "section": section_of(self.model, name, row),
            "at": len(self.known),
            "operands": [[spec.name, use] for spec, use in zip(row.operands, uses, strict=True)],
        }

    def _use(self, row: Definition, place: int) -> str:
        """What an operand is: its type, whether it is written, its numbers, and where it may lie."""
        spec = row.operands[place]
        letter = self.model.syntax.pointers.get(spec.kind, "")
        limits = self.model.operand_ranges.get(spec.kind, spec.range)
        numbers = f", {letter}{limits[0]} to {letter}{limits[1]}" if limits else ""
        words = {"const": "pointer" if letter else "constant", "routine": "subroutine", "text": "text"}
        places = " ".join(words.get(area, area) for area in self._areas(row, place))
        return f"{spec.type.name}{', written' if spec.written else ''}{numbers}: {places}"


def _parsed(parse, word: str):
    try:
        return parse(word)
    except ValueError:
        return None


def _open_comment(before: str) -> bool:
    """Whether the end of a text lies in a block comment."""
    code = re.sub(r"/\*.*?\*/|\(\*.*?\*\)|//[^\n]*", "", before, flags=re.DOTALL)
    return "/*" in code or "(*" in code
