"""The lessons' own checks: what they say to the program that stands there, and to one that does what is asked."""

import re
from pathlib import Path

import matplotlib
import nbformat
import pytest

matplotlib.use("Agg")

NOTEBOOKS = Path(__file__).resolve().parent.parent / "notebooks"


def lines(instructions):
    """A program from its instructions in one line."""
    return instructions.replace("; ", "\n")


ANSWERS = {
    "02-scan-cycle": (
        "horn",
        "LD X0\nOUT M0\nLD M0\nOUT M1\nLD M1\nOUT Y0",
        "Not yet: Y0 becomes 1 in scan 3 after X0",
        "Right: the horn answers in the same scan",
    ),
    "03-devices-and-addressing": (
        "recipe",
        "LD SM1\nMOV 180 D100\nMOV 195 D101\nMOV 210 D102\nMOV 160 D103\nLD SM0\nMOV D0 Z0\nMOV D100Z0 D10",
        "Not yet: recipe 1 is 195 degrees, D10 shows 180",
        "Right: D10 shows the temperature of the recipe",
    ),
    "04-contacts-and-coils": (
        "lamp",
        "LD X0\nEU\nOUT M0\nLD M0\nANI Y0\nLDI M0\nAND Y0\nORB\nOUT Y0",
        "Not yet: in press 1 the lamp should be on, after 2 scans it is not",
        "Right: each press turns the lamp over, once",
    ),
    "05-timers": (
        "stairs",
        "LD X0\nTOF T0 50\nLD T0\nOUT Y0",
        "Not yet: the light does not come on with the press",
        "Right: on with the press, off five seconds after it",
    ),
    "06-counters": (
        "packer",
        "LD X0\nCTR C0 6\nLD C0\nTMON T0 5\nLD T0\nOUT Y0",
        "Not yet: after 12 bottles the pusher has worked 1 times",
        "Right: half a second after each sixth bottle",
    ),
    "07-data": (
        "percent",
        "LD SM0\nMUL D0 100 D2\nDDIV D2 20000 D4\nMOV D5 D10",
        "Not yet: 100 kg are 5 percent, D10 shows -1",
        "Right: D10 shows the percentage over the whole range",
    ),
    "08-flow-and-subroutines": (
        "hot",
        "LD SM0\nMOV 0 Z0\nMOV 0 D10\nLD SM0\nFOR 20\nLD> D100Z0 80\nINC D10\nLD SM0\nINC Z0\nNEXT",
        "Not yet: above 80 are D100; D10 shows 3",
        "Right: D10 counts them all, anew in each scan",
    ),
    "09-sequence": (
        "drill",
        lines(
            "LD SM1; SET S0; STL S0; LD X0; SET S20; STL S20; SET Y0; LD X1; SET S21; STL S21; OUT Y1; LD X2; SET S22; STL S22; OUT Y2; LD X3; RST Y0; OUT S0; RET"
        ),
        "Not yet: in turn 1 the clamp is open while Y1 is ON",
        "Right: the clamp holds until the drill is up again",
    ),
    "10-selection": (
        "sorter",
        lines(
            "LD SM1; SET S0; STL S0; LD X0; AND< D0 50; SET S20; LD X0; AND>= D0 50; AND< D0 100; SET S21; LD X0; AND>= D0 100; SET S22; STL S20; OUT Y0; LDI X0; OUT S0; STL S21; OUT Y1; LDI X0; OUT S0; STL S22; OUT Y2; LDI X0; OUT S0; RET"
        ),
        "Not yet: at 50 g nothing is ON, it should be Y1 alone",
        "Right: one chute for every weight",
    ),
    "11-parallel": (
        "pair",
        lines(
            "LD SM1; SET S0; STL S0; LD X0; SET S20; SET S30; STL S20; OUT Y0; LD X1; SET S21; STL S21; LD SM0; NOP; STL S30; OUT Y1; LD X2; SET S31; STL S31; LD SM0; NOP; STL S21; STL S31; LD SM0; SET S40; STL S40; OUT Y2; LDI X0; OUT S0; RET"
        ),
        "Not yet: the lamp is ON with X1 alone, X2 has not come",
        "Right: the lamp waits for both, and nothing is left behind",
    ),
    "12-high-speed-counters": (
        "filler",
        "LD SM1\nSET Y10\nLD SM0\nHCNT C236 1000\nDHSCR 330 C236 Y10",
        "Not yet: the valve closes at 360 ml",
        "Right: the valve closes at 330 ml",
    ),
    "13-interrupts": (
        "gate",
        "PROGRAM MAIN\nLD SM1\nSET SM42\nEI\nEND_PROGRAM\nINTERRUPT LEAVES EVENT 12\nLD SM0\nSET Y10\nEND_INTERRUPT",
        "Not yet: the gate closes 7.7 ms late",
        "Right: the gate closes in the moment of the edge",
    ),
    "14-positioning": (
        "job",
        "LD SM1\nMOV 500 SD84\nDMOV 20000 SD85\nMOV 200 SD87\nLD SM0\nDRVA 25000 20000 Y0 Y4",
        "Not yet: the table stands at 25.0 mm",
        "Right: the table stands at 250 mm in time",
    ),
    "16-modbus-network": (
        "request",
        [2, 6, 0, 10, 0xFF, 0x38],
        "Not yet: D10 of the rooms is 0, 0, 0",
        "Right: room 2 is to have -20.0 degrees",
    ),
    "17-ecbus": (
        "programs",
        {1: "LD SM0\nMOV D20 D7710", 3: "LD SM0\nMOV D7710 D30"},  # any of station 1's registers
        "Not yet: D20 of station 1 is 321, D30 of station 3 is 0",
        "Right: what station 1 has in D20, station 3 has in D30",
    ),
    "18-inverter": (
        "orders",
        "LD M0\nEVFRQ 1 1 25\nLD SM135\nAND M0\nEVREV 1 1",
        "Not yet: the drive is stopped, at 0 Hz, and is set to 25 Hz",
        "Right: 25 Hz in reverse",
    ),
    "19-supervisory": (
        "question",
        (10, 21),
        "Not yet: starts is not in registers 10 to 20",
        "Right: one request for all three",
    ),
    "20-sfc-mistakes": (
        "drive",
        lines(
            "LD SM1; SET S5; STL S5; OUT Y0; LD X1; SET S20; STL S20; TON T0 3; LD T0; SET S33; "
            "STL S33; OUT Y1; LD X0; SET S34; STL S34; TON T1 3; LD T1; OUT S5; RET"
        ),
        "Not yet: Y0 and Y1 are ON together for 10 ms",
        "Right: never together, and 0.3 s between them",
    ),
    "21-analog-and-pid": (
        "settings",
        (400, 600),
        "Not yet: it reaches 215 degrees",
        "Right: warm in time, and never too hot",
    ),
    "22-testing-in-ci": (
        "steps",
        [
            {"set": {"X0": 1, "X1": 1}, "scans": 1, "expect": {"Y0": 1}},
            {"set": {"X0": 0}, "scans": 1, "expect": {"Y0": 1}},
            {"set": {"X1": 0}, "scans": 1, "expect": {"Y0": 0}},
        ],
        "Not yet: nobody notices that the motor does not hold itself",
        "Right: all three are found",
    ),
    "23-another-plc": (
        "answer",
        "LDP X0\nINC D0\nLD>= D0 K4\nOUT Y0\nLD Y0\nOUT T0 K20\nLD Y0\nANI T0\nOUT Y1\nLD X1\nRST D0",
        "Not yet: at pallet 4 of lorry 1 the horn Y1 is 0, on EC20 it is 1",
        "Right: nobody at the ramp notices",
    ),
}


