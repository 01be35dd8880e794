"""What a translation is written with: its lines, what it refuses and what it notes."""

from dataclasses import dataclass

from ..assembler import Instruction, Program
from ..errors import Problem


class Refusal(Exception):
    """Something that the other family cannot do, or not so; the message says what, `hint` what helps."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(message)
        self.hint = hint


@dataclass(slots=True)
class Line:
    """One instruction of the translated program, and the line of the original that it comes from."""

    mnemonic: str
    written: tuple[str, ...]
    line: int = 0
    comment: str = ""
    title: str = ""
    spelled: str = ""


class Text:
    """Notes and problems of one translation, each with the line of the original."""

    def __init__(self, program: Program):
        self.program = program
        self.notes: dict[str, int] = {}
        self.problems: list[Problem] = []

    def note(self, line: int, what: str) -> None:
        """Something differs; it is said once, of the first line."""
        self.notes.setdefault(what, line)

    def refuse(self, line: int, refusal: Refusal) -> None:
        """Something cannot be kept."""
        self.problems.append(Problem(line, 0, str(refusal), refusal.hint))

    def refuse_at(self, instruction: Instruction, refusal: Refusal) -> None:
        """Something about an instruction cannot be kept."""
        self.refuse(instruction.line, Refusal(f"{instruction}: {refusal}", refusal.hint))
