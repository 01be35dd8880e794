"""Text to statements: headers, variables, comments; one instruction a line (DESIGN: instruction list is the canonical form)."""

import re
from bisect import bisect_right
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ..devices import Syntax
from ..errors import Problem

_BLOCK = re.compile(r"/\*.*?\*/|\(\*.*?\*\)", re.DOTALL)
_OPEN_BLOCK = re.compile(r"/\*|\(\*")
_NAME = re.compile(r"[^\W\d]\w*")
_TOKEN = re.compile(r"[^\s,]+")

HEADERS = frozenset(
    "VAR_GLOBAL END_VAR PROGRAM END_PROGRAM SUBROUTINE END_SUBROUTINE INTERRUPT END_INTERRUPT VAR_INPUT VAR_OUTPUT VAR_IN_OUT VAR_TEMP".split()
)


@dataclass(slots=True)
class Statement:
    """One instruction as written."""

    mnemonic: str
    operands: tuple[str, ...]
    line: int
    comment: str = ""
    title: str = ""


@dataclass(slots=True)
class RawVariable:
    """One line of a variable table: a device for a global, a type for a local variable."""

    name: str
    what: str
    role: str
    line: int
    comment: str = ""
    word: int = 0  # which word of the line is the name


@dataclass(slots=True)
class RawUnit:
    """A unit before anything is resolved."""

    kind: str
    name: str
    line: int
    event: str | None = None
    variables: list[RawVariable] = field(default_factory=list)
    statements: list[Statement] = field(default_factory=list)


@dataclass
class Source:
    """A program's text taken apart. Lines are counted through all its files; `starts` has the first line and the name of each."""

    text: str
    starts: list[tuple[int, str]] = field(default_factory=list)
    globals: list[RawVariable] = field(default_factory=list)
    units: list[RawUnit] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    section: Callable[[str], str] = str  # where the family's manual has what a section of EC's is about

    def place(self, line: int) -> tuple[str, int]:
        """The file that a line stands in, and its number there."""
        if not line:  # the program as a whole
            return self.starts[0][1] if len(self.starts) == 1 else "", 0
        first, name = self.starts[bisect_right(self.starts, line, key=lambda start: start[0]) - 1]
        return name, line - first + 1

    def where(self, line: int) -> str:
        """A line in words, for a message about another one."""
        name, own = self.place(line)
        return f"line {own} of {name}" if len(self.starts) > 1 else f"line {own}"

    def column(self, line: int, word: int) -> int:
        """The column, from 1, of the word with that number in a line."""
        tokens = list(_TOKEN.finditer(self.lines[line - 1].split("//")[0])) if 0 < line <= len(self.lines) else []
        return tokens[word].start() + 1 if word < len(tokens) else 0

    def report(self, line: int, message: str, hint: str = "", section: str = "", word: int = 0) -> None:
        """Note one problem."""
        name, own = self.place(line)
        self.problems.append(Problem(own, self.column(line, word), message, hint, self.section(section), name))


def shown(text: str, limit: int = 40) -> str:
    """`text` fit for a message: quoted, without control characters, not longer than `limit`."""
    clean = "".join(ch if ch.isprintable() else "?" for ch in text)
    return repr(clean if len(clean) <= limit else clean[: limit - 3] + "...")


def read(text: str | Mapping[str, str], name: str = "", syntax: Syntax | None = None) -> Source:
    """Take a program's text, or its files by name, apart; what cannot be read is noted in `problems`.

    A family whose `syntax` has pointers begins its units with them, others with headers.
    """
    files = text if isinstance(text, Mapping) else {name: text}
    source = Source("\n".join(files.values()))
    reader = _PointerReader(source, syntax) if syntax and syntax.pointers else _Reader(source)
    for file, part in files.items():
        reader.read(file, part)
    reader.finish()
    return source


def code_of(line: str, syntax: Syntax) -> str:
    """A line without the comment behind its instruction."""
    return (_PointerReader if syntax.pointers else _Reader)._cut(line)[0]


