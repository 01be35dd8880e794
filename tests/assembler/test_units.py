"""Chapters 2.2.3, 4.2 and 4.4: units, their headers and their variables; comments and titles."""

import pytest

from ecsim.devices import Device
from ecsim.values import BOOL, DINT, INT, REAL

from .refusals import accepted, only, refused, with_routine

MAIN = "PROGRAM MAIN\nLD X0\nOUT Y0\nEND_PROGRAM\n"


@pytest.mark.parametrize(
    ("text", "line", "says", "hint"),
    [
        ("SUBROUTINE A\nLD X0\nOUT Y0\nEND_SUBROUTINE", 1, "there is no main program", "PROGRAM MAIN"),
        (MAIN + MAIN.replace("MAIN", "PRESS"), 5, "there is a second main program", "subroutines"),
        (MAIN + "LD X1\nOUT Y1", 5, "an instruction stands outside every unit", "between PROGRAM MAIN and END_PROGRAM"),
        (MAIN + "END_SUBROUTINE", 5, "END_SUBROUTINE ends nothing", "open it with SUBROUTINE NAME first"),
        ("PROGRAM MAIN\nLD X0\nOUT Y0\nEND_SUBROUTINE", 4, "END_SUBROUTINE ends nothing", "SUBROUTINE"),
        (MAIN + "SUBROUTINE A\nSUBROUTINE B\nEND_SUBROUTINE", 6, "SUBROUTINE inside SUBROUTINE A", "END_SUBROUTINE first"),
        (MAIN + "SUBROUTINE\nEND_SUBROUTINE", 5, "SUBROUTINE needs a name", "SBR_1"),
        (MAIN + "SUBROUTINE 1A\nEND_SUBROUTINE", 5, "SUBROUTINE needs a name, found '1A'", "SBR_1"),
        (MAIN + "SUBROUTINE A B\nEND_SUBROUTINE", 5, "'B' is not expected after SUBROUTINE A", ""),
        (MAIN + "SUBROUTINE A\nEND_SUBROUTINE\nSUBROUTINE a\nEND_SUBROUTINE", 7, "the name 'a' stands twice", "line 5"),
        (MAIN + "INTERRUPT A\nEND_INTERRUPT", 5, "INTERRUPT A names no event", "EVENT 26"),
        (MAIN + "INTERRUPT A EVENT x\nEND_INTERRUPT", 5, "EVENT 'x' is no event number", "chapter 9"),
        (MAIN + "INTERRUPT A EVENT 99\nEND_INTERRUPT", 5, "EC20 has no interrupt event 99", ""),
        (
            MAIN + "INTERRUPT A EVENT 26\nEND_INTERRUPT\nINTERRUPT B EVENT 26\nEND_INTERRUPT",
            7,
            "the event 26 has two interrupt programs",
            "A in line 5",
        ),
        (MAIN + "INTERRUPT A EVENT 26\nVAR_INPUT P : INT\nEND_INTERRUPT", 6, "only a subroutine has INPUT variables", ""),
        ("VAR_GLOBAL\nA AT M0\n" + MAIN, 3, "VAR_GLOBAL has no END_VAR", ""),
        ("PROGRAM MAIN\nVAR_GLOBAL\nA AT M0\nEND_VAR\nEND_PROGRAM", 2, "VAR_GLOBAL stands inside another block", "before PROGRAM MAIN"),
        ("VAR_GLOBAL\nA M0\nEND_VAR\n" + MAIN, 2, "'A M0' declares no variable", "NAME AT DEVICE"),
        ("VAR_GLOBAL\nA AT M0\na AT M1\nEND_VAR\n" + MAIN, 3, "the name a is declared twice", "case"),
        ("VAR_GLOBAL\nA AT M2000\nEND_VAR\n" + MAIN, 2, "EC20 has no M2000", ""),
        ("VAR_GLOBAL\nA AT 5\nEND_VAR\n" + MAIN, 2, "A names '5', which is no single device", "X0 or D100"),
        ("VAR_GLOBAL\nA AT K4M0\nEND_VAR\n" + MAIN, 2, "which is no single device", "X0 or D100"),
        ("VAR_GLOBAL\nA AT D0Z0\nEND_VAR\n" + MAIN, 2, "which is no single device", "X0 or D100"),
        ("VAR_GLOBAL\nOUT AT M0\nEND_VAR\n" + MAIN, 2, "'OUT' cannot be a variable's name", "instruction"),
        ("VAR_GLOBAL\nX5 AT M0\nEND_VAR\n" + MAIN, 2, "'X5' cannot be a variable's name", "device"),
        ("VAR_GLOBAL\n5a AT M0\nEND_VAR\n" + MAIN, 2, "'5a' cannot be a variable's name", "letters"),
        ("END_VAR\n" + MAIN, 1, "END_VAR ends nothing", ""),
        ("VAR_INPUT A : INT\n" + MAIN, 1, "VAR_INPUT stands outside a subroutine", "SUBROUTINE NAME"),
        ("LD X0 /* never closed\nOUT Y0", 1, "a comment is not closed", "*/"),
        ("LD X0\nOUT Y0 (* never closed", 2, "a comment is not closed", "*)"),
    ],
)
def test_a_wrong_header_or_declaration_is_told(text, line, says, hint):
    problem = refused(text)[0]
    assert problem.line == line
    assert says in problem.message
    assert hint in problem.hint


