"""What would mend a program: edits of one place beyond the slips of `edits.py`, made of the bits, words and numbers that it could need."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

from ..assembler.reader import Statement, read
from ..instructions import TABLE
from .edits import COILS, CONTACTS, NUMBER, Edit, statements

REACHED = {"DRVI": "DRVA", "DRVA": "DRVI", "DDRVI": "DDRVA", "DDRVA": "DDRVI"}  # by so much, and to there


@dataclass(frozen=True)
class Parts:
    """What a repair may be made of, as a program writes it, the likeliest first."""

    contacts: Sequence[str] = ()
    clocks: Sequence[str] = ()
    latches: Sequence[str] = ()  # bits that a program can write, without its steps
    steps: Sequence[str] = ()
    words: Sequence[str] = ()
    numbers: Sequence[str] = ()

    @property
    def coils(self) -> Sequence[str]:
        """All bits that a program can write."""
        return (*self.steps, *self.latches)


def exchanges(text: str, parts: Parts) -> Iterator[Edit]:
    """What may have been taken from elsewhere: another bit in a contact's or coil's place, straight or turned round, another word or number."""
    return _changed(text, lambda statement: _exchanges(statement, parts))


def additions(text: str, parts: Parts) -> Iterator[Edit]:
    """What may have been forgotten behind a line: an edge, a contact, a comparison, a coil. `new` has the line and, below it, what is added."""
    return _changed(text, lambda statement: _additions(statement, parts))


def everywhere(text: str, parts: Parts) -> Iterator[Edit]:
    """The same slip in each place where it could have been made: all contacts of a bit turned round, an operand exchanged in all comparisons,
    coils that stand below each other written otherwise.

    Each edit comes once for every line that it changes; `old` and `new` are of this line.
    """
    listed = list(statements(read(text)))
    for word, run in groupby(listed, lambda statement: statement.mnemonic.upper()):
        coils = list(run)
        for other in COILS.get(word, ()) if len(coils) > 1 else ():
            yield from _all_changed(text, coils, [" ".join((other, *one.operands)) for one in coils])
    lines: dict[tuple[str, str], list[Statement]] = {}
    for statement in listed:
        word = statement.mnemonic.upper()
        if word in CONTACTS and statement.operands:
            lines.setdefault(("", statement.operands[0]), []).append(statement)
        elif _is_contact(statement) and len(statement.operands) == 2:
            for operand in statement.operands:
                lines.setdefault((operand, operand), []).append(statement)
    for (compared, operand), places in lines.items():
        if len(places) > 1:
            for other in (*parts.words, *parts.numbers) if compared else ("",):
                news = [_with_operand(one, operand, other) if compared else _turned(one) for one in places]
                yield from _all_changed(text, places, news)


def omissions(text: str, lines: Iterable[int], parts: Parts) -> Iterator[Edit]:
    """A network that may be missing behind one of these lines: while a contact is ON, or OFF, a latch is set or cleared or a step begun."""
    written = text.removeprefix("\ufeff").splitlines()
    conditions = ["LD SM0", *(f"{word} {bit}" for bit in parts.contacts for word in ("LD", "LDI"))]
    coils = [*(f"OUT {step}" for step in parts.steps), *(f"{word} {bit}" for bit in parts.latches for word in ("RST", "SET"))]
    for line in lines:
        for coil in coils:
            for condition in conditions:
                new = f"{written[line - 1]}\n{condition}\n{coil}"
                yield Edit(line, written[line - 1], new, text)


def branches(text: str, parts: Parts) -> Iterator[Edit]:
    """A step that was always left one way where a contact decides: the way there is while it is ON, or OFF, and another one else."""
    for condition, coil in pairwise(list(statements(read(text)))):
        if condition.mnemonic.upper() in ("LD", "LDI") and coil.mnemonic.upper() in COILS and set(coil.operands) <= set(parts.steps):
            for bit in parts.contacts:
                for word, other in (("LD", "LDI"), ("LDI", "LD")):
                    for step in parts.steps:
                        new = f"{_code(coil)}\n{other} {bit}\nOUT {step}"
                        yield Edit(coil.line, _code(coil), new, text, ((condition.line, f"{word} {bit}"), (coil.line, new)))


def orders(text: str, groups: Iterable[Sequence[tuple[int, int]]]) -> Iterator[Edit]:
    """The same networks in another order: each, given by its first and last line, in each other place of its group."""
    written = text.removeprefix("\ufeff").splitlines()
    for group in groups:
        for place, (first, last) in enumerate(group):
            own = "\n".join(written[first - 1 : last])
            emptied = [(line, "") for line in range(first, last + 1)]
            for other, (above, below) in enumerate(group):
                if other not in (place, place - 1):
                    at, there = (above, f"{own}\n{written[above - 1]}") if other < place else (below, f"{written[below - 1]}\n{own}")
                    yield Edit(first, own, "", text, (*emptied, (at, there)))


def _all_changed(text: str, places: Sequence[Statement], news: Sequence[str]) -> Iterator[Edit]:
    changes = tuple((one.line, new) for one, new in zip(places, news, strict=True))
    yield from (Edit(one.line, _code(one), new, text, changes) for one, new in zip(places, news, strict=True))


def _changed(text: str, changes: Callable[[Statement], Iterable[str]]) -> Iterator[Edit]:
    for statement in statements(read(text)):
        old = _code(statement)
        for new in dict.fromkeys(changes(statement)):
            if new != old:
                yield Edit(statement.line, old, new, text)


def _code(statement: Statement) -> str:
    return " ".join((statement.mnemonic, *statement.operands))


def _turned(statement: Statement) -> str:
    return " ".join((CONTACTS[statement.mnemonic.upper()], *statement.operands))


def _with_operand(statement: Statement, operand: str, other: str) -> str:
    return " ".join((statement.mnemonic, *(other if one == operand else one for one in statement.operands)))


def _is_contact(statement: Statement) -> bool:
    row = TABLE.get(statement.mnemonic.upper())
    return row is not None and row.form == "contact"


def _is_output(statement: Statement) -> bool:
    word = statement.mnemonic.upper()
    return word in COILS or (word in TABLE and TABLE[word].form in ("value", "always", "command"))


def _exchanges(statement: Statement, parts: Parts) -> Iterator[str]:
    """What one statement may become when something in it was taken from elsewhere."""
    word, operands = statement.mnemonic.upper(), list(statement.operands)
    if word in REACHED:
        yield " ".join((REACHED[word], *operands))
    if len(operands) == 1 and word in CONTACTS:
        yield from (f"{same} {bit}" for bit in parts.contacts for same in (word, CONTACTS[word]))
    elif word in COILS:
        yield from (f"{word} {bit}" for bit in parts.coils)
    elif len(operands) > 1:
        for place, operand in enumerate(operands):
            others = (*parts.numbers, *parts.words) if NUMBER.fullmatch(operand) else parts.words if operand in parts.words else ()
            yield from (" ".join((word, *operands[:place], other, *operands[place + 1 :])) for other in others)


def _additions(statement: Statement, parts: Parts) -> Iterator[str]:
    """What one statement may become when something behind it was forgotten."""
    own = _code(statement)
    if _is_contact(statement):
        yield from (f"{own}\n{edge}" for edge in ("EU", "ED"))
        yield from (f"{own}\nAND {clock}" for clock in parts.clocks)
        yield from (f"{own}\nAND{sign} {word} 0" for word in parts.words for sign in (">", "<", "="))
        yield from (f"{own}\n{joint} {bit}" for bit in parts.contacts for joint in ("AND", "ANI", "OR", "ORI"))
        yield from (f"{own}\nAND{sign} {word} {number}" for word in parts.words for number in parts.numbers for sign in (">", "<", "="))
    elif _is_output(statement):
        if set(statement.operands) <= set(parts.steps):
            yield from (f"{own}\nSET {step}" for step in parts.steps)
        yield from (f"{own}\n{coil} {bit}" for bit in parts.latches for coil in ("RST", "OUT", "SET"))
        yield from ("\n".join((own, *(f"RST {bit}" for bit in bits))) for bits in (parts.steps, parts.latches) if bits)