class _Reader:
    def __init__(self, source: Source):
        self.source = source
        self.implicit: RawUnit | None = None

    def read(self, name: str, text: str) -> None:
        """One file, which leaves nothing open for the next one."""
        source, self.first = self.source, len(self.source.lines)
        self.unit: RawUnit | None = None
        self.in_globals = False
        self.role = ""  # of the variables between VAR_INPUT, VAR_OUTPUT ... and END_VAR
        self.title: list[str] = []
        source.starts.append((self.first + 1, name))
        text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
        lines = self._without_blocks(text).split("\n")
        source.lines[self.first :] = lines
        for number, line in enumerate(lines, self.first + 1):
            code, slashes, comment = self._cut(line)
            words = (code.replace(",", " ") if "," in code else code).split()
            if not words:
                if slashes:
                    self.title.append(comment.strip())
                elif not line.strip():
                    self.title = []
                continue
            self._line(words, comment.strip(), number)
        if self.unit is not None:
            source.report(
                self.unit.line,
                f"{self._header(self.unit)} {self.unit.name} has no end",
                f"write END_{self._header(self.unit)} after its last line",
            )
        if self.in_globals:
            source.report(len(source.lines), "VAR_GLOBAL has no END_VAR")

    @staticmethod
    def _cut(line: str) -> tuple[str, str, str]:
        """A line as what is code, the mark of a comment, and the comment."""
        return line.partition("//")

    def finish(self) -> None:
        """All files have been read."""

    def _without_blocks(self, text: str) -> str:
        """Block comments become blanks; one that fills its lines becomes a `//` comment, so that it can be a title."""
        if "/*" not in text and "(*" not in text:
            return text
        # A // comment may speak of /*: it is left alone.
        pieces, position = [], 0
        while True:
            opened = _OPEN_BLOCK.search(text, position)
            if opened is None:
                return "".join(pieces) + text[position:]
            start = opened.start()
            line_start = text.rfind("\n", 0, start) + 1
            slashes = text.find("//", max(line_start, position), start + 1)  # also in "//* ..."
            if slashes >= 0:
                end = text.find("\n", start)
                end = len(text) if end < 0 else end
                pieces.append(text[position:end])
                position = end
                continue
            match = _BLOCK.match(text, start)
            if match is None:
                self.source.lines[self.first :] = text.split("\n")
                self.source.report(
                    self.first + text.count("\n", 0, start) + 1,
                    "a comment is not closed",
                    f"end it with {'*/' if opened[0] == '/*' else '*)'}",
                )
                return "".join(pieces) + text[position:start]
            after = text[match.end() : (text.find("\n", match.end()) + len(text) + 1) % (len(text) + 1)]
            alone = not text[line_start:start].strip() and not after.strip()
            if alone:
                filler = "\n".join(f"// {part.strip()}" if part.strip() else "" for part in match[0][2:-2].split("\n"))
            else:
                filler = re.sub(r"[^\n]", " ", match[0])  # as wide as it was: what stands behind keeps its column
            pieces.append(text[position:start] + filler)
            position = match.end()

    def _line(self, words: list[str], comment: str, number: int) -> None:
        head = words[0].upper()
        if head in HEADERS:
            self._directive(head, words, comment, number)
        elif self.in_globals:
            self._global(words, comment, number)
        elif self.role:
            self._local(self.role, words, comment, number)
        else:
            unit = self.unit or self._implicit(number)
            unit.statements.append(Statement(head, tuple(words[1:]), number, comment, "\n".join(self.title)))
        self.title = []

    def _implicit(self, number: int) -> RawUnit:
        """The unit that instructions without a header belong to: the main program."""
        if self.implicit is None:
            if any(unit.kind == "MAIN" for unit in self.source.units):
                self.source.report(number, "an instruction stands outside every unit", "put it between PROGRAM MAIN and END_PROGRAM")
            self.implicit = RawUnit("MAIN", "MAIN", number)
            if not any(unit.kind == "MAIN" for unit in self.source.units):
                self.source.units.append(self.implicit)
        return self.implicit

    @staticmethod
    def _header(unit: RawUnit) -> str:
        return "PROGRAM" if unit.kind == "MAIN" else unit.kind

    def _directive(self, head: str, words: list[str], comment: str, number: int) -> None:
        report = self.source.report
        if head in ("PROGRAM", "SUBROUTINE", "INTERRUPT"):
            self._open(head, words, number)
        elif head.startswith("END_") and head != "END_VAR":
            if self.unit is None or head != f"END_{self._header(self.unit)}":
                report(number, f"{head} ends nothing", f"open it with {head[4:]} NAME first")
            self.unit, self.role = None, ""
        elif head == "VAR_GLOBAL":
            if self.unit is not None or self.in_globals:
                report(number, "VAR_GLOBAL stands inside another block", "the variables of the whole program come before PROGRAM MAIN")
            self.in_globals = True
            if len(words) > 1:
                self._global(words[1:], comment, number)
        elif head == "END_VAR":
            # Locals are declared a line each; VAR_INPUT, lines and END_VAR are accepted, as IEC texts have them.
            if not self.in_globals and self.unit is None:
                report(number, "END_VAR ends nothing", "it ends VAR_GLOBAL")
            self.in_globals, self.role = False, ""
        elif len(words) == 1 and self.unit is not None:
            self.role = head.removeprefix("VAR_")
        else:
            self._local(head.removeprefix("VAR_"), words[1:], comment, number)

    def _open(self, head: str, words: list[str], number: int) -> None:
        report = self.source.report
        kind = "MAIN" if head == "PROGRAM" else head
        name = words[1] if len(words) > 1 else ""
        if self.unit is not None:
            report(
                number, f"{head} inside {self._header(self.unit)} {self.unit.name}", f"close it with END_{self._header(self.unit)} first"
            )
        if self.in_globals:
            report(number, "VAR_GLOBAL has no END_VAR")
            self.in_globals = False
        if not _NAME.fullmatch(name):
            report(
                number,
                f"{head} needs a name, found {shown(name)}",
                "for example PROGRAM MAIN, SUBROUTINE SBR_1 or INTERRUPT INT_1 EVENT 26",
                word=1,
            )
        event = None
        if kind == "INTERRUPT":
            if len(words) == 4 and words[2].upper() == "EVENT":
                event = words[3]
            else:
                report(number, f"{head} {name} names no event", "write INTERRUPT INT_1 EVENT 26, for example", "9.1")
        elif len(words) > 2:
            report(number, f"{shown(words[2])} is not expected after {head} {name}", word=2)
        if kind == "MAIN" and any(unit.kind == "MAIN" for unit in self.source.units):
            report(number, "there is a second main program", "one PROGRAM MAIN, the others are subroutines")
        self.unit = RawUnit(kind, name, number, event)
        if kind == "MAIN":
            self.source.units.insert(0, self.unit)
        else:
            self.source.units.append(self.unit)

    def _global(self, words: list[str], comment: str, number: int) -> None:
        if len(words) == 3 and words[1].upper() == "AT":
            self.source.globals.append(RawVariable(words[0], words[2].rstrip(";"), "GLOBAL", number, comment))
        else:
            self.source.report(number, f"{shown(' '.join(words))} declares no variable", "write NAME AT DEVICE, for example Start AT X0")

    def _local(self, role: str, words: list[str], comment: str, number: int) -> None:
        unit = self.unit
        if unit is None:
            self.source.report(number, f"VAR_{role} stands outside a subroutine", "declare it after SUBROUTINE NAME")
            return
        declaration = " ".join(words).replace(":", " : ").rstrip(";").split()
        if len(declaration) == 3 and declaration[1] == ":":
            unit.variables.append(RawVariable(declaration[0], declaration[2].upper(), role, number, comment, word=0 if self.role else 1))
        else:
            hint = "end the variables with END_VAR, or " if self.role else ""
            self.source.report(number, f"{shown(' '.join(words))} declares no variable", f"{hint}write VAR_{role} NAME : INT, for example")