@pytest.mark.parametrize(
    ("variables", "body", "line", "column", "says"),
    [
        ("VAR_INPUT A : WORT\n", "", 6, 15, "'WORT' is no data type"),
        ("VAR_INPUT A INT\n", "", 6, 1, "declares no variable"),
        ("VAR_TEMP A : INT\nVAR_TEMP a : INT\n", "", 7, 10, "the variable 'a' is declared twice"),
        ("VAR_TEMP A : INT\n", "LD SM0\nDMOV #A D0", 8, 6, "S = #A is INT"),
        ("VAR_TEMP A : REAL\n", "LD SM0\nDMOV #A D0", 8, 6, "S = #A is REAL"),
        ("VAR_TEMP A : BOOL\n", "LD #B\nOUT Y0", 7, 4, "'#B' is not declared here"),
    ],
)
def test_a_wrong_variable_of_a_subroutine_is_told(variables, body, line, column, says):
    problem = refused(with_routine(body, variables))[0]
    assert (problem.line, problem.column) == (line, column)
    assert says in problem.message


@pytest.mark.parametrize(
    ("variables", "call", "column", "says"),
    [
        ("VAR_INPUT A : INT\n", "CALL SBR_1", 1, "SBR_1 takes 1 operand (A), found 0"),
        ("", "CALL SBR_1 D0", 1, "SBR_1 takes 0 operands (none), found 1"),
        ("", "CALL SBR_2", 6, "there is no subroutine 'SBR_2'"),
        ("VAR_OUTPUT A : INT\n", "CALL SBR_1 5", 12, "the constant '5' cannot be A"),
        ("VAR_OUTPUT A : INT\n", "CALL SBR_1 K4X0", 12, "'K4X0' is read only"),
        ("VAR_OUTPUT A : INT\n", "CALL SBR_1 SD0", 12, "SD0 is read only"),
        ("VAR_IN_OUT A : BOOL\n", "CALL SBR_1 X0", 12, "'X0' is read only"),
        ("VAR_INPUT A : INT\n", "CALL SBR_1 M0", 12, "'M0' cannot be A"),
        ("VAR_INPUT A : INT\n", "CALL SBR_1 C200", 12, "C200 holds 32 bits"),
        ("VAR_INPUT A : DINT\n", "CALL SBR_1 C199", 12, "C199 holds 16 bits"),
        ("VAR_INPUT A : DINT\n", "CALL SBR_1 K4M0", 12, "too narrow"),
        ("VAR_INPUT A : WORD\n", "CALL SBR_1 K5M0", 12, "too wide"),
        ("VAR_INPUT A : DINT\n", "CALL SBR_1 Z0", 12, "'Z0' cannot be A"),
        ("VAR_INPUT A : REAL\n", "CALL SBR_1 C0", 12, "'C0' cannot be A"),
    ],
)  # fmt: skip
def test_a_call_must_fit_the_variables_of_its_subroutine(variables, call, column, says):
    problem = only(with_routine("", variables, main=f"LD SM0\n{call}"))
    assert (problem.line, problem.column, problem.section or "3.3.2") == (3, column, problem.section)
    assert says in problem.message


def test_calls_are_nested_six_deep_and_no_deeper():
    def chain(depth):
        subs = [f"SUBROUTINE S_{n}\nLD X0\nCALL S_{n + 1}\nEND_SUBROUTINE" for n in range(1, depth)]
        return "\n".join(["PROGRAM MAIN\nLD X0\nCALL S_1\nEND_PROGRAM", *subs, f"SUBROUTINE S_{depth}\nLD X0\nOUT Y0\nEND_SUBROUTINE"])

    accepted(chain(6))
    problem = only(chain(7))
    assert (problem.line, problem.message, problem.hint) == (3, "calls are nested 7 deep", "at most 6")


@pytest.mark.parametrize("names", [["A"], ["A", "B"], ["A", "B", "C"]])
def test_subroutines_that_call_themselves_are_refused(names):
    subs = [f"SUBROUTINE {name}\nLD X0\nCALL {names[(n + 1) % len(names)]}\nEND_SUBROUTINE" for n, name in enumerate(names)]
    problem = refused("\n".join(["PROGRAM MAIN\nLD X0\nCALL A\nEND_PROGRAM", *subs]))[0]
    assert "calls itself, directly or through others" in problem.message
    assert problem.section == "4.4.2"


def test_a_circle_of_calls_is_refused_also_where_nobody_calls_into_it():
    text = "PROGRAM MAIN\nEND_PROGRAM\nSUBROUTINE A\nLD X0\nCALL B\nEND_SUBROUTINE\nSUBROUTINE B\nLD X0\nCALL A\nEND_SUBROUTINE"
    assert "calls itself" in refused(text)[0].message