@pytest.mark.parametrize("lesson", ANSWERS)
def test_a_lesson_tells_a_right_program_from_a_wrong_one(lesson):
    name, right, before, after = ANSWERS[lesson]
    cells = [cell.source for cell in nbformat.read(NOTEBOOKS / f"{lesson}.ipynb", 4).cells if cell.cell_type == "code"]
    needed = [cells[0], *(cell for cell in cells if "\ndef " in f"\n{cell}" or cell.startswith(f"{name} = "))]
    space = {}
    for cell in needed:
        exec(cell, space)
    assert space["check"](space[name]).startswith(before)
    assert space["check"](right).startswith(after)


def test_links_of_lessons_and_of_the_teachers_guide_lead_somewhere():
    texts = {path: path.read_text(encoding="utf-8") for path in [NOTEBOOKS.parent / "docs" / "teaching.md", *NOTEBOOKS.glob("*.ipynb")]}
    links = [(path, link) for path, text in texts.items() for link in re.findall(r"\]\(([^):#]+)\)", text)]
    assert len(links) > 40
    assert [(path.name, link) for path, link in links if not (path.parent / link).exists()] == []


def test_the_teachers_guide_names_every_lesson():
    guide = (NOTEBOOKS.parent / "docs" / "teaching.md").read_text(encoding="utf-8")
    assert [path.name for path in NOTEBOOKS.glob("*.ipynb") if f"notebooks/{path.name}" not in guide] == []
