"""What is offered while a program is typed, and how its problems are marked."""

import pytest
from ecsim_widgets.assist import Place, marks

from ecsim.models import get_model

EC20 = get_model("EC20")
PROGRAM = """VAR_GLOBAL
  Start AT X5      // start button
  Speed AT D100
END_VAR
PROGRAM MAIN
LD Start
OUT Y0
|
CALL SLOW 5
END_PROGRAM
SUBROUTINE SLOW
VAR_INPUT WAIT : INT
LD SM0
MOV #WAIT D7
END_SUBROUTINE
"""


def place(typed, model=EC20):
    """The cursor behind what is typed in the place of the bar."""
    text = PROGRAM.replace("|", typed)
    return Place(text, text.index(typed, PROGRAM.index("|")) + len(typed), model)


def offered(typed, model=EC20):
    return [option.text for option in place(typed, model).options()]


def test_a_line_begins_with_an_instruction():
    assert offered("TO")[:3] == ["TON", "TONR", "TOF"]
    assert "END_PROGRAM" in offered("end_")


def test_only_what_the_model_has_is_offered():
    assert "FROM" in offered("FR")  # special modules are the EC20's (6.8.1)
    assert "FROM" not in offered("FR", get_model("EC10"))


def test_an_operand_offers_what_may_stand_there():
    names = offered("LD S")
    assert "Start" in names
    assert "Speed" not in names  # a register is no contact
    assert "Speed" in offered("MOV S")


def test_devices_of_the_program_come_with_their_names():
    options = {option.text: option.about for option in place("LD X").options()}
    assert options == {"X0": "the first one unused, of X0 to X377"}
    assert {option.text: option.about for option in place("LD St").options()} == {"Start": "X5 start button"}


def test_numbers_of_outputs_are_octal():
    text = "LD X0\n" + "".join(f"OUT Y{number:o}\n" for number in range(8)) + "OUT Y"
    options = [option.text for option in Place(text, len(text), EC20).options()]
    assert options[-1] == "Y10"


def test_a_timer_is_offered_where_a_timer_stands():
    assert offered("TON ") == ["T0"]
    assert "T0" not in offered("CTU ")
    assert "C0" in offered("CTU ")


def test_a_call_offers_the_subroutines():
    assert offered("CALL S") == ["SLOW"]


def test_a_subroutine_knows_its_own_variables():
    text = PROGRAM.replace("|", "").replace("END_SUBROUTINE", "MOV #\nEND_SUBROUTINE")
    at = text.index("MOV #\n") + 5
    assert [option.text for option in Place(text, at, EC20).options()] == ["#WAIT"]


@pytest.mark.parametrize("typed", ["LD X0 // T", "/* T", "NOSUCH T"])
def test_nothing_is_offered_in_a_comment_or_behind_an_unknown_word(typed):
    assert offered(typed) == []


def test_the_operands_of_an_instruction_are_told_with_the_one_being_typed():
    told = place("ADD D0 ").signature()
    assert (told["mnemonic"], told["section"], told["at"]) == ("ADD", "6.3.1", 1)
    assert [name for name, _ in told["operands"]] == ["S1", "S2", "D"]
    assert told["operands"][2][1] == "INT, written: KnY KnM KnS KnLM D C T V Z"
    assert place("AD").signature() is None


def test_every_problem_is_marked_at_its_word():
    found = marks("LD X0\n  OUT X9 // wrong\nFOO\n", EC20)
    assert [(mark.line, mark.column, mark.length) for mark in found] == [(2, 7, 2), (3, 1, 3)]
    assert "octal" in found[0].words


def test_a_good_text_has_no_marks():
    assert marks("LD X0\nOUT Y0", EC20) == []


def test_a_program_of_the_fx_family_is_offered_its_own_words():
    model = get_model("H2U")
    text = "LD X0\nCALL P\nFEND\nP10\nLD M8000\nINC D0\nSRET\n"
    assert [option.text for option in Place(text, text.index("CALL P") + 6, model).options()] == ["P10"]
    firsts = {option.text for option in Place("", 0, model).options()}
    assert "PROGRAM" not in firsts
    assert {"LDP", "LDF", "VAR_GLOBAL", "FEND"} <= {
        option.text for word in ("LD", "V", "FE") for option in Place(word, len(word), model).options()
    }
