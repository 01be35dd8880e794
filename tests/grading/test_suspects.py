"""Which networks come under suspicion first."""

import pytest

import ecsim
from ecsim.grading import Never
from ecsim.grading.grade import Stage, usual
from ecsim.grading.suspects import suspects

DARK = Never("dark", "Never", "Lamp and not Switch")


def order(exercise, text):
    """Numbers of the networks, the most suspicious first, when DARK is broken."""
    program = ecsim.compile(text, "EC20")
    scenario = exercise.scenarios[0]
    trace, _ = Stage(exercise, program).run(scenario, usual(scenario.choices))
    finding = DARK.judge(trace).finding
    assert finding is not None
    return [network.number for _, network in suspects(exercise, program, DARK, finding, trace)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("LD X1\nOUT M5\nLD X0\nOUT M0\nLDI M0\nOUT Y0", [2, 1, 0]),  # what writes the lamp, what writes M0, what has nothing to do with it
        ("LDI M0\nOUT Y0\nLD X0\nOUT M0", [0, 1]),
    ],
)
def test_what_is_nearer_to_the_output_comes_first(lamp, text, expected):
    assert order(lamp(), text) == expected


CHART = """LD SM1
SET S0
STL S0
LD X0
SET S21
STL S21
LDI X0
SET S22
STL S22
LD SM0
SET S23
STL S23
OUT Y0
LD X5
SET S24
STL S24
OUT Y0
RET"""


def test_steps_that_were_not_active_are_spared_and_those_left_last_are_not(lamp):
    """Networks 4, 6, 8, 10, 11 and 13 stand in S21 (2 stands in S0) to S24; S22 hands over in the scan in which it begins."""
    found = order(lamp(), CHART)
    assert 13 not in found[:2]
    assert found[0] == 8  # OUT Y0 in S23
    assert found.index(6) < found.index(2)
    assert found.index(4) < found.index(2)
