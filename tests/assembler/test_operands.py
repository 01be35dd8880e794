"""Chapter 3 and the operand tables: what may stand where, and what is said about the rest."""

import pytest

from ecsim.devices import Bits, Constant, Device
from ecsim.models import get_model

from .refusals import accepted, only, with_routine

LAST = {
    "EC10": {"X": "X177", "Y": "Y177", "M": "M2047", "S": "S1023", "LM": "LM63", "SM": "SM255", "T": "T255", "C": "C255"},
    "EC20": {"X": "X377", "Y": "Y377", "M": "M1999", "S": "S991", "LM": "LM63", "SM": "SM255", "T": "T255", "C": "C255"},
}
BEYOND = {
    "EC10": {"X": "X200", "Y": "Y200", "M": "M2048", "S": "S1024", "LM": "LM64", "SM": "SM256", "T": "T256", "C": "C256"},
    "EC20": {"X": "X400", "Y": "Y400", "M": "M2000", "S": "S992", "LM": "LM64", "SM": "SM256", "T": "T256", "C": "C256"},
}
WORDS = {"D": 7999, "SD": 255, "V": 63, "Z": 15}
PAIRS = [(model, area) for model in LAST for area in LAST[model]]


@pytest.mark.parametrize(("model", "area"), PAIRS)
def test_every_bit_area_has_the_models_size(model, area):
    accepted(f"LD {LAST[model][area]}\nOUT M0", model)
    problem = only(f"LD {BEYOND[model][area]}\nOUT M0", model)
    assert problem.message == f"{model} has no {BEYOND[model][area]} ({area}0 to {LAST[model][area]})"
    assert (problem.line, problem.column, problem.section) == (1, 4, "3.1")


@pytest.mark.parametrize("model", ["EC10", "EC20"])
@pytest.mark.parametrize(("area", "last"), WORDS.items())
def test_every_register_area_has_the_models_size(model, area, last):
    accepted(f"LD SM0\nMOV {area}{last} D0", model)
    assert only(f"LD SM0\nMOV {area}{last + 1} D0", model).message == f"{model} has no {area}{last + 1} ({area}0 to {area}{last})"


@pytest.mark.parametrize("name", ["X8", "X9", "Y18", "X90"])
def test_inputs_and_outputs_are_numbered_in_octal(name):
    problem = only(f"LD {name}\nOUT M0")
    assert problem.message == f"{name} is no device"
    assert "octal" in problem.hint