def test_an_interrupt_program_calls_no_subroutine():
    text = "PROGRAM MAIN\nEND_PROGRAM\nINTERRUPT I EVENT 26\nLD X0\nCALL A\nEND_INTERRUPT\nSUBROUTINE A\nEND_SUBROUTINE"
    problem = only(text)
    assert (problem.line, problem.message) == (5, "an interrupt program cannot call a subroutine")


@pytest.mark.parametrize(("kind", "what", "most"), [("BOOL", "bit", 16), ("INT", "word", 16), ("DINT", "word", 16)])
def test_a_subroutine_has_sixteen_bit_and_sixteen_word_variables(kind, what, most):
    def declared(count):
        return "".join(f"VAR_TEMP V_{n} : {kind}\n" for n in range(count))

    accepted(with_routine("", declared(most)))
    problem = only(with_routine("", declared(most + 1)))
    assert (problem.line, problem.message, problem.hint) == (5, f"SBR_1 has 17 {what} variables", "at most 16")


def test_a_program_has_sixty_four_subroutines():
    def many(count):
        return MAIN + "".join(f"SUBROUTINE A_{n}\nEND_SUBROUTINE\n" for n in range(count))

    accepted(many(64))
    assert only(many(65)).message == "65 subroutines"


@pytest.mark.parametrize(("model", "most"), [("EC10", 140), ("EC20", 500)])
def test_a_program_has_as_many_global_variables_as_its_model_allows(model, most):
    def many(count):
        return "VAR_GLOBAL\n" + "".join(f"N_{n} AT D{n}\n" for n in range(count)) + "END_VAR\n" + MAIN

    accepted(many(most), model)
    problem = only(many(most + 1), model)
    assert (problem.line, problem.message, problem.hint) == (2, f"{most + 1} global variables", f"{model} has room for {most}")


def test_variables_lie_one_after_the_other_by_kind():
    """4.4.3: BOOL in LM, all others in V, two registers for 32 bits."""
    variables = "VAR_INPUT A : INT\nVAR_INPUT B : BOOL\nVAR_TEMP C : DINT\nVAR_OUTPUT D : REAL\nVAR_IN_OUT E : BOOL\nVAR_TEMP F : WORD\n"
    unit = accepted(with_routine("", variables, main="LD SM0\nCALL SBR_1 1 X0 D0 M0")).unit("SBR_1")
    assert {name: str(variable.device) for name, variable in unit.variables.items()} == {
        "a": "V0",
        "b": "LM0",
        "c": "V1",
        "d": "V3",
        "e": "LM1",
        "f": "V5",
    }
    assert [variable.type for variable in unit.variables.values()][:4] == [INT, BOOL, DINT, REAL]
    assert [variable.name for variable in unit.parameters] == ["A", "B", "D", "E"]


def test_a_global_name_stands_for_its_device_in_any_case():
    program = accepted(
        "VAR_GLOBAL\n  Start AT X10 // the green button\n  Lauf AT Y7;\nEND_VAR\nPROGRAM MAIN\nLD START\nOUT lauf\nEND_PROGRAM"
    )
    assert [i.operands[0] for i in program.instructions] == [Device("X", 8), Device("Y", 7)]
    assert [i.written for i in program.instructions] == [("START",), ("lauf",)]
    assert program.names() == {"X10": "Start", "Y7": "Lauf"}
    assert program.variables["Start"].comment == "the green button"


def test_names_may_have_letters_of_any_language():
    accepted("VAR_GLOBAL\nFörderband AT Y0\n启动 AT X0\nEND_VAR\nPROGRAM MAIN\nLD 启动\nOUT Förderband\nEND_PROGRAM")


def test_comments_are_kept_where_they_belong():
    program = accepted(
        "// the lamp\n// follows the button\nLD X0 // button\n/* not a title */ OUT Y0 // lamp\n\n(* second *)\nLD X1\nOUT Y1"
    )
    assert [network.title for network in program.main.networks] == ["the lamp\nfollows the button", "second"]
    assert [i.comment for i in program.instructions] == ["button", "lamp", "", ""]


def test_a_comment_may_hold_what_begins_another():
    assert len(accepted("LD X0 // see /* there\nOUT Y0 // and (* here\n// */ *)\nLD X1 /* // */\nOUT Y1").instructions) == 4


def test_a_blank_line_parts_a_title_from_its_rung():
    assert accepted("// about the file\n\n// the rung\nLD X0\nOUT Y0").main.networks[0].title == "the rung"


def test_units_may_stand_in_any_order_and_the_main_program_is_the_first():
    program = accepted("SUBROUTINE A\nLD X0\nOUT Y0\nEND_SUBROUTINE\nPROGRAM Press\nLD X1\nCALL a\nEND_PROGRAM")
    assert [unit.kind for unit in program.units] == ["MAIN", "SUBROUTINE"]
    assert program.main.name == "Press"
    assert [i.position for i in program.instructions] == [0, 1, 2, 3]
