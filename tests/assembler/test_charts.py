"""5.3 and 7.4.1: the rules of step flows. The flows of these tests are S0 - S20 - S21 - S22 with one rule broken, or kept in an odd way."""

import pytest

from .refusals import accepted, only, refused, with_routine

FLOW = """LD SM1
SET S0
STL S0
OUT Y0
LD X0
SET S20
STL S20
OUT Y1
LD X1
SET S21
STL S21
OUT Y2
LD X2
OUT S0
RET"""


def flow(**changes):
    """FLOW with some lines replaced: `line_9="..."`."""
    lines = FLOW.split("\n")
    for name, text in changes.items():
        lines[int(name.removeprefix("line_")) - 1] = text
    return "\n".join(lines)


def test_the_flow_of_these_tests_is_legal():
    accepted(FLOW)


@pytest.mark.parametrize(
    ("changes", "place", "says", "hint", "section"),
    [
        ({"line_15": "NOP"}, (11, 1), "STL S21 has no RET", "close it with RET", "7.2.3"),
        ({"line_15": "RET\nRET"}, (16, 1), "RET closes nothing", "there is no open STL", "5.3.5"),
        ({"line_11": "STL S20"}, (11, 1), "the step S20 is used twice", "its first use is in line 7", "7.4.1(1)"),
        ({"line_15": "RET\nSTL S20\nOUT Y3\nRET"}, (16, 1), "the step S20 is used twice", "line 7", "7.4.1(1)"),
        ({"line_6": "MPS\nAND X3\nSET S20\nMPP\nOUT Y3"}, (8, 1), "SET S20 stands behind a branch", "from LD on", "7.4.1(2)"),
        ({"line_6": "SET S20\nAND X3\nOUT S21"}, (8, 1), "OUT S21 stands behind a branch", "from LD on", "7.4.1(2)"),
        ({"line_6": "OUT Y4\nAND X3\nSET S20"}, (8, 1), "SET S20 stands behind a branch", "from LD on", "7.4.1(2)"),
        ({"line_14": "SET S0"}, (14, 1), "SET S0 goes back", "a jump is written OUT S0", "7.4.1(6)"),
        ({"line_14": "SET S20"}, (14, 1), "SET S20 goes back", "a jump is written OUT S20", "7.4.1(6)"),
        ({"line_14": "SET S21"}, (14, 1), "SET S21 goes back", "a jump is written OUT S21", "7.4.1(6)"),
        ({"line_10": "SET S21\nLD X4\nSET S0"}, (12, 1), "SET S0 goes back", "OUT S0", "7.4.1(6)"),
        ({"line_6": "SET S20\nLD X5\nSET S21"}, (8, 1), "SET S21 leaves out the steps between", "a jump is written OUT S21", "7.4.1(6)"),
        ({"line_10": "OUT S21"}, (10, 1), "OUT S21 leads to the adjacent step", "a transition is written SET S21", "7.4.1(6)"),
        (
            {"line_15": "RET\nSTL S1\nLD X5\nSET S22\nSTL S22\nLD X6\nSET S23\nRET\nSTL S23\nLD X7\nOUT S1\nRET"},
            (21, 1),
            "SET S23 leads into another flow",
            "OUT S23",
            "7.4.1(6)",
        ),
        ({"line_4": "LD X6\nMC 0\nLD X7\nOUT Y0\nMCR 0"}, (5, 1), "MC cannot be used in a step", "", "5.2.1"),
        ({"line_1": "LD X6\nMC 0\nLD SM1", "line_15": "RET\nMCR 0"}, (5, 1), "STL S0 stands inside MC", "close it with MCR first", "5.2.1"),
        ({"line_5": "AND X0"}, (5, 1), "AND X0 has no LD before it", "begin the contacts of a rung with LD", "5.1.1"),
        ({"line_4": "EU"}, (4, 1), "EU stands directly on the bus", "put a contact before it", "5.1.13"),
    ],
)
def test_a_broken_rule_is_told_where_it_is_broken(changes, place, says, hint, section):
    problem = refused(flow(**changes))[0]
    assert ((problem.line, problem.column), problem.section) == (place, section)
    assert says in problem.message
    assert hint in problem.hint


