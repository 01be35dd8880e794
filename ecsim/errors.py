"""What can go wrong, in three kinds: a program that does not compile, a wrong use of the library, a fault inside the PLC."""

from dataclasses import dataclass


class EcsimError(Exception):
    """Any refusal of ecsim; its text names what was found, what was expected and the remedy."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One finding about a program: where it is, what was found, and what helps."""

    line: int
    column: int
    message: str
    hint: str = ""
    section: str = ""
    source: str = ""

    def __str__(self) -> str:
        line = f"line {self.line}, column {self.column}" if self.column else f"line {self.line}" if self.line else ""
        text = ": ".join(part for part in (self.source, line, self.message) if part)
        if self.hint:
            text += f"; {self.hint}"
        return f"{text} (manual {self.section})" if self.section else text


class ProgramError(EcsimError):
    """A program was refused; `problems` holds every finding, ordered by line."""

    def __init__(self, problems: list[Problem]):
        self.problems = sorted(problems, key=lambda problem: (problem.source, problem.line, problem.column))
        count = len(self.problems)
        head = "the program has an error" if count == 1 else f"the program has {count} errors"
        super().__init__("\n".join([f"{head}:", *(f"  {problem}" for problem in self.problems)]))


class Fault(Exception):
    """An execution fault of one instruction (appendix 6): it ends as SM20 and SD20, never as a traceback."""

    def __init__(self, code: int):
        super().__init__(code)
        self.code = code


# Codes of execution faults by meaning (appendix 6); models may spell their relays differently, the codes are the manual's.
WATCHDOG = 61
OPERAND = 64
RANGE = 65
CALL_DEPTH = 66
QUEUE_FULL = 67
DIVISION = 69
STACK = 70
NO_ROUTINE = 72
NO_MODULE = 73
NO_ANSWER = 74
REFRESH = 75
CLOCK = 76
RAMP = 77
NO_BUFFER = 78
SERVO_SILENT = 79
SERVO_CHECKSUM = 80