_POINTER = re.compile(r"([PI])(\d{1,4})")
_MARK = re.compile(r"//|;")  # lists of this family have comments behind a semicolon too
_ENDS = {"SRET": "SUBROUTINE", "IRET": "INTERRUPT"}


def pointer_name(word: str) -> str:
    """The name of the part of a program that a pointer begins: P1, I001; "" for what is no pointer."""
    pointer = _POINTER.fullmatch(word.upper())
    return "" if pointer is None else f"I{int(pointer[2]):03d}" if pointer[1] == "I" else f"P{int(pointer[2])}"


class _PointerReader(_Reader):
    """A text whose units are marked by pointers: the main program up to FEND, then P1 ... SRET and I101 ... IRET.

    A part behind FEND that ends with FEND or END, too, belongs to the main program: a jump leads to its label.
    """

    def __init__(self, source: Source, syntax: Syntax):
        super().__init__(source)
        self.syntax = syntax
        self.main: RawUnit | None = None
        self.part: RawUnit | None = None  # what is being read behind the first FEND
        self.last: RawUnit | None = None  # what has been read before
        self.behind = ""  # FEND or END, once it has been read
        self.lost = False  # instructions outside every part are told once
        self.pointers: dict[str, int] = {}  # pointer -> its line

    @staticmethod
    def _cut(line: str) -> tuple[str, str, str]:
        mark = _MARK.search(line)
        return (line[: mark.start()], mark[0], line[mark.end() :]) if mark else (line, "", "")

    def _line(self, words: list[str], comment: str, number: int) -> None:
        head = words[0].upper()
        pointer = _POINTER.fullmatch(head) if len(words) == 1 else None
        if head in ("VAR_GLOBAL", "END_VAR") or self.in_globals:
            super()._line(words, comment, number)
        elif head in HEADERS:
            self.source.report(
                number,
                f"{head} does not stand in a program of this family",
                "a subroutine begins with its label, P1, behind FEND; SRET ends it",
            )
        elif self.behind == "END":
            self.source.report(number, f"{shown(head)} stands behind END", "END is the last line of a program")
        elif pointer:
            self._pointer(Statement(pointer[1], (head,), number, comment, "\n".join(self.title)), int(pointer[2]))
        else:
            self._statement(Statement(head, tuple(words[1:]), number, comment, "\n".join(self.title)))
        self.title = []

    def _pointer(self, label: Statement, number: int) -> None:
        report, name = self.source.report, pointer_name(label.operands[0])
        if number == self.syntax.end_label and label.mnemonic == "P":
            report(label.line, f"{label.operands[0]} stands for END and is no label", "take another number", "3.8")
        first = self.pointers.setdefault(name, label.line)
        if first != label.line:
            report(label.line, f"{name} stands twice", f"it stands in {self.source.where(first)} already", "3.8")
        if label.mnemonic == "I":
            if not self.behind:
                report(label.line, f"{name} stands in the main program", "interrupt programs stand behind FEND", "3.8")
            self._unfinished()
            self._open_part(RawUnit("INTERRUPT", name, label.line, str(number)), label)
        elif self.part is not None or not self.behind:
            (self.part or self._main(label.line)).statements.append(label)
        else:
            self._open_part(RawUnit("SUBROUTINE", name, label.line), label)

    def _open_part(self, part: RawUnit, label: Statement) -> None:
        self.part = part
        self.source.units.append(part)
        part.statements.append(label)

    def _main(self, line: int) -> RawUnit:
        if self.main is None:
            self.main = self.last = RawUnit("MAIN", "MAIN", line)
            self.source.units.insert(0, self.main)
        return self.main

    def _statement(self, statement: Statement) -> None:
        word, report = statement.mnemonic, self.source.report
        ends = word in ("FEND", "END")
        if self.part is None and self.behind and not ends:
            if not self.lost:
                report(
                    statement.line, f"{shown(word)} stands behind {self.behind} outside every subroutine", "begin with a label, P1 or I101"
                )
            self.lost = True
            return
        if ends and self.part is not None and self.part.kind == "SUBROUTINE":  # a part of the main program
            self.source.units.remove(self.part)
            self.main.statements += self.part.statements
            self.part, self.last = None, self.main
        elif ends:
            self._unfinished()
        if ends and self.behind and self.last is not self.main:  # END behind the last SRET
            self.last.statements.append(statement)
        else:
            (self.part or self._main(statement.line)).statements.append(statement)
        if ends:
            self.behind = word
        elif word in _ENDS:
            self._close(statement)

    def _close(self, end: Statement) -> None:
        kind = self.part.kind if self.part else "MAIN"
        if kind != _ENDS[end.mnemonic]:
            here = f"in {self.part.name}" if self.part else "in the main program"
            what = "a subroutine, P1, behind FEND" if end.mnemonic == "SRET" else "an interrupt program, I101, behind FEND"
            self.source.report(end.line, f"{end.mnemonic} stands {here}", f"it ends {what}")
        if self.part is not None:
            self.part, self.last = None, self.part

    def _unfinished(self) -> None:
        """A part that the next one, or the end of the text, cuts off."""
        if self.part is None:
            return
        words = "IRET" if self.part.kind == "INTERRUPT" else "SRET (a subroutine) or FEND (a part of the main program)"
        self.source.report(self.part.line, f"{self.part.name} has no end", f"write {words} as its last line")
        self.part, self.last = None, self.part

    def finish(self) -> None:
        self._unfinished()