@pytest.mark.parametrize(
    "changes",
    [
        {"line_12": "NOP"} | {"line_12": "LD X5\nNOP"},
        {"line_4": "LD X5\nOUT Y0", "line_8": "SET Y1"},
        {"line_6": "SET S20\nSET Y5"},  # more than the transition from one condition
        {"line_6": "OUT Y5\nSET S20"},
        {"line_6": "SET S20\nLD X5\nOUT S21"},  # a jump over a step
        {"line_14": "OUT S20"},  # a loop within the flow
        {"line_14": "OUT S21"},  # a step begun again by itself
        {"line_14": "RST S21"},  # the flow ends
        {"line_14": "OUT S0\nLD X6\nOUT S20"},
        {"line_13": "LD X2\nOR X3\nAND X4"},
        {"line_13": "LD X2\nOR X3\nLD X4\nORI X5\nANB"},
        {"line_8": "LD X7\nMPS\nAND X6\nOUT Y1\nMPP\nANI X6\nOUT Y3"},
        {"line_8": "LD X7\nFOR 2\nLD X6\nINC D0\nNEXT"},
        {"line_1": "LD X7", "line_15": "RET\nLD X6\nRST S20\nLD X5\nSET S21\nLD M0\nZRST S20 2"},  # steps as bits, outside the chart
        {"line_2": "SET S0\nSET S1", "line_15": "RET\nSTL S1\nLD X5\nSET S22\nSTL S22\nLD X6\nOUT S20\nRET"},  # a jump into another flow
        {"line_4": "LD S21\nOUT Y0"},
    ],
)
def test_what_the_rules_allow_is_a_program(changes):
    accepted(flow(**changes))


def test_transitions_to_steps_without_a_body_are_accepted():
    accepted(flow(line_10="SET S991"))


def test_a_step_begins_outside_a_loop():
    problems = refused(flow(line_4="LD X6\nFOR 2\nLD X7\nOUT Y0"))
    assert [(p.line, p.hint) for p in problems if p.message == "STL S20 stands inside FOR"] == [(10, "close it with NEXT first")]


def test_steps_stand_in_the_main_program_only():
    problem = refused(with_routine("STL S20\nOUT Y0\nRET"))[0]
    assert (problem.line, problem.column, problem.section) == (6, 1, "5.3.5")
    assert problem.message == "steps may stand in the main program only"


# -- branches -----------------------------------------------------------------------------------------------------


def parallel(count, **joined):
    """S0 opens `count` branches of one step; they join in S100."""
    branches = range(20, 20 + count)
    opening = "\n".join(["LD SM1", "SET S0", "STL S0", "LD X0", *(f"SET S{n}" for n in branches)])
    bodies = "\n".join(f"STL S{n}\nOUT M{n}" for n in branches)
    join = "\n".join(f"STL S{n}" for n in branches)
    return f"{opening}\n{bodies}\n{join}\nLD X1\nSET S100\nSTL S100\nOUT Y0\nLD X2\nOUT S0\nRET"


def test_a_join_names_its_steps_again_without_using_them_twice():
    program = accepted(parallel(3))
    join = next(node for node in program.main.nodes if getattr(node, "steps", ()) and len(node.steps) == 3)
    assert [str(step) for step in join.steps] == ["S20", "S21", "S22"]


def test_sixteen_steps_join_and_no_more():
    accepted(parallel(16))
    problem = only(parallel(17))
    assert (problem.message, problem.section) == ("more than 16 steps are joined", "5.3.1")
    assert problem.line == 4 + 17 + 2 * 17 + 17  # the seventeenth STL of the join


def test_a_selection_with_branches_of_different_length_joins_without_a_jump():
    accepted(
        "LD SM1\nSET S0\nSTL S0\nLD X0\nSET S20\nLD X1\nSET S22\nSTL S20\nLD X2\nSET S21\nSTL S21\nLD X3\nSET S23\nSTL S22\nLD X4\nSET S23\nSTL S23\nLD X5\nOUT S0\nRET"
    )


def test_a_way_past_a_branch_is_a_jump():
    text = "LD SM1\nSET S0\nSTL S0\nLD X0\nSET S20\nLD X1\n{} S21\nSTL S20\nLD X2\nSET S21\nSTL S21\nLD X5\nOUT S0\nRET"
    accepted(text.format("OUT"))
    assert only(text.format("SET")).line == 7


def test_networks_and_regions_follow_the_program():
    unit = accepted(FLOW).main
    lines = [unit.instructions[network.start].line for network in unit.networks]
    assert lines == [1, 3, 4, 5, 7, 8, 9, 11, 12, 13, 15]
    steps = [node for node in unit.nodes if hasattr(node, "nodes")]
    assert [(node.kind, node.number, len(node.nodes)) for node in steps] == [("STL", 0, 2), ("STL", 20, 2), ("STL", 21, 2)]
    assert [network.region for network in unit.networks[:4]] == [(), (), (("STL", 0),), (("STL", 0),)]
