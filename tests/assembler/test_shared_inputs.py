"""Inputs that two functions would need are refused with both lines named (8.5); events that a model has not, too (9.1)."""

import pytest

from ecsim import ProgramError
from ecsim.assembler import assemble

ROUTINE = "END_PROGRAM\nINTERRUPT I EVENT {}\nLD SM0\nINC D0\nEND_INTERRUPT"


def problems(text, model="EC20"):
    with pytest.raises(ProgramError) as caught:
        assemble(text, model)
    return caught.value.problems


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("LD SM0\nHCNT C236 5\nLD M0\nSPD X0 100 D0", 4, "X0 serves HCNT C236 in line 2 and SPD X0 in line 4"),
        ("LD SM0\nHCNT C242 5\nHCNT C238 9", 3, "X2 serves HCNT C242 in line 2 and HCNT C238 in line 3"),
        ("LD SM0\nSPD X3 100 D0\nLD SM93\nOUT Y0", 3, "X3 serves SPD X3 in line 2 and pulse capture SM93 in line 3"),
        ("LD SM0\nHCNT C236 5\nLD SM0\nMOV K4SM88 D0", 4, "X0 serves HCNT C236 in line 2 and pulse capture SM90 in line 4"),
        (
            "PROGRAM MAIN\nLD SM0\nHCNT C244 5\n" + ROUTINE.format(16),
            5,
            "X6 serves HCNT C244 in line 3 and the interrupt event 16 in line 5",
        ),
    ],
)
def test_both_lines_are_named(text, line, words):
    (problem, *_) = problems(text)
    assert (problem.line, problem.section) == (line, "8.5")
    assert problem.message == words
    assert "one high-speed counter, SPD, pulse capture or interrupt" in problem.hint


def test_an_event_that_the_model_has_not_is_refused_with_those_that_it_has():
    (problem,) = problems("PROGRAM MAIN\nLD SM0\nEI\n" + ROUTINE.format(18))
    assert problem.message == "EC20 has no interrupt event 18"
    assert problem.hint == "it has 0 to 7, 10 to 17, 20 to 28"
    assert assemble("PROGRAM MAIN\nLD SM0\nEI\n" + ROUTINE.format(18), "EC10").units[1].event == 18


@pytest.mark.parametrize(
    "text", ["LD SM0\nPLSY 1 1 Y2", "LD SM0\nHCNT C235 1", "LD SM0\nSPD X6 1 D0", "LD SM0\nDHSCR 1 C236 C237", "LD SM0\nDHSCI 1 C236 19"]
)
def test_devices_of_the_wrong_number_are_refused(text):
    assert problems(text)[0].line == 2