@pytest.mark.parametrize(
    ("line", "column", "says", "hint"),
    [
        # which kinds of device a place takes (the operand tables)
        ("OUT X0", 5, "'X0' is read only", "D (BOOL) may be Y, M, S, LM, C, T or SM"),
        ("SET D0", 5, "'D0' cannot be D", "may be Y"),
        ("MOV D0 K4X0", 8, "'K4X0' is read only", "KnY"),
        ("MOV M0 D0", 5, "'M0' cannot be S", "a constant, KnX"),
        ("MOV D0 5", 8, "the constant '5' cannot be D", "KnY"),
        ("ADD D0 D1 SD66", 11, "'SD66' cannot be D", "KnY"),
        ("DADD D0 Z0 D2", 9, "'Z0' cannot be S2", "D"),
        ("DMOV T0 D0", 6, "'T0' cannot be S", "D"),
        ("TON C0 5", 5, "'C0' cannot be D", "T"),
        ("CTU T0 5", 5, "'T0' cannot be D", "C"),
        # special devices (3.1.9, 3.1.10)
        ("OUT SM0", 5, "SM0 is read only", "the system writes it"),
        ("MOV 1 SD20", 7, "SD20 is read only", "the system writes it"),
        ("DMOV 1 SD55", 8, "SD55 is read only", "the system writes it"),
        # counters (3.1.7)
        ("ADD C200 1 D0", 5, "C200 holds 32 bits, S1 (INT) takes 16", "C0 to C199"),
        ("DADD C199 1 D0", 6, "C199 holds 16 bits, S1 (DINT) takes 32", "C200 to C255"),
        ("CTU C200 5", 5, "C200", "C0 to C199"),
        ("DCNT C199 5", 6, "C199 holds 16 bits", "C200"),
        ("DCNT C236 5", 6, "C236", "C200 to C235"),
        # Kn (3.2.1)
        ("MOV K5M0 D0", 5, "'K5M0' is too wide for S (INT)", "K1 to K4"),
        ("DMOV K4M0 D0", 6, "'K4M0' is too narrow for S (DINT)", "K5 to K8"),
        ("MOV K9M0 D0", 5, "K9 is out of range", "K5 to K8"),
        ("MOV K0M0 D0", 5, "K0 is out of range", "K1 to K4"),
        ("MOV K4D0 D1", 5, "Kn groups bit devices", "K4M0"),
        ("MOV K4X372 D0", 5, "'K4X372' reaches beyond X377", "it takes 16 X devices"),
        ("DMOV D7999 D0", 6, "'D7999' reaches beyond D7999", "it takes 2 D devices"),
        # index (3.2.2)
        ("OUT M0Z0", 5, "'M0Z0': D cannot be indexed", "name the device itself"),
        ("TON T0Z0 5", 5, "'T0Z0': D cannot be indexed", "name the device itself"),
        ("MOV D0Z16 D1", 5, "EC20 has no Z16 (Z0 to Z15)", ""),
        ("MOV SD20Z0 D1", 5, "special relays and registers cannot be indexed", ""),
        ("MOV K4SM0Z0 D1", 5, "special relays and registers cannot be indexed", ""),
        # constants (3.3.3)
        ("MOV 65536 D0", 5, "does not fit into 16 bits", "-32768 to 65535"),
        ("MOV -32769 D0", 5, "does not fit into 16 bits", "-32768 to 65535"),
        ("DMOV 4294967296 D0", 6, "does not fit into 32 bits", "-2147483648"),
        ("DMOV -2147483649 D0", 6, "does not fit into 32 bits", "4294967295"),
        ("MOV 16#10000 D0", 5, "does not fit into 16 bits", ""),
        ("MOV 1.5 D0", 5, "S = '1.5' is no whole number", "S is INT"),
        ("RMOV 3.5E+38 D0", 6, "is out of range", "3.402823E+38"),
        ("MOV 8#8 D0", 5, "8 is no number of base 8", "digits 0 to 7"),
        ("MOV 2#12 D0", 5, "12 is no number of base 2", "digits 0 to 1"),
        ("MOV " + "9" * 30 + " D0", 5, "is too long", "32 bits"),
        # words that are nothing
        ("MOV Q0 D0", 5, "'Q0' is neither a device of EC20 nor a declared name", "VAR_GLOBAL"),
        ("MOV #A D0", 5, "'#A' is not declared here", "only subroutines"),
        # the number of operands
        ("MOV D0", 5, "MOV takes 2 operands (S D), found 1", ""),
        ("ADD D0 D1", 8, "ADD takes 3 operands (S1 S2 D), found 2", ""),
        ("INC", 1, "INC takes 1 operand (D), found 0", ""),
        ("NOP D0", 5, "NOP takes 0 operands, found 1", ""),
    ],
)  # fmt: skip
def test_a_word_that_does_not_fit_is_refused(line, column, says, hint):
    problem = only(f"LD X0\n{line}")
    assert (problem.line, problem.column) == (2, column)
    assert says in problem.message
    assert hint in problem.hint
    assert problem.section or "neither" in says


