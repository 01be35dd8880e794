"""Single edits of a program's text: what a slip of the hand makes of one line.

The same edits make the faulty programs that measure an exercise's rules and look for the network of a student's fault; `repairs.py` has
what is tried besides for the latter.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ..assembler.reader import Source, Statement, read

CONTACTS = {"LD": "LDI", "LDI": "LD", "AND": "ANI", "ANI": "AND", "OR": "ORI", "ORI": "OR", "EU": "ED", "ED": "EU"}
JOINED = {"AND": "OR", "OR": "AND", "ANI": "ORI", "ORI": "ANI", "ANB": "ORB", "ORB": "ANB"}
COILS = {"OUT": ("SET",), "SET": ("OUT", "RST"), "RST": ("SET",)}
TIMERS = {"TON": ("TOF", "TONR"), "TOF": ("TON",), "TONR": ("TON",)}
STEPS = {"INC": ("DEC",), "DEC": ("INC",), "ADD": ("SUB",), "SUB": ("ADD",)}
COMPARISONS = {"=": ("<>", ">="), "<>": ("=",), ">": (">=", "<="), ">=": (">", "<"), "<": ("<=", ">="), "<=": ("<", ">")}
SMALL = 20  # numbers above it are changed by a tenth: one unit of 100 ms in five minutes is what every statement leaves open
_COMPARISON = re.compile(r"(LD|AND|OR)([DR]?)(=|<>|>=|<=|>|<)")
NUMBER = re.compile(r"-?\d+")
_DEVICE = re.compile(r"([A-Z]+)(\d+)")


@dataclass(frozen=True)
class Edit:
    """One place of a program changed: `line` from 1, `old` and `new` code of it (new is empty for what is left out).

    `changes` are all lines with other code, where they are more than this one.
    """

    line: int
    old: str
    new: str
    program: str
    changes: tuple[tuple[int, str], ...] = ()

    @property
    def text(self) -> str:
        """The whole program as it becomes; the comments of changed lines go, so that nothing tells."""
        lines = self.program.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
        for line, code in self.changes or ((self.line, self.new),):
            lines[line - 1] = code
        return "\n".join(lines)

    def __str__(self) -> str:
        return f"line {self.line}: {self.old} -> {self.new or 'nothing'}"


def edits(text: str) -> Iterator[Edit]:
    """Every single slip of the hand in a program."""
    source = read(text)
    named = _neighbours(source)
    for statement in statements(source):
        old = " ".join((statement.mnemonic, *statement.operands))
        for new in dict.fromkeys(_changes(statement, named)):
            if new != old:
                yield Edit(statement.line, old, new, text)


def statements(source: Source) -> Iterator[Statement]:
    """Every instruction as written."""
    for unit in source.units:
        yield from unit.statements


def _changes(statement: Statement, named: dict[str, list[str]]) -> Iterator[str]:
    """What one statement may become."""
    word, operands = statement.mnemonic.upper(), list(statement.operands)
    for table in (CONTACTS, JOINED):
        if word in table:
            yield " ".join((table[word], *operands))
    for table in (COILS, TIMERS, STEPS):
        for other in table.get(word, ()):
            yield " ".join((other, *operands))
    compared = _COMPARISON.fullmatch(word)
    if compared:
        for other in COMPARISONS[compared[3]]:
            yield " ".join((f"{compared[1]}{compared[2]}{other}", *operands))
    yield ""
    for place, operand in enumerate(operands):
        for other in _other(operand, named):
            yield " ".join((word, *operands[:place], other, *operands[place + 1 :]))


def _other(operand: str, named: dict[str, list[str]]) -> list[str]:
    """What may stand in an operand's place: a number that is a little or much off, or a device of the same kind."""
    if NUMBER.fullmatch(operand):
        number = int(operand)
        little = 1 if abs(number) <= SMALL else round(0.1 * abs(number))
        changed = dict.fromkeys((number + little, number - little, number * 10, number // 10, number // 2))
        return [str(other) for other in changed if other != number]
    return named.get(operand.casefold(), [])


def _neighbours(source: Source) -> dict[str, list[str]]:
    """Each device or name of the program -> those of the same area that stand beside it in the order of their numbers."""
    names = {raw.what.upper(): raw.name for raw in source.globals}
    written: dict[tuple[str, int], str] = {}
    for raw in source.globals:
        found = _DEVICE.fullmatch(raw.what.upper())
        if found:
            written[found[1], int(found[2])] = raw.name
    for unit in source.units:
        for statement in unit.statements:
            for operand in statement.operands:
                found = _DEVICE.fullmatch(operand.upper())
                if found and found[1] in ("X", "Y", "M", "S", "T", "C", "D"):
                    written.setdefault((found[1], int(found[2])), names.get(operand.upper(), operand))
    near: dict[str, list[str]] = {}
    ordered = sorted(written)
    for place, (area, number) in enumerate(ordered):
        beside = [ordered[other] for other in (place - 1, place + 1) if 0 <= other < len(ordered) and ordered[other][0] == area]
        words = [written[one] for one in beside]
        for known in {written[area, number].casefold(), f"{area}{number}".casefold()}:
            near[known] = words
    return near
