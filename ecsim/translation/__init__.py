"""From one family to the other: a program of EC10 or EC20 as one of H1U or H2U and back, with a report of what differs.

`translate` gives the text and the differences, and refuses with all reasons what would not do the same. Whatever it gives
has been compiled for the model that it is for.
"""

from dataclasses import dataclass
from pathlib import Path

from ..assembler import Program, assemble
from ..assembler.printer import print_globals, print_instructions
from ..devices import Device
from ..errors import EcsimError, Problem, ProgramError
from ..models import Model, get_model
from ..project import Project
from ..system import SystemBlock
from .places import Places
from .text import Line, Refusal, Text
from .to_ec import ToEC
from .to_fx import ToFX

_WAYS = {("EC", "FX"): ToFX, ("FX", "EC"): ToEC}


@dataclass(frozen=True, slots=True)
class Difference:
    """Something that the translated program does not do quite as the original: the first line it is about, 0 for all of them, and what."""

    line: int
    what: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.what}" if self.line else self.what


@dataclass(frozen=True, slots=True)
class Translation:
    """A program in the other family's words."""

    model: str
    text: str
    differences: tuple[Difference, ...]

    def report(self) -> str:
        """The differences, a line each."""
        return "\n".join(map(str, self.differences)) or "no differences"

    def __str__(self) -> str:
        return self.text


def translate(program: str | Path | Project | Program, to: str | Model = "H2U", model: str | Model | None = None) -> Translation:
    """The program for the model `to`. `model` is the one that it is written for: EC20 unless the file's name or the project says otherwise.

    Raises ProgramError with everything that cannot be kept (or does not compile), EcsimError for two models of one family.
    """
    target = get_model(to)
    if not isinstance(program, Program):
        program = Project.of(program).compile(model)
    way = _WAYS.get((program.model.family, target.family))
    if way is None:
        raise EcsimError(
            f"a program of {program.model.name} is no translation away from {target.name}: both belong to the family {target.family}"
        )
    text = Text(program)
    places = Places(program, target, text)
    work = way(program, target, places, text)
    units = work.units()
    if text.problems:
        raise ProgramError(text.problems)
    _compare_retention(program.model, target, places, text)
    written = _written(program, places, units)
    try:
        assemble(written, target)
    except ProgramError as error:
        raise ProgramError([_blamed(problem, written, units) for problem in error.problems]) from None
    notes = sorted(text.notes.items(), key=lambda note: note[1])
    return Translation(target.name, written, tuple(Difference(line, what) for what, line in notes))


def _compare_retention(source: Model, target: Model, places: Places, text: Text) -> None:
    """Note the devices that keep their values without power for one of the models alone, as long as no system block says otherwise."""
    here, there = (SystemBlock().retention(model) for model in (source, target))
    kept: dict[bool, list[tuple[int, Device]]] = {True: [], False: []}
    for (area, number), place in places.moved.items():
        keeps = place.number in there.get(place.area, ())
        if keeps != (number in here.get(area, ())) and places.used[area, number]:
            kept[keeps].append((places.used[area, number], Device(area, number)))
    for keeps, devices in kept.items():
        if devices:
            names = ", ".join(str(device) for _, device in sorted(devices, key=lambda each: (each[1].area, each[1].number)))
            what = "kept" if keeps else "not kept"
            text.note(min(line for line, _ in devices), f"{what} there without power, unless told otherwise: {names}")


def _written(program: Program, places: Places, units: list[tuple[str, list[Line], str]]) -> str:
    """The text: names, then each unit with its head and its end."""
    variables = [places.variable(variable) for variable in program.variables.values()]
    parts = [print_globals(variables)] if variables else []
    for head, lines, end in units:
        titles = {index: line.title for index, line in enumerate(lines) if line.title}
        breaks = [index for index, line in enumerate(lines) if line.mnemonic == "STL"]
        body = print_instructions(lines, titles, breaks)
        parts.append("".join(f"{part}\n" if part and not part.endswith("\n") else part for part in (head, body, end)))
    return "\n".join(parts)


def _blamed(problem: Problem, written: str, units: list[tuple[str, list[Line], str]]) -> Problem:
    """What the other family's compiler says of a line, said of the line it comes from."""
    lines = written.split("\n")
    code = " ".join(lines[problem.line - 1].partition("//")[0].split()) if 0 < problem.line <= len(lines) else ""
    source = next((line.line for _, part, _ in units for line in part if " ".join((line.mnemonic, *line.written)) == code), 0)
    return Problem(source, 0, f"cannot become {code!r}: {problem.message}", problem.hint, problem.section)


__all__ = ["Difference", "Refusal", "Translation", "translate"]
