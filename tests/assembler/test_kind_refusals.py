"""What a newcomer writes wrong, and that the refusal says what to write instead."""

import pytest

import ecsim


def problems(text: str, model: str = "EC20") -> list:
    with pytest.raises(ecsim.ProgramError) as refused:
        ecsim.compile(text, model)
    return refused.value.problems


def routine(declaration: str, call: str, body: str = "LD SM0\nINC D9") -> str:
    return f"PROGRAM MAIN\nLD X0\nCALL {call}\nEND_PROGRAM\nSUBROUTINE S1\n{declaration}\n{body}\nEND_SUBROUTINE"


@pytest.mark.parametrize(
    ("text", "place", "hint"),
    [
        ("LD X0\nTON T0 K10", (2, 8), "constants are written 10 here"),
        ("LD X0\nMOV H1F D0", (2, 5), "constants are written 16#1F here"),
        ("LD X0;\nOUT Y0", (1, 4), "write X0"),
        ("LD (X0)\nOUT Y0", (1, 4), "write X0"),
        ("VAR_GLOBAL\nMotor AT Y0\nEND_VAR\nLD X0\nOUT Moter", (5, 5), "did you mean Motor?"),
        ("LD X0\nOUT Lamp", (2, 5), "declare it between VAR_GLOBAL and END_VAR: NAME AT DEVICE"),
    ],
)
def test_a_word_that_means_nothing_gets_the_word_that_would(text, place, hint):
    [problem] = problems(text)
    assert ((problem.line, problem.column), problem.hint) == (place, hint)


@pytest.mark.parametrize(
    ("declaration", "says"),
    [
        ("A AT V0", "A names V0, which belongs to one program unit only"),  # 3.1.2, note 5
        ("A AT LM3", "A names LM3, which belongs to one program unit only"),
        ("REAL AT D0", "'REAL' cannot be a variable's name"),  # 2.2.3
    ],
)
def test_what_cannot_be_a_global_variable_is_refused(declaration, says):
    [problem] = problems(f"VAR_GLOBAL\n{declaration}\nEND_VAR\nLD X0\nOUT Y0")
    assert problem.message.startswith(says)
    assert problem.line == 2


@pytest.mark.parametrize("name", ["X0", "1a", "K4M0", "DINT", "MOV"])
def test_a_subroutines_variable_has_a_name_like_any_other(name):
    first = problems(routine(f"VAR_TEMP {name} : INT", "S1"))[0]
    assert (first.line, first.column) == (6, 10)
    assert first.message == f"{name!r} cannot be a variable's name"


def test_a_wrong_operand_of_a_call_is_named_as_the_subroutine_names_it():
    [problem] = problems(routine("VAR_INPUT Speed : INT", "S1 M0"))
    assert problem.message == "'M0' cannot be Speed"
    assert problem.hint.startswith("Speed (INT) may be")


def test_a_call_without_a_name_says_so():
    [problem] = problems("LD X0\nCALL")
    assert problem.message == "CALL names no subroutine"


def test_variables_may_stand_in_a_block_as_other_languages_have_them():
    block = "VAR_INPUT\n  A : INT  // first\n  B : DINT;\nEND_VAR\nVAR_OUTPUT C : INT"
    lines = "VAR_INPUT A : INT\nVAR_INPUT B : DINT\nVAR_OUTPUT C : INT"
    as_block, as_lines = (ecsim.compile(routine(text, "S1 D0 D1 D3")).unit("S1") for text in (block, lines))
    assert [(v.name, v.role, v.type, v.device) for v in as_block.variables.values()] == [
        (v.name, v.role, v.type, v.device) for v in as_lines.variables.values()
    ]


def test_a_block_of_variables_without_an_end_is_told():
    first = problems(routine("VAR_INPUT\nA : INT", "S1 D0"))[0]
    assert (first.line, first.hint) == (8, "end the variables with END_VAR, or write VAR_INPUT NAME : INT, for example")


def test_a_unit_without_an_end_is_named_by_its_header():
    [problem] = problems("PROGRAM MAIN\nLD X0\nOUT Y0")
    assert problem.message == "PROGRAM MAIN has no end"
