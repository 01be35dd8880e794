"""What a transition waits for, in words."""

import pytest
from ecsim_widgets.waiting import phrases, sentence

import ecsim
from ecsim.views.sfc import chart

VARIABLES = "VAR_GLOBAL\nAtEntry AT X0\nEND_VAR\nPROGRAM MAIN\n"


def drawn(lines, variables=""):
    """The first transition of S0 in a program whose S0 has these lines, and the labels."""
    text = f"{variables}LD SM1\nSET S0\nSTL S0\n{lines}\nSTL S20\nLD X7\nOUT S0\nRET"
    made = chart(ecsim.compile(f"{text}\nEND_PROGRAM" if variables else text))
    return made.steps[0].transitions[0], made.labels


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("LD X0\nSET S20", "X0 on"),
        ("LDI X0\nSET S20", "X0 off"),
        ("LD X0\nANI M0\nSET S20", "X0 on and M0 off"),
        ("LD X0\nOR X5\nSET S20", "X0 or X5"),
        ("LD X4\nED\nSET S20", "X4 to fall"),
        ("LD X4\nEU\nAND X1\nSET S20", "X4 to rise and X1 on"),
        ("LD>= D0 12\nSET S20", "D0 ≥ 12"),
        ("LD X0\nAND X1\nEU\nSET S20", "(X0 and X1) rises"),
        ("SET S20", "always"),
    ],
)
def test_the_whole_condition_is_told(lines, words):
    assert sentence(*drawn(lines)) == words


def test_names_stand_before_addresses():
    assert phrases(*drawn("LD X0\nSET S20", VARIABLES)) == [("AtEntry", "X0", "on")]


def test_what_is_met_is_not_waited_for():
    met = lambda word: str(word.operands[0]) == "X0"
    assert phrases(*drawn("LD X0\nANI M0\nSET S20"), met) == [("", "M0", "off")]


def test_of_several_ways_one_is_enough():
    assert phrases(*drawn("LD X0\nOR X5\nAND X1\nSET S20"), lambda word: str(word.operands[0]) == "X5") == [("", "X1", "on")]


def test_an_edge_is_waited_for_although_its_contact_is_closed():
    assert phrases(*drawn("LD X4\nED\nSET S20"), lambda word: word.mnemonic == "LD") == [("", "X4", "to fall")]
