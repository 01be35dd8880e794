"""Programs of H1U and H2U as CSV and as plain lists, there and back."""

from pathlib import Path

import pytest

import ecsim
from ecsim.assembler import assemble
from ecsim.exchange import COLUMNS, read_list, write_csv, write_list

EXERCISES = Path(__file__).parent.parent / "exercises"
PROGRAMS = sorted(EXERCISES.glob("*/solutions/*.h2u.il"))
TEXT = "LD X10\nOUT T0 K100\nMOVP K5 D0Z0\nMC N0 M100\nLD= D0 K3\nOUT Y17\nMCR N0\nLD M8000\nCALL P1\nFEND\nP1\nLD M8000\nDADD D0 K70000 D2\nSRET\nI001\nLDI M0\nINC D9\nIRET\n"


def same(first, second):
    """Whether two programs have the same instructions with the same operands in the same units."""
    spelled = [
        [(unit.kind, unit.event, [(i.name, list(map(str, i.operands))) for i in unit.instructions]) for unit in program.units]
        for program in (first, second)
    ]
    return spelled[0] == spelled[1]


def quoted(*rows):
    return "".join("\t".join(f'"{cell}"' for cell in row) + "\r\n" for row in rows)


@pytest.mark.parametrize("text", [TEXT, *(path.read_text(encoding="utf-8") for path in PROGRAMS)])
def test_csv_and_list_bring_the_program_back(text):
    program = assemble(text, "H2U")
    assert same(assemble(read_list(write_csv(program)), "H2U"), program)
    assert same(assemble(read_list(write_list(program)), "H2U"), program)


def test_a_csv_is_utf_16_with_its_mark_tabs_and_quotes():
    content = write_csv(assemble("// the light\nLD X10 // button\nMOV K5 D0\n", "H2U"), "LAMP")
    assert content[:2] == b"\xff\xfe"
    assert content.decode("utf-16") == quoted(
        ("LAMP",),
        ("PC Type:", "H2U"),
        COLUMNS,
        ("0", "the light", "LD", "X10", "", "", "button"),
        ("1", "", "MOV", "K5", "", "", ""),
        ("", "", "", "D0", "", "", ""),
    )


FOREIGN = quoted(
    ("MAIN",),
    ("PLC Information:", "FX3U/FX3UC"),
    ("Step No.", "Line Statement", "Instruction", "I/O (Device)", "Blank", "PI Statement", "Note"),
    ("0", "start and stop", "", "", "", "", ""),
    ("0", "", "LD", "X000", "", "", ""),
    ("1", "", "OR", "Y007", "", "", "holds"),
    ("2", "", "OUT", "T000", "", "", ""),
    ("", "", "", "K0100", "", "", ""),
    ("5", "", "MOV", "K4M0100", "", "", ""),
    ("", "", "", "D010", "", "", ""),
    ("10", "", "END", "", "", "", ""),
)


@pytest.mark.parametrize("coding", ["utf-16", "utf-16-le", "utf-8", "utf-8-sig"])
def test_what_the_other_tool_writes_is_read(coding):
    text = read_list(FOREIGN.encode(coding))
    assert [" ".join(line.partition("//")[0].split()) for line in text.splitlines()] == [
        "", "LD X0", "OR Y7", "OUT T0 K0100", "MOV K4M100 D10", "END",
    ]  # fmt: skip
    assert "// start and stop" in text
    assert "// holds" in text
    program = assemble(text, "H2U")
    assert program.main.instructions[2].operands[1].value == 100


@pytest.mark.parametrize(
    "text",
    [
        "LD X000\nAND X001\nOUT Y000\nEND",
        "0 LD X000\n1 AND X001\n2 OUT Y000\n3 END\n",
        "   0  LD   X0 ; the start\n   1  AND  X1\n   2  OUT  Y0\n\n   3  END\n",
        "ld x0\nand x1\nout y0\nend",
    ],
)
def test_plain_lists(text):
    assert same(assemble(read_list(text), "H2U"), assemble("LD X0\nAND X1\nOUT Y0\nEND", "H2U"))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "there is no instruction in it"),
        ("LD\tX0\n".encode("utf-16"), "no column Instruction"),
        (quoted(("Step No.", "Instruction", "I/O (Device)"), ("", "", "K5")).encode(), "line 2: the operand K5 belongs to no instruction"),
        (b"\xff\xfe\x00\xd8\x00\x00"[:5], "it is no text"),
        (b"LD X0\n\xff\xff", "it is no text"),
        (b" " * 4_000_001, "too many for a program"),
    ],
)
def test_what_is_no_program_is_refused(content, words):
    with pytest.raises(ecsim.EcsimError, match=words):
        read_list(content)


def test_what_does_not_compile_is_told_with_its_problems():
    with pytest.raises(ecsim.ProgramError, match="TON"):
        read_list("LD X0\nTON T0 5")


def test_a_program_of_ec_is_to_be_translated_first():
    with pytest.raises(ecsim.EcsimError, match="translate it for H2U first"):
        write_csv(assemble("LD X0\nOUT Y0", "EC20"))
