"""Single edits of a program's text: what a slip of the hand makes of one line, and what one line would have to be to mend another.

The same edits make the faulty programs that measure an exercise's rules and look for the network of a student's fault.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..assembler.reader import Source, Statement, read
from ..instructions import TABLE

CONTACTS = {"LD": "LDI", "LDI": "LD", "AND": "ANI", "ANI": "AND", "OR": "ORI", "ORI": "OR", "EU": "ED", "ED": "EU"}
JOINED = {"AND": "OR", "OR": "AND", "ANI": "ORI", "ORI": "ANI", "ANB": "ORB", "ORB": "ANB"}
COILS = {"OUT": ("SET",), "SET": ("OUT", "RST"), "RST": ("SET",)}
TIMERS = {"TON": ("TOF", "TONR"), "TOF": ("TON",), "TONR": ("TON",)}
STEPS = {"INC": ("DEC",), "DEC": ("INC",), "ADD": ("SUB",), "SUB": ("ADD",)}
COMPARISONS = {"=": ("<>", ">="), "<>": ("=",), ">": (">=", "<="), ">=": (">", "<"), "<": ("<=", ">="), "<=": ("<", ">")}
SMALL = 20  # numbers above it are changed by a tenth: one unit of 100 ms in five minutes is what every statement leaves open
_COMPARISON = re.compile(r"(LD|AND|OR)([DR]?)(=|<>|>=|<=|>|<)")
_NUMBER = re.compile(r"-?\d+")
_DEVICE = re.compile(r"([A-Z]+)(\d+)")


@dataclass(frozen=True)
class Edit:
    """One line of a program changed: `line` from 1, `old` and `new` code (new is empty for a line left out), and the whole text."""

    line: int
    old: str
    new: str
    text: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.old} -> {self.new or 'nothing'}"


def edits(text: str) -> Iterator[Edit]:
    """Every single slip of the hand in a program."""
    source = read(text)
    named = _neighbours(source)
    for statement in _statements(source):
        old = " ".join((statement.mnemonic, *statement.operands))
        for new in dict.fromkeys(_changes(statement, named)):
            if new != old:
                yield Edit(statement.line, old, new, _with_line(text, statement.line, new))


def additions(text: str, contacts: Sequence[str], coils: Sequence[str], words: Sequence[str] = ()) -> Iterator[Edit]:
    """What may have been forgotten: edges, contacts and coils of these bits and comparisons of these words behind a line, or another number
    of the program in a number's place.

    `new` has the line and, below it, what is added.
    """
    source = read(text)
    numbers = list(dict.fromkeys(one for statement in _statements(source) for one in statement.operands if _NUMBER.fullmatch(one)))
    for statement in _statements(source):
        old = " ".join((statement.mnemonic, *statement.operands))
        for new in _additions(statement, contacts, coils, words, numbers):
            yield Edit(statement.line, old, new, _with_line(text, statement.line, new))


def _statements(source: Source) -> Iterator[Statement]:
    for unit in source.units:
        yield from unit.statements


def _with_line(text: str, number: int, code: str) -> str:
    """The text with the code of one line exchanged; its comment goes, so that nothing tells."""
    lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    lines[number - 1] = code
    return "\n".join(lines)


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
    if _NUMBER.fullmatch(operand):
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


def _additions(
    statement: Statement, contacts: Sequence[str], coils: Sequence[str], words: Sequence[str], numbers: Sequence[str]
) -> Iterator[str]:
    """What one statement may become when something behind it was forgotten, or a number was taken from elsewhere."""
    word, operands = statement.mnemonic.upper(), list(statement.operands)
    row = TABLE.get(word)
    own = " ".join((statement.mnemonic, *operands))
    if row is not None and row.form == "contact":
        yield from (f"{own}\n{edge}" for edge in ("EU", "ED"))
        yield from (f"{own}\n{joint} {bit}" for bit in contacts for joint in ("AND", "ANI", "OR", "ORI"))
        compared = dict.fromkeys(("0", *numbers))
        yield from (f"{own}\nAND{sign} {word} {number}" for word in words for number in compared for sign in (">", "<", "="))
    elif word in ("OUT", "SET", "RST"):
        yield from (f"{own}\n{coil} {bit}" for bit in coils for coil in ("RST", "OUT", "SET"))
    for place, operand in enumerate(operands):
        if _NUMBER.fullmatch(operand):
            yield from (" ".join((word, *operands[:place], other, *operands[place + 1 :])) for other in numbers if other != operand)
