"""Chapters 4, 5.1, 5.2, 5.4, 5.5 and 6.1: what a unit may look like, and where a refusal points."""

import pytest

from .refusals import accepted, only, refused, with_routine

NESTED_MPS = "LD X0\n" + "".join(f"MPS\nAND M{n}\n" for n in range(8)) + "OUT Y0\n" + "MPP\nOUT Y1\n" * 8


def nested(opening, closing, depth):
    """Structures within one another, a rung inside."""
    return (
        "\n".join(f"LD X0\n{opening.format(n)}" for n in range(depth))
        + "\nLD X1\nOUT Y0\n"
        + "\n".join(closing.format(n) for n in reversed(range(depth)))
    )


@pytest.mark.parametrize(
    ("text", "place", "says", "hint", "section"),
    [
        # 4.1.1, 5.1: a rung begins with a contact and ends with an output
        ("OUT Y0", (1, 1), "OUT Y0 has no power flow", "begin the rung with a contact", "4.1.1"),
        ("AND X0\nOUT Y0", (1, 1), "AND X0 has no power flow", "LD", "4.1.1"),
        ("LD X0\nOUT Y0\nLD X1\nAND X2", (4, 1), "the rung ends without an output", "coil", "4.1.1"),
        ("LD X0\nLD X1\nOUT Y0", (3, 1), "2 blocks are not joined before OUT Y0", "ANB or ORB", "5.1.8"),
        ("LD X0\nOR X1\nLD X2\nLD X3\nANB\nOUT Y0", (6, 1), "2 blocks are not joined", "ANB or ORB", "5.1.8"),
        ("LD X0\nANB\nOUT Y0", (2, 1), "ANB needs two blocks", "each block begins with LD", "5.1.8"),
        ("LD X0\nORB\nOUT Y0", (2, 1), "ORB needs two blocks", "each block begins with LD", "5.1.9"),
        ("LD X0\nOUT Y0\nOR X1\nOUT Y1", (3, 1), "OR X1 has no block to stand parallel to", "before any output or MPS", "5.1.5"),
        ("LD X0\nMPS\nOR X1\nOUT Y0\nMPP\nOUT Y1", (3, 1), "OR X1 has no block to stand parallel to", "MPS", "5.1.5"),
        # 5.1.10 to 5.1.12
        ("LD X0\nMRD\nOUT Y0", (2, 1), "MRD without MPS", "MPS keeps the flow", "5.1.11"),
        ("LD X0\nMPP\nOUT Y0", (2, 1), "MPP without MPS", "MPS keeps the flow", "5.1.12"),
        ("LD X0\nMPS\nOUT Y0\nLD X1\nOUT Y1", (3, 1), "1 MPS without MPP", "MPP", "5.1.10"),
        ("LD X0\nMPS\nOUT Y0", (3, 1), "1 MPS without MPP", "end the last branch with MPP", "5.1.10"),
        (
            NESTED_MPS.replace("OUT Y0", "MPS\nAND M9\nOUT Y0", 1) + "MPP\nOUT Y2",
            (18, 1),
            "more than 8 MPS without MPP",
            "new rung",
            "5.1.10",
        ),
        # 5.2
        ("LD X0\nMC 0\nLD X1\nOUT Y0", (2, 1), "MC 0 has no MCR", "close it with MCR 0", "5.2.1"),
        ("MCR 0", (1, 1), "MCR 0 closes nothing", "there is no open MC 0", "5.2.2"),
        ("LD X0\nMC 1\nLD X1\nOUT Y0\nMCR 2\nMCR 1", (5, 1), "MCR 2 closes nothing", "MC 2", "5.2.2"),
        ("LD X0\nMC 0\nLD X1\nMC 1\nLD X2\nOUT Y0\nMCR 0\nMCR 1", (7, 1), "MCR 0 crosses MC 1", "close MC 1 first", "5.2.2"),
        ("LD X0\nMC 2\nLD X1\nMC 2\nLD X2\nOUT Y0\nMCR 2\nMCR 2", (4, 1), "MC 2 stands inside MC 2", "different numbers", "5.2.1"),
        ("LD X0\nMC 8\nMCR 8", (2, 4), "S = '8' is out of range", "0 to 7", "5.2.1"),
        ("LD X0\nMC M0\nMCR 0", (2, 4), "'M0' cannot be S", "a constant", "3.3.2"),
        ("LD X0\nMPS\nMC 0\nMPP\nOUT Y0\nMCR 0", (3, 1), "MC 0 stands in a branch of MPS", "a rung of its own", "5.2.1"),
        ("STL S0\nLD X0\nMC 0\nLD X1\nOUT Y0\nMCR 0\nRET", (3, 1), "MC cannot be used in a step", "", "5.2.1"),
        # 6.1
        ("LD X0\nFOR 3\nLD X1\nOUT Y0", (2, 1), "FOR 3 has no NEXT", "close it with NEXT", "6.1.1"),
        ("NEXT", (1, 1), "NEXT closes nothing", "there is no open FOR", "6.1.2"),
        ("LD X0\nFOR 3\nLD X1\nMC 0\nLD X2\nOUT Y0\nNEXT\nMCR 0", (7, 1), "NEXT crosses MC 0", "close MC 0 first", "6.1.2"),
        (nested("FOR 2", "NEXT", 9), (18, 1), "FOR is nested 9 deep", "at most 8", "6.1.1"),
        ("LBL 1\nLD X0\nOUT Y0\nLBL 1", (4, 1), "the label 1 stands twice", "line 1", "6.1.3"),
        ("LD X0\nCJ 7", (2, 1), "there is no LBL 7 in MAIN", "the unit in which it is jumped to", "6.1.4"),
        (with_routine("LBL 7", main="LD X0\nCJ 7\nLD X0\nCALL SBR_1"), (3, 1), "there is no LBL 7 in MAIN", "unit", "6.1.4"),
        ("LD X0\nCJ 1\nLD X1\nFOR 2\nLBL 1\nLD X2\nOUT Y0\nNEXT", (2, 1), "CJ 1 jumps into a FOR", "not enter it", "6.1.1"),
        ("LD X0\nCJ 128\nLBL 127", (2, 4), "S = '128' is out of range", "0 to 127", "6.1.4"),
        ("LD X0\nCSRET", (2, 1), "CSRET may stand in a subroutine only", "", "6.1.12"),
        ("LD X0\nCIRET", (2, 1), "CIRET may stand in an interrupt program only", "", "6.1.9"),
        (with_routine("LD X0\nCFEND"), (7, 1), "CFEND may stand in the main program only", "", "6.1.5"),
        (with_routine("LD X0\nCIRET"), (7, 1), "CIRET may stand in an interrupt program only", "", "6.1.9"),
    ],
)
def test_a_broken_rule_is_told_where_it_is_broken(text, place, says, hint, section):
    problem = refused(text)[0]
    assert ((problem.line, problem.column), problem.section) == (place, section)
    assert says in problem.message
    assert hint in problem.hint


