"""Programs of H1U and H2U as other tools write them: the CSV of Mitsubishi's programming software, and plain lists of instructions.

The CSV is UTF-16 with its byte order mark, with tabs, all columns in quotes: a line with the program's name, one with the type of PLC,
the heads of the columns, then a row an instruction; further operands have rows of their own, with neither step nor instruction.
A plain list has an instruction a line, with or without its step number before it, as programming consoles print it.
"""

import csv
import io
import re

from .assembler import Program, assemble
from .assembler.printer import print_instructions
from .assembler.reader import Statement
from .errors import EcsimError

COLUMNS = ("Step No.", "Line Statement", "Instruction", "I/O (Device)", "Blank", "P/I Statement", "Note")
LIMIT = 4_000_000  # octets
_STEP = re.compile(r"\d+$")


def read_list(content: bytes | str, model: str = "H2U") -> str:
    """The text of a CSV or of a plain list, in ecsim's form; raises ProgramError for a program that `model` does not take, EcsimError for no text."""
    text = _decoded(content) if isinstance(content, bytes) else content
    rows = _rows(text) if "\t" in text else _plain(text)
    statements = [Statement(name, tuple(map(_device, operands)), line, note, title) for line, name, operands, note, title in rows]
    if not statements:
        raise EcsimError("there is no instruction in it; a list has one a line, a CSV the columns " + ", ".join(COLUMNS))
    printable = [_Printable(each) for each in statements]
    titles = {index: each.title for index, each in enumerate(statements) if each.title}
    written = print_instructions(printable, titles, [index for index, each in enumerate(statements) if each.mnemonic == "STL"])
    assemble(written, model)
    return written


class _Printable:
    def __init__(self, statement: Statement):
        pointer = re.fullmatch(r"([PI])\d+", statement.mnemonic)
        self.mnemonic = pointer[1] if pointer and not statement.operands else statement.mnemonic
        self.spelled = ""
        self.written = (statement.mnemonic,) if pointer and not statement.operands else statement.operands
        self.comment = statement.comment


def write_csv(program: Program, name: str = "MAIN") -> bytes:
    """A program of H1U or H2U as CSV; raises EcsimError for one of another family."""
    _need_fx(program)
    out = io.StringIO()
    writer = csv.writer(out, delimiter="\t", quoting=csv.QUOTE_ALL, lineterminator="\r\n")
    writer.writerow([name])
    writer.writerow(["PC Type:", program.model.name])
    writer.writerow(COLUMNS)
    for unit in program.units:
        for index, instruction in enumerate(unit.instructions):
            words = str(instruction).split()
            title = unit.titles.get(index, "").replace("\n", " ")
            operands = [_plain_device(word, program) for word in words[1:]]
            writer.writerow([instruction.step, title, words[0], operands[0] if operands else "", "", "", instruction.comment])
            for operand in operands[1:]:
                writer.writerow(["", "", "", operand, "", "", ""])
    return b"\xff\xfe" + out.getvalue().encode("utf-16-le")


def write_list(program: Program) -> str:
    """A program of H1U or H2U as a plain list with step numbers; names are written as their devices."""
    _need_fx(program)
    lines = []
    for instruction in program.instructions:
        words = str(instruction).split()
        lines.append(" ".join([f"{instruction.step:>5}", f"{words[0]:<5}", *(_plain_device(word, program) for word in words[1:])]).rstrip())
    return "\n".join(lines) + "\n"


def _need_fx(program: Program) -> None:
    if program.model.family != "FX":
        raise EcsimError(f"this is a program for {program.model.name}; translate it for H2U first")


def _plain_device(word: str, program: Program) -> str:
    variable = program.variables.get(word)
    return str(variable.device) if variable else word


# -- reading -----------------------------------------------------------------------------------------------------------------


def _decoded(content: bytes) -> str:
    if len(content) > LIMIT:
        raise EcsimError(f"{len(content)} octets are too many for a program; at most {LIMIT}")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        coding = "utf-16"
    else:
        coding = "utf-16-le" if content[1:2] == b"\0" else "utf-8-sig"
    try:
        return content.decode(coding)
    except UnicodeDecodeError as error:
        raise EcsimError(f"it is no text (octet {error.start}); save it as UTF-16 or UTF-8") from None


def _rows(text: str):
    """(line, instruction, operands, note, title) of each instruction of a CSV."""
    found: list[list] = []
    place: dict[str, int] | None = None
    for line, row in enumerate(csv.reader(io.StringIO(text, newline=""), delimiter="\t"), 1):
        heads = [_head(cell) for cell in row]
        if place is None:
            if "instruction" in heads:
                place = {head: heads.index(head) for head in ("statement", "instruction", "device", "note") if head in heads}
            continue
        cells = {head: row[column].strip() if column < len(row) else "" for head, column in place.items()}
        name, operand = cells["instruction"].upper(), cells.get("device", "").upper()
        if not name and not operand:
            if cells.get("statement"):
                found.append([line, "", [], "", cells["statement"]])
        elif name:
            title = cells.get("statement", "")
            if found and not found[-1][1]:
                title = "\n".join(filter(None, (found.pop()[4], title)))
            found.append([line, name, [operand] if operand else [], cells.get("note", ""), title])
        elif not found:
            raise EcsimError(f"line {line}: the operand {operand} belongs to no instruction")
        else:
            found[-1][2].append(operand)
    if place is None:
        raise EcsimError("it has no column Instruction; the heads are " + ", ".join(COLUMNS))
    return [row for row in found if row[1]]


def _head(cell: str) -> str:
    """The meaning of a column's head, which versions of the software spell differently."""
    word = re.sub(r"[^a-z/]", "", cell.lower())
    return {
        "linestatement": "statement", "instruction": "instruction", "i/odevice": "device", "iodevice": "device", "device": "device", "note": "note",
    }.get(word, "")  # fmt: skip


def _plain(text: str):
    """(line, instruction, operands, note, title) of each line of a plain list."""
    for line, words in enumerate(text.splitlines(), 1):
        code, _, note = words.partition(";") if ";" in words else words.partition("//")
        parts = code.replace(",", " ").upper().split()
        if parts and _STEP.match(parts[0]):
            parts = parts[1:]
        if parts:
            yield line, parts[0], parts[1:], note.strip(), ""


def _device(word: str) -> str:
    """A device without the zeros before its number: X000 is X0, K4M0100 is K4M100."""
    if word[:1] in "KH" and not re.match(r"K\d[A-Z]", word):
        return word
    return re.sub(r"(?<=[A-Z])0+(?=[0-9])", "", word) if re.match(r"(K\d)?[A-Z]+\d", word) else word


__all__ = ["COLUMNS", "read_list", "write_csv", "write_list"]
