"""How the tests of this folder look at refusals."""

import pytest

from ecsim.assembler import assemble
from ecsim.errors import Problem, ProgramError


def refused(text: str, model: str = "EC20") -> list[Problem]:
    """The problems for which a program is refused."""
    with pytest.raises(ProgramError) as error:
        assemble(text, model)
    return error.value.problems


def only(text: str, model: str = "EC20") -> Problem:
    """The one problem for which a program is refused."""
    problems = refused(text, model)
    assert len(problems) == 1, [str(problem) for problem in problems]
    return problems[0]


def accepted(text: str, model: str = "EC20"):
    """The program, which must be one."""
    return assemble(text, model)


def with_routine(body: str, variables: str = "", main: str = "LD SM0\nCALL SBR_1") -> str:
    """A main program that calls a subroutine; the subroutine's body begins in line 6 and more."""
    return f"PROGRAM MAIN\n{main}\nEND_PROGRAM\nSUBROUTINE SBR_1\n{variables}{body}\nEND_SUBROUTINE"
