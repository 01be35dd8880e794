"""The text of the FX family: read, printed and refused; its other rules are cases in tests/conformance/h2u-*.json."""

import pytest

import ecsim
from ecsim.assembler import assemble
from ecsim.assembler.printer import print_program

WHOLE = """\
VAR_GLOBAL
  Start AT X0           // the button
END_VAR

// begin
LD    Start
CALL  P10
LD    X1
CJ    P20
LD    X2
MC    N0 M100
LD    M8000
OUT   T0 K100
MCR   N0
FEND
P20                     // the second part
LD    X3
OUT   Y3
FEND

P10                     // fill
LD    M8000
DMOVP K30V0 D10
SRET

P11
LD    X4
CJ    P12
LD    M8000
INC   D0
P12
LD    M8000
INC   D1
SRET
END
"""


def found(text, model="H2U"):
    """The problems of a program as (line, message, hint, section)."""
    with pytest.raises(ecsim.ProgramError) as refused:
        assemble(text, model)
    return [(problem.line, problem.message, problem.hint, problem.section) for problem in refused.value.problems]


def test_what_is_printed_reads_as_the_same_program():
    program = assemble(WHOLE, "H2U")
    text = print_program(program)
    assert text == WHOLE
    again = assemble(text, "H2U")
    assert [(unit.kind, unit.name, [str(i) for i in unit.instructions]) for unit in again.units] == [
        (unit.kind, unit.name, [str(i) for i in unit.instructions]) for unit in program.units
    ]


def test_units_by_their_pointers():
    program = assemble(WHOLE, "H2U")
    assert [(unit.kind, unit.name) for unit in program.units] == [("MAIN", "MAIN"), ("SUBROUTINE", "P10"), ("SUBROUTINE", "P11")]
    assert [str(i) for i in program.main.instructions][-4:] == ["P20", "LD X3", "OUT Y3", "FEND"]
    assert program.main.instructions[-4].operands[0].value == 20


def test_several_files_go_on_from_one_another():
    program = assemble({"main.il": "LD X0\nCALL P1\nFEND\n", "fill.il": "P1\nLD M8000\nINC D0\nSRET\nEND\n"}, "H2U")
    assert [unit.name for unit in program.units] == ["MAIN", "P1"]


def test_comments_behind_a_semicolon_and_numbers_with_zeros():
    program = assemble(";==== pump\nLD X000 ; the button\nOUT Y010 // the pump\nMOV H0A D007", "H2U")
    assert print_program(program) == (
        "// ==== pump\nLD    X0                // the button\nOUT   Y10               // the pump\nMOV   H0A D7\n"
    )


def test_an_empty_program_and_one_that_only_ends():
    assert assemble("", "H2U").steps == 0
    assert [str(i) for i in assemble("END", "H2U").instructions] == ["END"]


