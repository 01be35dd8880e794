"""7.1 and 7.4.1 as a newcomer meets them: correct flows written in different ways are accepted, wrong ones get a hint that helps."""

import pytest

import ecsim

BOTTLING = """
LD SM1
SET S0
STL S0
LD X13
SET S33
STL S33         // turntable
OUT Y0
LD X0
EU
SET S20
SET S23
SET S26
STL S20         // an empty step: parallel branches are followed by a selection (7.4.2)
LD X1
SET S21
LDI X1
OUT S28
STL S21
OUT Y1
LD X7
EU
SET S22
STL S22
LD X2
SET M1
LD X10
EU
SET S28
{cap}STL S23
LD M2
SET S24
LDI M2
OUT S30
STL S24
OUT Y2
LD X6
EU
SET S25
STL S25
LDI X3
RST M2
LD X11
EU
SET S30
{label}STL S26
LDI M3
SET S27
LD M3
OUT S32
STL S27
OUT Y3
LD X5
EU
SET S31
STL S31
LD X12
EU
SET S32
STL S32
RST M3
STL S28         // the join
STL S30
STL S32
{whole}SET S29
STL S29
LD M2
SET M3
LD M1
SET M2
LDI M1
RST M2
LD SM0
RST M1
OUT S33
RET
"""
WAIT = "STL S28\nLD SM0\nNOP\n", "STL S30\nLD SM0\nNOP\n"


def problems(text: str, model: str = "EC20") -> list:
    with pytest.raises(ecsim.ProgramError) as refused:
        ecsim.compile(text, model)
    return refused.value.problems


@pytest.mark.parametrize("model", ["EC10", "EC20"])
@pytest.mark.parametrize(
    ("cap", "label", "whole"),
    [("", "", "LD SM0\n"), (*WAIT, "LD SM0\n"), ("", "", "")],
    ids=["waiting steps in the join only", "waiting steps with a rung", "the join without a condition"],
)
def test_the_bottling_machine_may_be_written_in_these_ways(model, cap, label, whole):
    assert ecsim.compile(BOTTLING.format(cap=cap, label=label, whole=whole), model).steps >= 150


def test_empty_steps_one_after_the_other_are_told_to_be_a_join():
    [problem] = problems(BOTTLING.format(cap="STL S28\n", label="STL S30\n", whole="LD SM0\n"))
    assert problem.message == "SET S29 leaves out the steps between"
    assert problem.hint == "STL S28 and STL S23 in line 30 are a join; give an empty step a rung of its own, for example LD SM0, NOP"


def test_a_step_after_another_may_have_any_number():
    text = "STL S0\nLD X0\nSET S30\nSTL S30\nLD X1\nSET S25\nSTL S25\nLD X2\nOUT S0\nRET"
    assert len(ecsim.compile(text).main.networks) > 0


def test_a_transition_to_an_initial_step_is_named_so():
    [problem] = problems("STL S0\nLD X0\nSET S5\nSTL S5\nLD X1\nOUT S0\nRET")
    assert (problem.line, problem.message) == (3, "SET S5 leads to an initial step")
    assert problem.hint == "S0 to S19 are initial; a jump is written OUT S5"


def test_twenty_flows_are_the_limit():  # 7.1.2
    flow = "STL S{0}\nLD X0\nRST S{0}\nRET\n"
    ecsim.compile("".join(flow.format(number) for number in range(20)))
    [problem] = problems("".join(flow.format(number) for number in range(21)))
    assert (problem.line, problem.message, problem.hint) == (84, "there are 21 flows of steps", "at most 20")


@pytest.mark.parametrize(
    ("text", "place", "hint"),
    [
        ("LDN X0\nOUT Y0", (1, 1), "write LDI"),
        ("LD X0\nST Y0", (2, 1), "write OUT"),
        ("LD X0\nOUT Y0\nEND", (3, 1), "a program ends with its last line"),
        ("LDP X0\nOUT Y0", (1, 1), "write LD and EU behind the contacts"),
        ("LD X0 OUT Y0", (1, 7), "one instruction a line"),
        ("LD = D0 5\nOUT Y0", (1, 6), "a comparison is written LD= D0 5"),
        ("LD D0 >= 5\nOUT Y0", (1, 7), "a comparison is written LD>= D0 5"),
    ],
)
def test_words_of_other_languages_get_the_word_of_this_one(text, place, hint):
    [problem] = problems(text)
    assert ((problem.line, problem.column), problem.hint) == (place, hint)
