"""What is offered while a program is typed, and how its problems are marked."""

import re

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


H2U = get_model("H2U")


def typed_in_fx(line, model=H2U):
    """The cursor behind a line in the middle of a program of the FX family."""
    before = "VAR_GLOBAL\n  Speed AT D100\nEND_VAR\nLD M8000\n"
    behind = "\nLD X1\nMC N0 M100\nMCR N0\nP5\nFEND\nP10\nLD M8000\nINC D0\nSRET\nI101\nINC D1\nIRET\n"
    return Place(before + line + behind, len(before + line), model)


def offered_in_fx(line, model=H2U):
    return [option.text for option in typed_in_fx(line, model).options()]


@pytest.mark.parametrize(
    ("line", "section"),
    [
        ("CML ", "FNC 14"),
        ("DMOV ", "FNC 12"),
        ("MOVP ", "FNC 12"),
        ("DEADD ", "FNC 120"),
        ("EI ", "FNC 04"),
        ("LD ", "4.1"),
        ("STL ", "4.1.1"),
        ("OUT T0 ", "4.1"),
    ],
)
def test_a_program_of_the_fx_family_is_told_where_its_own_manual_has_an_instruction(line, section):
    assert typed_in_fx(line).signature()["section"] == section


def test_titles_name_the_operands_of_the_family_and_no_places_of_the_other_manual():
    assert typed_in_fx("PLSR ").signature()["title"].startswith("Put out S2 pulses on D with up to S1 Hz")  # EC: on D from S1, S2, S3
    options = [option for start in "ABCDEFHILMNOPRSTWXZ" for option in typed_in_fx(start).options()]
    assert {"SET", "OUT", "MOV", "MOVP", "DSW"} <= {option.text for option in options}
    assert not [option for option in options if "(5." in option.about or "(6." in option.about or "SM" in option.about]
    assert "(5.3.3)" in next(option.about for option in place("OU").options() if option.text == "OUT")


def test_areas_that_the_family_lacks_are_not_told():
    told = dict(typed_in_fx("DMOV ").signature()["operands"])
    assert told["S"] == "DINT: constant KnX KnY KnM KnS D C Z"  # facts of the family: no LM, SM, SD; Z stands for V and Z together
    assert dict(typed_in_fx("LD ").signature()["operands"]) == {"S": "BOOL: X Y M S C T"}


def test_the_first_operand_decides_what_is_told_of_the_second():
    timer, counter = typed_in_fx("OUT T0 ").signature(), typed_in_fx("OUT C200 ").signature()
    assert [name for name, _ in timer["operands"]] == ["D", "S"]
    assert timer["title"].startswith("On-delay")
    assert counter["operands"][0][1] == "DINT, written, 200 to 234: C"
    assert dict(typed_in_fx("DECO X0 ").signature()["operands"])["S"] == "BOOL: X Y M S"
    assert dict(typed_in_fx("DECO Speed ").signature()["operands"])["S"].startswith("WORD")


def test_what_an_instruction_may_be_is_told_before_its_first_operand():
    assert typed_in_fx("RST ").signature()["operands"] == [["D", "BOOL, written: Y M S C T or INT, written: D V Z"]]
    assert typed_in_fx("SET ").signature()["operands"] == [["D", "BOOL, written: Y M S"]]
    assert "T0" not in offered_in_fx("SET T")
    assert {"T0", "C0", "Y0"} <= set(offered_in_fx("OUT "))
    assert "D2" in offered_in_fx("OUT T0 D")
    assert "Speed" in offered_in_fx("RST S")


def test_only_devices_that_the_instruction_takes_are_offered():
    assert [name for name in offered_in_fx("DMOV C") if name[1:].isdigit()] == ["C200"]  # C0 to C199 hold 16 bits
    assert offered_in_fx("DHSCS K5 C") == ["C235"]
    assert offered("DCNT ") == ["C200"]
    assert offered("HCNT ") == ["C236"]


def test_forms_with_the_pulse_suffix_are_offered_and_known():
    assert {"MOV", "MOVP"} <= set(offered_in_fx("MO"))
    assert typed_in_fx("DADDP D0 ").signature()["at"] == 1
    assert offered_in_fx("CALLP P") == ["P10"]
    assert "SMOVP" in offered_in_fx("SMO")
    assert offered_in_fx("SMO", get_model("H1U")) == []


def test_pointers_are_offered_where_they_stand():
    assert offered_in_fx("CJ ") == ["P5", "P10"]
    assert offered_in_fx("MC ") == ["N0"]
    assert "I101" in offered_in_fx("DHSCS K5 C235 ")
    assert offered_in_fx("CALL P10 ") == []  # subroutines of the family have no variables
    assert dict(typed_in_fx("CJ ").signature()["operands"]) == {"S": "INT, P0 to P127: pointer"}
    assert "P" not in offered_in_fx("p")


def test_a_semicolon_begins_a_comment_in_the_fx_family():
    assert offered_in_fx("LD X0 ; T") == []
    assert typed_in_fx("OUT T0 ; K").signature() is None
    found = marks("MOV D0 ; only one\n", H2U)
    assert [(mark.line, mark.section) for mark in found] == [(1, "FNC 12")]
    assert found[0].column + found[0].length - 1 <= len("MOV D0")


def typed_names(start, model):
    return [option.text for option in Place(start, len(start), model).options() if option.kind == "op"]


def completed(name, model, last):
    """A line with what is offered for each operand, the first or the last of it."""
    line = f"{name} "
    for _ in range(8):
        at = Place(line, len(line), model)
        told = at.signature()
        assert told["mnemonic"] == name
        if told["at"] == len(told["operands"]):
            break
        use = told["operands"][told["at"]][1]
        assert use.partition(": ")[2], told
        pointer = re.search(r"\b[PN]0\b", use)
        bits = re.search(r": Kn([A-Z])", use)
        options = [option.text for option in at.options() if option.kind == "device"]
        typed = pointer[0] if pointer else f"K1{bits[1]}0" if bits else "K1" if model is H2U else "1"
        line += f"{options[-last] if options else typed} "
    return line


@pytest.mark.parametrize("last", [0, 1], ids=["first", "last"])
@pytest.mark.parametrize("model", [EC20, H2U], ids=["EC20", "H2U"])
def test_what_is_offered_for_each_operand_of_each_instruction_is_taken(model, last):
    names = {name for first in "ABCDEFGHILMNOPRSTUVWXZ" for name in typed_names(first, model)}
    assert len(names) > 200
    for name in names - {"CALL", "CALLP"}:
        line = completed(name, model, last)
        refused = [mark.words for mark in marks(f"LD X0\n{line}", model) if mark.line == 2]
        wrong = re.compile(r"cannot be \w+;|is neither|: use C|takes \d+ operand|bits, \w+ \(|is read only")
        assert not [words for words in refused if wrong.search(words)], (line, refused)
