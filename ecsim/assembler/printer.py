"""A program as text again: what `print_program` writes, `assemble` reads as the same program."""

from collections.abc import Iterable, Sequence
from typing import Protocol

from .program import Program, Unit, Variable, is_label, wording

# The columns of operands and comments; longer words push what follows to the right.
OPERANDS, COMMENT = 6, 24


class Printable(Protocol):
    """What a line of the instruction list is made from; an Instruction has all of it."""

    mnemonic: str
    spelled: str
    written: tuple[str, ...]
    comment: str


def print_program(program: Program) -> str:
    """The text of a whole program; a main program alone, without variables, needs no headers."""
    if program.model.syntax.pointers:
        tables = [print_globals(program.variables.values())] if program.variables else []
        return "\n".join([*tables, *(print_unit_body(unit) for unit in program.units)])
    bare = len(program.units) == 1 and not program.variables and not program.main.variables and program.main.name == "MAIN"
    if bare:
        return print_unit_body(program.main)
    parts = [print_globals(program.variables.values())] if program.variables else []
    parts += [print_unit(unit) for unit in program.units]
    return "\n".join(parts)


CLOSED = "CLOSED"  # begins each line that stands for the text of a unit that a password closes; it does not compile


def print_unit(unit: Unit, sealed: str = "") -> str:
    """One unit between its header and its end; `sealed` stands for its instructions where it is closed."""
    word = "PROGRAM" if unit.kind == "MAIN" else unit.kind
    head = f"{word} {unit.name}" + (f" EVENT {unit.event}" if unit.event is not None else "")
    rows = [(f"VAR_{v.role} {v.name} : {v.type.name}", v.comment) for v in unit.variables.values()]
    return "\n".join([head, *_with_comments(rows), (sealed or print_unit_body(unit)) + f"END_{word}\n"])


def print_unit_body(unit: Unit) -> str:
    """The instructions of a unit, a blank line before each titled network and each step."""
    breaks = {network.start for network in unit.networks if unit.instructions[network.start].mnemonic == "STL"}
    return print_instructions(unit.instructions, unit.titles, breaks)


def print_instructions(instructions: Sequence[Printable], titles: dict[int, str] | None = None, breaks: Iterable[int] = ()) -> str:
    """Instructions a line each; `titles` stand as comment lines before theirs, `breaks` are the indices that get a blank line before."""
    titles, breaks = titles or {}, set(breaks)
    rows: list[tuple[str, str]] = []
    for index, instruction in enumerate(instructions):
        title = titles.get(index, "")
        if rows and (title or index in breaks):
            rows.append(("", ""))
        rows += [(f"// {line}".rstrip(), "") for line in title.split("\n")] if title else []
        name = instruction.spelled or instruction.mnemonic
        operands = "" if is_label(name, instruction.written) else " ".join(instruction.written)
        rows.append((f"{name:<{OPERANDS - 1}} {operands}" if operands else wording(name, instruction.written), instruction.comment))
    lines = _with_comments(rows)
    return "\n".join(lines) + "\n" if lines else ""


def print_globals(variables: Iterable[Variable]) -> str:
    """The table of global variables."""
    variables = list(variables)
    width = max(len(v.name) for v in variables)
    rows = [(f"  {v.name:<{width}} AT {v.device}", v.comment) for v in variables]
    return "\n".join(["VAR_GLOBAL", *_with_comments(rows), "END_VAR\n"])


def _with_comments(rows: list[tuple[str, str]]) -> list[str]:
    """Lines with their comments under one another."""
    column = max([COMMENT, *(len(text) + 2 for text, comment in rows if comment and len(text) < 40)])
    return [f"{text:<{column}}// {comment}" if comment else text for text, comment in rows]