@pytest.mark.parametrize(
    ("text", "line", "message", "hint"),
    [
        ("PROGRAM MAIN\nEND", 1, "PROGRAM does not stand in a program of this family", "a subroutine begins with its label"),
        ("LD X0\nOUT Y0\nEND\nLD X1\nOUT Y1", 4, "'LD' stands behind END", "END is the last line"),
        ("LD X0\nOUT Y0\nFEND\nLD X1\nOUT Y1", 4, "'LD' stands behind FEND outside every subroutine", "begin with a label"),
        ("FEND\nP1\nLD X0\nOUT Y0", 2, "P1 has no end", "SRET (a subroutine) or FEND"),
        ("FEND\nI101\nLD X0\nOUT Y0", 2, "I101 has no end", "write IRET as its last line"),
        ("LD X0\nOUT Y0\nIRET", 3, "IRET stands in the main program", "it ends an interrupt program, I101, behind FEND"),
        ("FEND\nP1\nLD X0\nOUT Y0\nIRET", 5, "IRET stands in P1", "it ends an interrupt program"),
        ("P3\nLD X0\nOUT Y0\nP3", 4, "P3 stands twice", "it stands in line 1 already"),
        ("LD X0\nOUT Y0\nP63", 3, "P63 stands for END and is no label", "take another number"),
        ("LD X0\nCALL P7\nEND", 2, "there is no subroutine 'P7'", "begin it with its label behind FEND, SRET ends it"),
        ("LD X0\nCJ 5\nEND", 2, "'5' is neither a device of H2U nor a declared name", "constants are written K5 here"),
        ("LD X0\nCJ K5\nEND", 2, "'K5' cannot be S", "S is a pointer, P0"),
        ("LD X0\nMOV P5 D0", 2, "'P5' cannot be S", "S is a constant, KnX, KnY, KnM, KnS, D, C, T, V or Z"),
        ("LD X0\nMC P0 M5\nMCR N0", 2, "'P0' cannot be N", "N is a pointer, N0"),
        ("LD X0\nMC N0 M5\nLD X1\nOUT Y0", 2, "MC N0 M5 has no MCR", "close it with MCR N0"),
        ("LD X0\nMC N1 M5\nLD X1\nMC N0 M6\nMCR N0\nMCR N1", 4, "MC N0 M6 stands inside MC N1 M5", "levels go up from N0 on"),
        ("OUT Y0", 1, "OUT Y0 has no power flow", "begin the rung with a contact, for example LD M8000"),
        ("LD X0\nMOV D0 X5", 2, "'X5' is read only", "D (INT) may be KnY, KnM, KnS, D, C, T, V or Z"),
        ("LD X0\nMOV K5 D8013", 2, "D8013 is read only", "TWR sets the clock"),
        ("LD X0\nMOV K5 D8010", 2, "D8010 is read only", "the system writes it"),
        ("LD X0\nOUT T0 C0", 2, "'C0' cannot be S", "S (INT) may be a constant or D"),
        ("LD X0\nOUT T250 X0", 2, "'X0' cannot be S", "S (INT) may be a constant or D"),
        ("LD X0\nOUT X0", 2, "'X0' is read only", "D (BOOL) may be Y, M, S, C or T"),
        ("LD X0\nDHSCS K3 C235 P1", 2, "the pointer 'P1' cannot be D", "D (BOOL) may be Y, M, S or a pointer, I1"),
        ("LD X0\nPRUN K2X0 K2Y0", 2, "'K2Y0' cannot be D", "D (WORD) may be KnM"),
        ("LD X0\nZRST C199 C200", 2, "D1 = C199 and D2 = C200 are not of one kind", ""),
        ("FEND\nI610\nLD X0\nINC D0\nIRET\nI620\nLD X0\nINC D0\nIRET", 6, "I620 and I610 belong to one timer", "I610 in line 2 has it"),
    ],
)
def test_what_is_refused_says_what_helps(text, line, message, hint):
    told = [problem for problem in found(text) if problem[0] == line and problem[1].startswith(message)]
    assert told, found(text)
    assert told[0][2].startswith(hint) or hint in told[0][2], told


def test_each_timer_has_a_routine_of_its_own():
    routines = "".join(f"I{timer}10\nLD M8000\nINC D{timer}\nIRET\n" for timer in (6, 7, 8))
    assert [unit.event for unit in assemble(f"FEND\n{routines}", "H2U").units] == [None, 610, 710, 810]


@pytest.mark.parametrize("text", ["FEND\nP1\nSRET\nP1\nSRET", "FEND\nI610\nIRET\nI610\nIRET", "FEND\nI1\nIRET\nI001\nIRET"])
def test_a_label_that_stands_twice_is_told_once(text):
    assert [problem[1].split()[1:] for problem in found(text)] == [["stands", "twice"]]


@pytest.mark.parametrize(
    ("model", "line", "hint"),
    [
        ("H2U", "LD SM0", "write M8000 (running)"),
        ("H2U", "LD SM181", "write M8022 (carry)"),
        ("H2U", "TON T0 K5", "write OUT T0 K100"),
        ("H2U", "EU", "write LDP, ANDP or ORP"),
        ("H2U", "RADD D0 D2 D4", "write DEADD"),
        ("H2U", "LN D0 D2", "LN exists on EC10 and EC20"),
        ("H1U", "SMOV D0 K1 K2 D1 K3", "SMOV exists on H2U"),
        ("EC20", "LD M8000", "write SM0 (running)"),
        ("EC20", "LDP X0", "write LD and EU behind the contacts"),
        ("EC20", "CMP D0 D1 M0", "CMP exists on H1U and H2U"),
        ("EC20", "MOVP 1 D0", "MOVP exists on H1U and H2U"),
    ],
)
def test_words_of_the_other_family_are_answered_with_this_one_s(model, line, hint):
    assert any(problem[2].startswith(hint) for problem in found(f"LD X0\n{line}\nOUT Y0", model)), found(f"LD X0\n{line}\nOUT Y0", model)


def test_messages_name_sections_of_their_own_manual():
    (problem,) = found("LD X0\nMOV K1 K2")
    assert problem[3] in ("FNC 12", "3.3")
    (problem,) = found("LD X0\nOUT T0 D9000")
    assert problem[3] == "3"
    (problem,) = found("LD X0\nCJ P5")
    assert problem[3] == "FNC 00"
    (problem,) = found("LD M8002\nSET S0\nSTL S0\nOUT Y0")
    assert problem[3] == "4.1.1"
