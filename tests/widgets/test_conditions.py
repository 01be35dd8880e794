"""Steps in words, from their networks."""

import pytest
from ecsim_widgets.conditions import phrases, sections, sentence

import ecsim


def section(step, lines):
    return sections(ecsim.compile(f"LD SM1\nSET S0\nSTL S0\n{lines}\nSTL S20\nLD X7\nOUT S0\nSTL S21\nLD X7\nOUT S0\nRET"))[step]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("LD X0\nSET S20", "X0 on"),
        ("LDI X0\nSET S20", "X0 off"),
        ("LD X0\nANI M0\nSET S20", "X0 on and M0 off"),
        ("LD X0\nOR X5\nSET S20", "X0 on or X5 on"),
        ("LD X4\nED\nSET S20", "X4 to fall"),
        ("LD X4\nEU\nSET S20", "X4 to rise"),
        ("LD>= D0 12\nSET S20", "D0 >= 12"),
    ],
)
def test_a_transition_says_what_it_waits_for(lines, words):
    assert sentence(phrases(section("S0", lines).transitions[0], lambda device: "")) == words


def test_names_stand_before_addresses():
    transition = section("S0", "LD X0\nSET S20").transitions[0]
    assert phrases(transition, {"X0": "AtEntry"}.get) == [("AtEntry", "X0", "on")]


def test_what_is_met_already_is_not_waited_for():
    transition = section("S0", "LD X0\nANI M0\nSET S20").transitions[0]
    assert sentence(phrases(transition, lambda device: "", lambda contact: contact.device == "X0")) == "M0 off"


def test_of_several_ways_all_are_told():
    transition = section("S0", "LD X0\nOR X5\nSET S20").transitions[0]
    assert sentence(phrases(transition, lambda device: "", lambda contact: contact.device == "X0")) == "X0 on or X5 on"


def test_a_step_tells_its_outputs_and_the_steps_that_may_follow():
    found = section("S0", "OUT Y0\nSET Y1\nTON T0 5\nLD X0\nSET S20\nLD X1\nSET S21")
    assert found.actions == ["Y0", "Y1", "T0"]
    assert found.targets == ["S20", "S21"]


def test_a_parallel_branch_is_one_transition_to_several_steps():
    assert section("S0", "LD X0\nSET S20\nSET S21").transitions[0].targets == ("S20", "S21")


def test_a_join_is_a_transition_of_each_of_its_steps():
    joined = sections(
        ecsim.compile(
            "LD SM1\nSET S0\nSTL S0\nLD X0\nSET S20\nSET S21\nSTL S20\nOUT Y0\nSTL S21\nOUT Y1\nSTL S20\nSTL S21\nLD X1\nOUT S0\nRET"
        )
    )
    assert joined["S20"].targets == joined["S21"].targets == ["S0"]
