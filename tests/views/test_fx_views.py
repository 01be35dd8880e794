"""Ladder, listing and chart of programs of the FX family."""

import re

import pytest

import ecsim
from ecsim.assembler import assemble
from ecsim.views.chart_text import draw as chart_text
from ecsim.views.ladder import ladder
from ecsim.views.listing import listing
from ecsim.views.sfc import chart

TEXT = """\
LD    M8002
SET   S0
LDP   X2
ORF   X3
ANDP  M5
SET   M0
LD    Y0
OUT   T0 K100
LD    X6
RST   D5
RST   C0
LD    X7
MC    N0 M100
LD    X10
DMOVP K30V0 D10
MCR   N0
FOR   K3
LD    M8000
INC   D0
NEXT
LD    X11
CJ    P1
LD    X12
CALL  P10
P1                      // here

STL   S0
OUT   Y1
LDP   X5
SET   S20

STL   S20
OUT   Y2
LD    X1
OUT   S0
RET
FEND

P10                     // fill
LD    M8000
INC   D1
SRET
END
"""


@pytest.fixture(scope="module")
def program():
    return assemble(TEXT, "H2U")


def test_the_ladder_in_characters(program):
    text = str(ladder(program))
    for wanted in (
        "[OUT T0 K100]",
        "[RST D5]",
        "(R)",
        "[MC N0 M100]",
        "[MCR N0]",
        "[FOR K3]",
        "[CJ P1]",
        "[CALL P10]",
        "[P1]",
        "[FEND]",
        "[SRET]",
    ):
        assert wanted in text, wanted
    assert "[DMOVP K30V0 D10]" in text
    assert "FX:" not in text
    assert len(re.findall("┤↑├", text)) == 3
    assert len(re.findall("┤↓├", text)) == 1


def test_the_picture_names_instructions_as_the_family_does(program):
    picture = ladder(program).svg()
    assert "FX:" not in picture
    for wanted in (">OUT<", "100 ms", ">MC N0<", ">P1<", "X2, rising edge", "X3, falling edge"):
        assert wanted in picture, wanted


def test_power_and_edges_are_shown(program):
    plc = ecsim.Plc("H2U", input_filter_ms=0)
    plc.load(program)
    plc.tracing = True
    plc.run()
    drawing = ladder(plc.program)
    drawing.svg()
    plc.set({"X2": 1, "M5": 0})
    plc.scan()
    contact = next(i for i in plc.program.instructions if str(i) == "LDP X2")
    assert drawing.state(plc)[f"e{contact.position}:class"] == "contact flow"
    plc.scan()
    assert drawing.state(plc)[f"e{contact.position}:class"] == "contact open"


def test_the_listing_is_the_text(program):
    shown = str(listing(program))
    assert "PROGRAM" not in shown
    assert "SUBROUTINE" not in shown
    words = [re.sub(r"^ *\d+ +\d+  ", "", line).split("  //")[0].split() for line in shown.split("\n") if line.strip()]
    assert words == [line.split("//")[0].split() for line in TEXT.split("\n") if line.strip()]


def test_the_chart_tells_of_edges(program):
    drawing = chart(program)
    assert "X5 rises" in chart_text(drawing)
    assert "FX:" not in drawing.svg()