def test_the_eighth_master_control_is_one_too_many():
    text = nested("MC {}", "MCR {}", 7)
    accepted(text)
    inner = "LD X0\nMC 7\nLD X1\nOUT Y0\nMCR 7"
    problem = only(text.replace("LD X1\nOUT Y0", inner))
    assert (problem.line, problem.message, problem.hint) == (16, "MC is nested 8 deep", "at most 7")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "// nothing but a word",
        "LD X0\nNOP",
        "LD X0\nOUT Y0\nOUT Y1\nAND X1\nOUT Y2",
        "LD X0\nOR X1\nAND X2\nORI X3\nOUT Y0",
        "LD X0\nAND X1\nLD X2\nAND X3\nORB\nLD X4\nOR X5\nANB\nOUT Y0",
        "LD X0\nLD X1\nLD X2\nLD X3\nORB\nANB\nORB\nOUT Y0",
        "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nANI X2\nOUT Y1\nMPP\nOUT Y2",
        "LD X0\nMPS\nLD X1\nOR X2\nANB\nOUT Y0\nMPP\nLD X3\nAND X4\nLD X5\nORB\nANB\nOUT Y1",
        "LD X0\nMPS\nMPS\nOUT Y0\nMPP\nOUT Y1\nMPP\nOUT Y2",
        NESTED_MPS,
        "LD X0\nEU\nOUT Y0\nLD X1\nED\nINV\nSET M0",
        "LD X0\nMC 0\nOUT Y0\nLD X1\nOUT Y1\nMCR 0",
        "LD X0\nMC 3\nMCR 3\nLD X0\nMC 3\nMCR 3",
        nested("FOR 2", "NEXT", 8),
        "LD X0\nFOR 2\nLD X1\nCJ 1\nNEXT\nLBL 1",
        "LBL 1\nLD X0\nCJ 1",
        "LD X0\nCJ 0\nLBL 127\nLD X0\nCJ 127\nLBL 0",
        "LD X0\nMC 0\nLD X1\nFOR 2\nLD X2\nMC 1\nLD X3\nOUT Y0\nMCR 1\nNEXT\nMCR 0",
        "LD X0\nCFEND\nLD X1\nOUT Y0",
        with_routine("LD X0\nCSRET\nLD X1\nOUT Y0\nLBL 7", main="LD X0\nCALL SBR_1\nLBL 7"),
        "PROGRAM MAIN\nEND_PROGRAM\nINTERRUPT INT_1 EVENT 26\nLD X0\nCIRET\nLD X1\nOUT Y0\nEND_INTERRUPT",
    ],
)
def test_what_the_rules_allow_is_a_program(text):
    accepted(text)


def test_all_problems_of_a_program_are_told_at_once_in_the_order_of_the_lines():
    problems = refused("LD X0\nOUT X1\nLD Q9\nOUT Y0\nLD X2\nMOVE 1 D0\nLD X3\nTON T0")
    assert [problem.line for problem in problems] == [2, 3, 6, 8]


def test_all_broken_structures_are_told_at_once():
    problems = refused("LD X0\nANB\nOUT Y0\nMCR 1\nLD X1\nCJ 9\nLD X2")
    assert [problem.line for problem in problems] == [2, 4, 6, 7]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("  LD   X0\n\tOUT\tX1", (2, 6)),
        ("LD X0 // one\n/* two */ OUT X1", (2, 15)),
        ("LD X0\n(* a\nb *)\nOUT X1", (4, 5)),
        ("LD X0 /* a\nb */\nOUT /* c */ X1", (3, 13)),
        ("LD X0\r\nOUT X1\r\n", (2, 5)),
        ("LD X0\nADD D0, D1, X1", (2, 13)),
        ("ld x0\nout x1", (2, 5)),
        ("\ufeffLD X0\nOUT X1", (2, 5)),
    ],
)
def test_the_column_is_that_of_the_word_as_it_was_written(text, place):
    problem = refused(text)[0]
    assert (problem.line, problem.column) == place


def test_a_problem_names_the_file_it_is_in():
    from ecsim.assembler import assemble
    from ecsim.errors import ProgramError

    with pytest.raises(ProgramError) as error:
        assemble("LD X0\nOUT X1", "EC20", "press.il")
    assert str(error.value.problems[0]).startswith("press.il: line 2, column 5: ")
