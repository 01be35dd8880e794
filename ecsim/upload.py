"""A program as it leaves the machine (2.4.1): with its names and comments while they are known, closed units (2.1.11) sealed.

A sealed unit has the word CLOSED and a line of its text, encoded, on each line; CLOSED BY has its password. What tells its name stays
readable: its header, or its label. So a project can be carried to another machine by those who cannot read it. It keeps honest people
honest: the encoding is base64.
"""

import base64
import re
from collections.abc import Mapping
from dataclasses import replace

from .assembler import Instruction, Program, Unit
from .assembler.printer import CLOSED, print_globals, print_unit, print_unit_body
from .assembler.reader import pointer_name

_HEAD = re.compile(r"\s*(?:(?:PROGRAM|SUBROUTINE|INTERRUPT)\s+(\w+)|([PI]\d+)\s*(?:$|//|;))", re.IGNORECASE)
_SEALED = re.compile(rf"\s*{CLOSED}( BY)?(?: (\S+))?\s*")


def uploaded(program: Program, files: Mapping[str, str], informed: bool = True) -> dict[str, str]:
    """The files of a program as they are uploaded; without names of variables and comments where these are lost (error 45)."""
    if informed and not any(unit.closed for unit in program.units):
        return {name or "main.il": text for name, text in files.items()}
    names = {} if informed else {name.casefold(): str(variable.device) for name, variable in program.variables.items()}
    tables = [print_globals(program.variables.values())] if program.variables and informed else []
    units = [unit if informed else _bare(unit, names) for unit in program.units]
    printed = _part if program.model.syntax.pointers else _unit
    return {"main.il": "\n".join([*tables, *map(printed, units)])}


def _unit(unit: Unit) -> str:
    return print_unit(unit, _sealed(unit, print_unit_body(unit)) if unit.closed else "")


def _part(unit: Unit) -> str:
    """A unit of a family whose units begin with a label."""
    text = print_unit_body(unit)
    if not unit.closed:
        return text
    if unit.kind == "MAIN":
        return _sealed(unit, text)
    title, label, behind = re.split(r"^([PI]\d.*\n)", text, maxsplit=1, flags=re.MULTILINE)
    return _codes(title) + label + _sealed(unit, behind)


def _bare(unit: Unit, names: dict[str, str]) -> Unit:
    """A unit without comments, with devices where names of variables stood."""

    def plain(instruction: Instruction) -> Instruction:
        return replace(instruction, written=tuple(names.get(word.casefold(), word) for word in instruction.written), comment="")

    local = {name: replace(variable, comment="") for name, variable in unit.variables.items()}
    return replace(unit, variables=local, instructions=list(map(plain, unit.instructions)), titles={})


def _sealed(unit: Unit, text: str) -> str:
    """What stands for the text of a unit, for machines alone to read."""
    return f"{CLOSED} BY {_encoded(unit.password)}\n{_codes(text)}"


def _codes(text: str) -> str:
    return "".join(f"{CLOSED} {_encoded(line)}".rstrip() + "\n" for line in text.splitlines())


def unsealed(files: Mapping[str, str]) -> tuple[dict[str, str], dict[str, str]]:
    """The files with the text of sealed units, line for line, and the passwords of these units. What is spoilt stays as it stands."""
    passwords: dict[str, str] = {}
    return {name: "\n".join(_unsealed(text, passwords)) if CLOSED in text else text for name, text in files.items()}, passwords


def _unsealed(text: str, passwords: dict[str, str]) -> list[str]:
    unit, lines = "MAIN", text.split("\n")
    for place, line in enumerate(lines):
        if (head := _HEAD.match(line)) is not None:
            unit = head[1] or pointer_name(head[2])
        elif (sealed := _SEALED.fullmatch(line)) is not None and (content := _decoded(sealed[2] or "")) is not None:
            if sealed[1]:
                passwords[unit] = content
            lines[place] = "" if sealed[1] else content
    return lines


def _encoded(text: str) -> str:
    return base64.b64encode(text.encode()).decode()


def _decoded(word: str) -> str | None:
    try:
        return base64.b64decode(word, validate=True).decode()
    except ValueError:
        return None