@pytest.mark.parametrize(
    "line",
    [
        "MOV 65535 D0", "MOV -32768 D0", "DMOV 4294967295 D0", "DMOV -2147483648 D0", "RMOV -3.402823E+38 D0", "RMOV 1 D0", "RMOV 5. D0", "RMOV .5 D0",
        "MOV K4X360 D0", "MOV K1X374 K1Y374", "DMOV K8M1968 D7998", "MOV D7999Z15 V63Z0", "DMOV C255 C200", "ADD C199 T255 C0", "MOV 8#7173 Z0",
        "MOV SD255 SD66", "OUT SM80", "ZRST M0Z0 D0", "TON T255 D0Z0", "CTU C199 -5", "DCNT C235 C200", "ADD D0 D1 D0", "MOV 16#fFfF D0", "mov +5 d0",
    ],
)  # fmt: skip
def test_what_the_tables_allow_is_accepted(line):
    accepted(f"LD X0\n{line}")


@pytest.mark.parametrize(
    ("written", "operand"),
    [
        ("100", Constant(100, "100")),
        ("-5", Constant(-5, "-5")),
        ("16#1FE9", Constant(0x1FE9, "16#1FE9", unsigned=True)),
        ("8#7173", Constant(0o7173, "8#7173", unsigned=True)),
        ("2#1011", Constant(11, "2#1011", unsigned=True)),
        ("D7", Device("D", 7)),
        ("d7z3", Device("D", 7, 3)),
        ("K4M16", Bits(4, "M", 16)),
        ("k2x10", Bits(2, "X", 8)),
        ("K1Y7Z2", Bits(1, "Y", 7, 2)),
    ],
)
def test_an_operand_means_what_it_spells(written, operand):
    assert accepted(f"LD X0\nMOV {written} D0").instructions[1].operands[0] == operand


@pytest.mark.parametrize(
    ("device", "text"), [(Device("X", 8), "X10"), (Device("Y", 255, 3), "Y377Z3"), (Device("D", 10), "D10"), (Bits(4, "X", 8), "K4X10")]
)
def test_a_device_is_told_as_the_manual_writes_it(device, text):
    assert str(device) == text
    assert get_model("EC20").syntax.parse(text) == device


def test_instructions_of_the_other_model_are_told_as_such():
    problem = only("LD X0\nITA D0 D10 4", "EC20")
    assert (problem.line, problem.column) == (2, 1)
    assert problem.message == "EC20 has no ITA"
    assert problem.hint == "ITA exists on EC10"
    accepted("LD X0\nITA D0 D10 4", "EC10")


def test_a_mistyped_instruction_gets_the_one_that_was_meant():
    problem = only("LD X0\nMOVE 1 D0")
    assert problem.message == "'MOVE' is no instruction"
    assert "MOV" in problem.hint


# -- the length of instructions -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("model", "text", "steps"),
    [
        ("EC20", "LD X0\nOUT Y0", [1, 1]),
        ("EC20", "LD X0\nEU\nADD D0 1 D0", [1, 2, 7]),
        ("EC20", "LDD= D0 1\nDMOV D0 D2", [7, 7]),
        ("EC20", "LD M1536\nOUT M1536", [1, 1]),
        ("EC10", "LD M1535\nAND M1536\nORI M2047\nOUT M1536", [1, 2, 2, 1]),  # 5.1.1: a step more from M1536 on
        ("EC20", "LD X0\nSET S20\nSTL S20\nLD X1\nSET S21\nOUT Y0\nSTL S21\nOUT S0\nRET", [1, 1, 3, 1, 3, 1, 3, 3, 1]),  # 5.3.2, 5.3.3
    ],
)
def test_instructions_have_the_lengths_of_the_manual(model, text, steps):
    program = accepted(text, model)
    assert [instruction.steps for instruction in program.instructions] == steps
    assert [instruction.step for instruction in program.instructions] == [sum(steps[:n]) for n in range(len(steps))]
    assert program.steps == sum(steps)


def test_a_call_is_as_long_as_its_operands_make_it():
    program = accepted(with_routine("LD SM0\nMOV #A #B", "VAR_INPUT A : INT\nVAR_OUTPUT B : INT\n", main="LD SM0\nCALL SBR_1 1 D0"))
    assert [i.steps for i in program.instructions] == [1, 3 + 3, 1, 5]
