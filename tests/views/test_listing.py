"""The highlighted instruction list."""

from html.parser import HTMLParser

import pytest

from ecsim import Plc
from ecsim.assembler import assemble
from ecsim.views.listing import listing

TEXT = """\
VAR_GLOBAL
  Start AT X5 // green
  Motor AT Y0
END_VAR
PROGRAM MAIN
// Hold
LD Start
OR Y0
OUT Motor // main drive
STL S20
TON T0 10
LD= D5 16#1F
OUT S0
RET
END_PROGRAM
"""


def test_as_text_with_line_and_step_numbers_names_and_comments():
    assert (
        str(listing(assemble(TEXT, "EC20")))
        == """\
        VAR_GLOBAL
 2        Start AT X5           // green
 3        Motor AT Y0
        END_VAR

 5      PROGRAM MAIN
 6      // Hold
 7   0  LD    Start             // X5
 8   1  OR    Y0                // Motor
 9   2  OUT   Motor             // Y0, main drive

10   3  STL   S20
11   6  TON   T0 10
12  11  LD=   D5 16#1F
13  16  OUT   S0
14  19  RET
        END_PROGRAM"""
    )


def test_a_program_alone_has_no_headers():
    assert str(listing(assemble("LD X0\nOUT Y0", "EC20"))) == "1  0  LD    X0\n2  1  OUT   Y0"


def test_a_unit_alone_is_listed():
    program = assemble(
        "PROGRAM MAIN\nLD SM0\nCALL ONE\nEND_PROGRAM\nSUBROUTINE ONE\nVAR_TEMP A : INT\nLD SM0\nINC #A\nEND_SUBROUTINE", "EC20"
    )
    assert str(listing(program.unit("ONE"), program)) == "7  5  LD    SM0\n8  6  INC   #A                // V0"


class Words(HTMLParser):
    """The classes of each piece of text."""

    def __init__(self, markup):
        super().__init__()
        self.found, self.open = [], []
        self.feed(markup)

    def handle_starttag(self, tag, attrs):
        self.open.append(dict(attrs).get("class", ""))

    def handle_endtag(self, tag):
        self.open.pop()

    def handle_data(self, data):
        self.found.append((self.open[-1], data.strip()))


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("op", "TON"),
        ("step", "STL"),
        ("step", "S20"),
        ("name", "Start"),
        ("device", "T0"),
        ("number", "10"),
        ("number", "16#1F"),
        ("keyword", "VAR_GLOBAL"),
        ("comment", "// Hold"),
    ],
)
def test_each_kind_of_word_has_its_colour(kind, words):
    assert (kind, words) in Words(listing(assemble(TEXT, "EC20")).html()).found


def test_markup_in_comments_stays_text():
    text = listing(assemble("// <b>\nLD X0 // </div>&\nOUT Y0", "EC20")).html()
    assert "<b>" not in text
    assert ("comment", "// <b>") in Words(text).found
    assert ("cell comment", "// </div>&") in Words(text).found


def test_it_shows_itself_with_its_style():
    shown = listing(assemble(TEXT, "EC20"))._repr_html_()
    assert shown.startswith("<style>")
    assert "--ec-il-device: #2c5a7a;" in shown
    assert repr(listing(assemble(TEXT, "EC20"))) == "<Listing, 8 instructions>"


def test_the_lines_of_an_active_step_are_lit():
    plc = Plc("EC20")
    plc.load("LD SM1\nSET S0\nSTL S0\n// on the way\nLD X0\nSET S20\nSTL S20\nRET")
    plc.run()
    plc.scan(2)
    state = listing(plc.program).state(plc)
    lit = {key for key, value in state.items() if value == "row active"}
    assert lit == {"l2:class", "g3:class", "c3.0:class", "l3:class", "l4:class"}
    plc.stop()
    assert "row active" not in listing(plc.program).state(plc).values()
