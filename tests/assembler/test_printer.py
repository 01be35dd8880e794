"""A program printed as text: its form, and that it comes back as the same program."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ecsim.assembler import assemble
from ecsim.assembler.printer import print_instructions, print_program, print_unit


def test_a_program_alone_needs_no_headers():
    text = "// Start and hold\nLD    X0\nOUT   Y0\n\n// second\nLDI   X1\nOUT   Y1                // lamp\n"
    assert print_program(assemble("// Start and hold\nLD X0\nOUT Y0\n// second\nLDI X1\nOUT Y1 //lamp", "EC20")) == text


def test_units_variables_titles_and_comments_are_kept():
    text = """\
VAR_GLOBAL
  Start AT X0           // start button
  Motor AT Y0
END_VAR

PROGRAM MAIN
// Start and hold
// until stopped
LD    Start             // green
OR    Motor
OUT   Motor

// the sum
LD    M0
CALL  SBR_1 3 2 D0
END_PROGRAM

SUBROUTINE SBR_1
VAR_INPUT IN1 : INT
VAR_INPUT IN2 : INT     // the other
VAR_OUTPUT OUT1 : INT
LD    SM0
ADD   #IN1 #IN2 #OUT1
END_SUBROUTINE

INTERRUPT INT_1 EVENT 26
LD    SM0
INC   D0
END_INTERRUPT
"""
    assert print_program(assemble(text, "EC20")) == text


def test_a_step_begins_after_a_blank_line():
    text = "STL   S0\nLD    X0\nSET   S20\n\nSTL   S20\nOUT   Y0\nRET\n"
    assert print_program(assemble(text, "EC20")) == text


def test_a_unit_is_printed_alone():
    program = assemble("PROGRAM MAIN\nLD SM0\nCALL ONE\nEND_PROGRAM\nSUBROUTINE ONE\nLD SM0\nINC D0\nEND_SUBROUTINE", "EC20")
    assert print_unit(program.unit("one")) == "SUBROUTINE ONE\nLD    SM0\nINC   D0\nEND_SUBROUTINE\n"


def test_nothing_is_printed_as_nothing():
    assert print_program(assemble("", "EC20")) == ""
    assert print_instructions([]) == ""


def test_a_main_program_of_another_name_keeps_it():
    printed = print_program(assemble("PROGRAM Line\nLD X0\nOUT Y0\nEND_PROGRAM", "EC20"))
    assert assemble(printed, "EC20").main.name == "Line"


LINES = st.text(st.characters(blacklist_characters="\n\r", blacklist_categories=["Cs"]), max_size=20)


@settings(max_examples=200)
@given(st.lists(LINES, max_size=3), LINES)
def test_any_comment_and_title_come_back(title, comment):
    head = "\n".join(f"// {line}" for line in title)
    program = assemble(f"{head}\nLD X0 // {comment}\nOUT Y0\n", "EC20")
    again = assemble(print_program(program), "EC20")
    assert again.main.titles == program.main.titles
    assert [i.comment for i in again.instructions] == [i.comment for i in program.instructions] == [comment.strip(), ""]


@pytest.mark.parametrize("written", ["d5z1", "k4m0", "16#ff", "+7", "x17"])
def test_operands_stay_as_they_were_written(written):
    code = f"LD= {written} 1" if written != "x17" else "LD x17"
    assert written in print_program(assemble(f"{code}\nOUT Y0", "EC20"))
