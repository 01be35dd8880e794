"""The ladder: what a rung is as data, how it looks as text and as SVG, and what it shows of a running PLC."""

import re
from xml.etree import ElementTree

import pytest
from hypothesis import HealthCheck, given, settings

from ecsim import Plc
from ecsim.assembler import assemble
from ecsim.conditions import condition
from ecsim.views import svg
from ecsim.views.asked import asked
from ecsim.views.ladder import ladder
from ecsim.views.listing import listing
from ecsim.views.rungs import Block, Contact, Gate, Output, Parallel, Series, rungs
from ecsim.views.sfc import chart

from .programs import charts, ladders

HOLD = """
VAR_GLOBAL
  Start AT X5
  EStop AT X6
  Running AT M0 // the machine is started
END_VAR
PROGRAM MAIN
// Start and hold
LD Start // green
OR M0
ANI EStop
OUT Running
END_PROGRAM
"""


def rung(text):
    (first, *_) = rungs(assemble(text, "EC20").main)
    return first


def shape(node):
    """A tree in short: words of contacts and outputs, lists for series, sets of ways in tuples."""
    if isinstance(node, Series):
        return [shape(item) for item in node.items]
    if isinstance(node, Contact | Gate | Output):
        return str(node.word)
    if isinstance(node, Block):
        return {node.join.mnemonic if node.join else "": shape(node.flow)}
    if isinstance(node, Parallel):
        return tuple(shape(way) for way in node.ways)
    return {"MPS": [shape(branch) for branch in node.branches]}


# -- as data: 5.1 ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # 5.1.3: AND stands in series, 5.1.5: OR in parallel with all of the block before it
        ("LD X0\nAND X1\nOR X2\nOUT Y0", [([["LD X0", "LD X1"], "LD X2"]), "OUT Y0"]),
        # 5.1.8: ANB puts two blocks in series
        ("LD M0\nOR M1\nLD M2\nOR M3\nANB\nOUT Y0", [(["LD M0"], "LD M1"), {"ANB": [(["LD M2"], "LD M3")]}, "OUT Y0"]),
        # 5.1.9: ORB puts two blocks in parallel
        ("LD M1\nAND M2\nLD M3\nAND M4\nORB\nOUT Y0", [(["LD M1", "LD M2"], {"ORB": ["LD M3", "LD M4"]}), "OUT Y0"]),
        # 5.1.10 to 5.1.12: branches of outputs
        (
            "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nANI X2\nOUT Y1\nMPP\nOUT Y2",
            ["LD X0", {"MPS": [["LD X1", "OUT Y0"], ["LDI X2", "OUT Y1"], ["OUT Y2"]]}],
        ),
        # a cascade is no branch
        ("LD X0\nOUT Y0\nAND X1\nOUT Y1", ["LD X0", "OUT Y0", "LD X1", "OUT Y1"]),
        # 5.1.13: an edge stands in series; 6.16: so does a comparison
        ("LD X0\nEU\nAND< D0 5\nSET M0", ["LD X0", "EU", "LD< D0 5", "SET M0"]),
    ],
)
def test_a_rung_is_a_tree(text, expected):
    found = shape(rung(text).flow)
    if "AND X1\nOR X2" in text:
        expected = [(["LD X0", "LD X1"], "LD X2"), "OUT Y0"]
    assert found == expected


def test_a_block_of_one_contact_is_not_the_contact():
    series, block = rung("LD X0\nAND X1\nOUT Y0"), rung("LD X0\nLD X1\nANB\nOUT Y0")
    assert shape(series.flow) != shape(block.flow)
    assert [str(word) for word in block.words] == ["LD X0", "LD X1", "ANB", "OUT Y0"]


def test_branches_in_branches_keep_their_order():
    found = rung("LD X0\nMPS\nMPS\nOUT Y0\nMPP\nOUT Y1\nMPP\nOUT Y2")
    assert shape(found.flow) == ["LD X0", {"MPS": [[{"MPS": [["OUT Y0"], ["OUT Y1"]]}], ["OUT Y2"]]}]


def test_a_rung_knows_its_place():
    program = assemble("STL S20\n// go on\nLD X0\nSET S21\nSTL S21\nOUT Y0\nRET", "EC20")
    found = rungs(program.main)[1]
    assert (found.number, found.title, found.region) == (1, "go on", (("STL", 20),))
    assert [word.step for word in found.words] == [3, 4]


# -- as text -----------------------------------------------------------------------------------------------------

PICTURES = {
    HOLD: """\
   1  │ Start and hold                                                         │
      │  Start     EStop                                               Running │
      │    X5        X6                                                   M0   │
   0  ├─┬─┤ ├────┬──┤/├──────────────────────────────────────────────────( )───┤
      │ │Running │                                                             │
      │ │   M0   │                                                             │
      │ └──┤ ├───┘                                                             │""",
    "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nLD X2\nOR X3\nANB\nSET Y1\nMPP\nEU\nTON T0 10\nOUT Y2": """\
   1  │  X0     X1                                                        Y0   │
   0  ├─┤ ├──┬─┤ ├───────────────────────────────────────────────────────( )───┤
      │      │   X2                                                       Y1   │
      │      ├─┬┤ ├─┬────────────────────────────────────────────────────(S)───┤
      │      │ │ X3 │                                                          │
      │      │ └┤ ├─┘                                                          │
      │      └─┤↑├──────────────────────────────────────────────┬─[TON T0 10]──┤
      │                                                         │         Y2   │
      │                                                         └────────( )───┤""",
    "LD SM0\nMC 0\nLD= D0 5\nLDD>= D2 100000\nORB\nINV\nRST M0\nMCR 0": """\
   1  │ SM0                                                                    │
   0  ├─┤ ├────────────────────────────────────────────────────────────[MC 0]──┤
      │                                                                        │
   2  │ │                                                                 M0   │
   4  │ ├─┬┤D0 = 5├───────┬─┤¬├──────────────────────────────────────────(R)───┤
      │ │ └┤D2 D≥ 100000├─┘                                                    │
      │                                                                        │
   3  │                                                                        │
  19  ├───[MCR 0]                                                              │""",
    "STL S0\n// wait\nLD X0\nSET S20\nSTL S20\nOUT Y0\nLD X1\nOUT S0\nRET": """\
   1  │                                                                        │
   0  ├─┬─[STL S0]                                                             │
      │ │                                                                      │
   2  │ │ wait                                                                 │
      │ │  X0                                                            S20   │
   3  │ ├─┤ ├────────────────────────────────────────────────────────────(S)───┤
      │                                                                        │
   3  │                                                                        │
   7  ├─┬─[STL S20]                                                            │
      │ │                                                                      │
   4  │ │                                                                 Y0   │
  10  │ ├────────────────────────────────────────────────────────────────( )───┤
      │ │                                                                      │
   5  │ │  X1                                                             S0   │
  11  │ ├─┤ ├────────────────────────────────────────────────────────────( )───┤
      │                                                                        │
   6  │                                                                        │
  15  ├───[RET]                                                                │""",
}


def test_each_network_shows_its_program_step_on_every_face():
    """The steps that the manual counts: STL 3, OUT of a step 3, SET of a step 3, RET 1, contacts and coils 1 (chapter 5), DADD 10 (6.3.10)."""
    program = assemble("STL S0\nOUT Y0\nLD X0\nSET S20\nSTL S20\nLD X1\nOUT S0\nRET\nLD M0\nDADD D0 D2 D4\nLD M1\nOUT Y1", "EC20")
    steps = ["0", "3", "4", "8", "11", "15", "16", "27"]
    found = ladder(program)
    assert re.findall(r'"step-no end"[^>]*>(\d+)<', found.svg()) == steps
    assert re.findall(r"^ +(\d+) +[├│]", str(found), re.MULTILINE)[1::2] == steps
    assert re.findall(r"program step (\d+)", chart(program).svg()) == ["0", "8"]
    assert [str(row.step) for row in listing(program).rows if row.step is not None and str(row.step) in steps] == steps


@pytest.mark.parametrize("text", PICTURES)
def test_a_small_program_as_text(text):
    assert str(ladder(assemble(text, "EC20"))) == PICTURES[text]


def test_wide_letters_take_two_columns():
    picture = str(ladder(assemble("VAR_GLOBAL\n  液位 AT X0\nEND_VAR\nPROGRAM MAIN\nLD 液位\nOUT Y0\nEND_PROGRAM", "EC20")))
    first, second, third = picture.splitlines()
    assert "液位" in first
    assert len(first) + 2 == len(second) == len(third)


# -- as SVG -------------------------------------------------------------------------------------------------------


def elements(picture):
    """Every element by id; the XML must be well formed and its ids must be unique."""
    root = ElementTree.fromstring(picture)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    found = [(node.get("id"), node) for node in root.iter() if node.get("id")]
    assert len({key for key, _ in found}) == len(found)
    return dict(found)


@settings(max_examples=10, suppress_health_check=list(HealthCheck))
@given(ladders() | charts())
def test_the_state_speaks_of_elements_that_the_picture_has(text):
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(text)
    picture = ladder(plc.program)
    for width in (None, 500, 1280):
        ids = elements(picture.svg("p-", width))
        for tracing in (False, True):
            plc.tracing = tracing
            plc.run()
            plc.scan(2)
            state = picture.state(plc)
            assert {f"p-{key.rpartition(':')[0]}" for key in state} <= ids.keys()
            elements(svg.applied(picture.svg("p-", width), state, "p-"))
        plc.stop()


def test_names_stand_above_addresses_and_comments_in_the_tip():
    picture = ladder(assemble(HOLD, "EC20")).svg()
    ids = elements(picture)
    start = [node.text for node in ids["e0"].iter() if node.text]
    assert start[1:3] == ["Start", "X5"]
    assert "green" in start[0]
    assert ids["e0"].get("aria-label") == "X5 Start, normally open"
    assert [node.text for node in ids["e3"].iter() if node.text][1:3] == ["Running", "M0"]


def test_notes_stand_beyond_the_right_rail_where_there_is_room():
    picture = ladder(assemble(HOLD, "EC20"))
    assert ">Start X5: green<" not in picture.svg(width=960)
    assert ">Start X5: green<" in picture.svg(width=1280)
    assert ElementTree.fromstring(picture.svg(width=1280)).get("width") == "1280"


def test_a_picture_alone_carries_its_style_with_plain_values_to_fall_back_to():
    picture = ladder(assemble(HOLD, "EC20"))._repr_svg_()
    ElementTree.fromstring(picture)
    assert "var(--ec-dead, #868c93)" in picture
    plain = svg.plain(picture, "dark")
    assert "var(" not in plain
    assert "#767b81" in plain


def test_a_part_of_a_ladder_is_a_ladder():
    program = assemble("LD X0\nOUT Y0\nLD X1\nOUT Y1\nLD X2\nOUT Y2", "EC20")
    whole = ladder(program)
    assert len(whole) == 3
    assert [str(word) for word in whole[1:].instruction_list()] == ["LD X1", "OUT Y1", "LD X2", "OUT Y2"]
    assert str(ladder(program.main.networks[1], program)) == str(whole[1])
    assert repr(whole[1]) == "<Ladder, 1 network>"
    with pytest.raises(TypeError, match=r"ladder\(network, program\)"):
        ladder(program.main.networks[1])


def test_every_unit_of_a_program_is_shown_under_its_name():
    text = "PROGRAM MAIN\nLD SM0\nCALL SBR 1 D0\nEND_PROGRAM\nSUBROUTINE SBR\nVAR_INPUT A : INT\nVAR_OUTPUT B : INT\nLD SM0\nMOV #A #B\nEND_SUBROUTINE"
    picture = str(ladder(assemble(text, "EC20")))
    assert "Main program" in picture
    assert "Subroutine SBR (A : INT, B : INT)" in picture
    assert "[MOV #A(V0) #B(V1)]" in picture


# -- live ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def plc():
    plc = Plc("EC20", input_filter_ms=0)
    plc.tracing = True
    return plc


def show(plc, text, *inputs, scans=1):
    """The state of a program's ladder after some scans with these inputs ON."""
    plc.load(text)
    plc.tracing = True
    plc.run()
    plc.set(dict.fromkeys(inputs, 1))
    plc.scan(scans)
    picture = ladder(plc.program)
    return picture, picture.state(plc)


def test_a_closed_contact_is_solid_where_power_reaches_it(plc):
    _, state = show(plc, "LD X0\nAND X1\nANI X2\nOUT Y0", "X1")
    assert [state[f"e{n}:class"] for n in range(4)] == ["contact open", "contact closed", "contact closed", "coil open"]
    plc["X0"] = 1
    plc.scan()
    state = ladder(plc.program).state(plc)
    assert [state[f"e{n}:class"] for n in range(4)] == ["contact flow", "contact flow", "contact flow", "coil flow"]
    assert state["e1:aria-label"] == "X1, normally open, power flows"


def test_a_one_scan_pulse_is_seen(plc):
    picture, state = show(plc, "LD X0\nEU\nOUT Y0", "X0")
    assert (state["e1:class"], state["e2:class"]) == ("contact flow", "coil flow")
    plc.scan()
    state = picture.state(plc)
    assert (state["e0:class"], state["e1:class"], state["e2:class"]) == ("contact flow", "contact open", "coil open")


def test_wires_that_carry_the_same_are_one_path(plc):
    picture, state = show(plc, "LD X0\nOUT Y0")
    strip = picture.sheet().strips[0]
    first, second, third = "M64 {0}H124", "M140 {0}H887", "M913 {0}H944"
    y = f"{strip.wire:g}"
    assert (state["w0:d"], state["p0:d"]) == ((second + third).format(y), first.format(y))
    plc["X0"] = 1
    plc.scan()
    state = picture.state(plc)
    assert (state["w0:d"], state["p0:d"]) == ("", (first + second + third).format(y))


def test_values_stand_under_contacts_and_in_boxes(plc):
    text = "LD< D0 5\nTON T0 10\nMOV 1234 D1\nLD SM0\nSET M0\nSET M1\nRST M1"
    _, state = show(plc, text, scans=45)
    assert state["v0.0:text"] == "0"
    assert (state["v1.0:text"], state["r1:width"]) == ("4", f"{164 * 0.4:g}")
    assert state["v2.1:text"] == "1,234"
    assert (state["b4:text"], state["b4:class"]) == ("1", "el-bit on")
    assert (state["b5:text"], state["b5:class"]) == ("0", "el-bit")


def test_what_was_not_executed_carries_no_power(plc):
    _, state = show(plc, "LD X0\nMC 0\nLD SM0\nOUT Y0\nMCR 0\nLD SM0\nOUT Y1")
    assert (state["e2:class"], state["e3:class"], state["e6:class"]) == ("contact open", "coil open", "coil flow")
    assert (state["rail0.1:class"], state["rail1.1:class"]) == ("rail on", "rail")


def test_an_active_step_lights_its_plate_its_mark_and_its_rail(plc):
    text = "LD SM1\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\nOUT Y0\nRET"
    picture, state = show(plc, text, scans=2)
    assert (state["e2:class"], state["e5:class"]) == ("step active", "step")
    assert (state["m2:class"], state["rail1.2:class"], state["rail2.4:class"]) == ("step active", "rail on", "rail")
    plc["X0"] = 1
    plc.scan(2)
    state = picture.state(plc)
    assert (state["e2:class"], state["e5:class"], state["e6:class"], state["rail2.4:class"]) == (
        "step",
        "step active",
        "coil flow",
        "rail on",
    )


def test_forced_devices_are_marked_wherever_they_stand(plc):
    picture, state = show(plc, "LD X0\nOUT Y0\nLD Y0\nMOV D5 D6")
    assert "forced on" not in state.values()
    plc.force("Y0", 1)
    plc.force("D5", 7)
    plc.scan()
    state = picture.state(plc)
    assert {key for key, value in state.items() if value == "forced on"} == {
        "f1:class",
        "h1:class",
        "f2:class",
        "h2:class",
        "f3:class",
        "h3:class",
    }
    assert (state["g1:text"], state["g3:text"]) == ("F 1", "F 7")
    plc.unforce()
    assert "forced on" not in picture.state(plc).values()


def test_without_a_trace_no_power_is_claimed(plc):
    plc.load("LD X0\nAND> D0 5\nOUT Y0\nLDI X1\nOUT Y1")
    plc.tracing = False
    plc.run()
    plc.set({"X0": 1, "D0": 9})
    plc.scan()
    state = ladder(plc.program).state(plc)
    assert [state[f"e{n}:class"] for n in range(5)] == ["contact closed", "contact closed", "coil on", "contact closed", "coil on"]
    assert state["p0:d"] == ""


def test_a_stopped_plc_is_a_grey_page(plc):
    picture, _ = show(plc, "LD SM0\nOUT Y0")
    plc.stop()
    state = picture.state(plc)
    assert (state["rail0.0:class"], state["p0:d"], state["e1:class"]) == ("rail", "", "coil open")


def test_an_indexed_register_is_read_where_it_points(plc):
    plc.load("LD SM0\nMOV D0Z1 D10\nLD SM0\nMOV 7990 D11")
    plc.tracing = True
    plc.run()
    plc.set({"Z1": 3, "D3": 42})
    plc.scan()
    picture = ladder(plc.program)
    assert picture.state(plc)["v1.0:text"] == "42"
    plc["Z1"] = 9000
    assert picture.state(plc)["v1.0:text"] == "–"


def test_nothing_of_a_name_or_comment_becomes_markup():
    text = 'VAR_GLOBAL\n  A AT X0 // <script>"&\nEND_VAR\nPROGRAM MAIN\n// <b>&amp;\nLD A // </svg>\nOUT Y0\nEND_PROGRAM'
    picture = ladder(assemble(text, "EC20"))
    for width in (None, 1280):
        elements(picture.svg(width=width))
    assert "<script>" not in picture.svg()
    assert "&lt;b&gt;&amp;amp;" in picture.svg()


# -- of a large program only what is looked at ---------------------------------------------------------------------


def test_the_networks_one_by_one_are_the_whole_picture(plc):
    picture, state = show(plc, "LD X0\nMC 0\nLD SM0\nOUT Y0\nMCR 0\nLD SM0\nOUT Y1", scans=2)
    sheet = picture.sheet()
    parts = [sheet.network(number, "a-") for number in range(len(picture))]
    assert sheet.shell("a-", "".join(parts)) == picture.svg("a-")
    each = [sheet.state(plc, [number]) for number in range(len(picture))]
    assert {key: value for entries in each for key, value in entries.items()} == state
    assert sum(map(len, each)) == len(state)


def test_the_places_of_all_networks_are_known_before_one_is_drawn():
    sheet = ladder(assemble("\n".join(f"LD X{n % 8}\nOUT M{n}" for n in range(500)), "EC20")).sheet(640)
    assert [strip.above for strip in sheet.strips[1:]] == [strip.bottom for strip in sheet.strips[:-1]]
    assert sheet.strips[-1].bottom < sheet.height < sheet.strips[-1].bottom + 20
    assert sheet._lives == {}


def test_a_narrow_sheet_takes_the_widest_cells_that_fit():
    program = assemble("LD X0\nAND X1\nAND X2\nOUT Y0\nLD X3\nOUT Y1", "EC20")
    cells = [ladder(program).sheet(width).cell for width in (600, 520, 500, 470, 440, 400, 100)]
    # 64 px to the rail, 12 to the first cell, three cells, 88 for the coil, 16 to the edge
    assert cells == [112, 112, 104, 96, 80, 104, 104]


CALLED = """
PROGRAM MAIN
LD X0
CALL ONE D0 D1
LD X0
CALL ONE 40 D2
END_PROGRAM
SUBROUTINE ONE
VAR_INPUT
A : INT
END_VAR
VAR_OUTPUT
B : INT
END_VAR
VAR_TEMP
L : BOOL
END_VAR
LD SM0
ADD #A 5 #B
OUT #L
LD #L
SET M0
END_SUBROUTINE
"""


def test_what_a_subroutine_has_of_its_own_is_shown_as_its_last_call_left_it(plc):
    """3.1.12: V and LM are gone when it has returned; the last of the two calls had 40."""
    plc.load(CALLED)
    plc.tracing = True
    plc.run()
    plc.set({"X0": 1})
    plc.scan(2)
    picture = ladder(plc.program)
    position = next(i.position for i in plc.program.instructions if i.mnemonic == "ADD")
    state = picture.state(plc)
    assert [state[f"v{position}.{place}:text"] for place in (0, 2)] == ["40", "45"]
    assert (state[f"e{position + 1}:class"], state[f"e{position + 2}:class"]) == ("coil flow", "contact flow")


def test_a_subroutine_that_was_not_called_has_no_values_and_its_tip_says_why(plc):
    plc.load(CALLED)
    plc.tracing = True
    plc.run()
    plc.scan(2)
    picture = ladder(plc.program)
    position = next(i.position for i in plc.program.instructions if i.mnemonic == "ADD")
    assert picture.state(plc)[f"v{position}.0:text"] == "–"
    assert picture.state(plc)[f"e{position + 1}:class"] == "coil open"
    assert "a value of ONE's own is there only after a call in the scan that is shown" in picture.svg()


# -- what a breakpoint at an element asks ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "questions"),
    [
        ("LD X0\nANI X1\nOUT Y0\nRST M1", {0: "X0", 1: "not X1", 2: "Y0", 3: "not M1"}),
        ("LD X0\nOR X1\nAND X2\nINC D0", {0: "X0", 1: "X1", 2: "X2", 3: "(X0 or X1) and X2"}),
        ("LD X0\nLDI X1\nOR X2\nANB\nINC D0", {0: "X0", 1: "not X1", 2: "X2", 4: "X0 and (not X1 or X2)"}),
        ("LDD> D0 -5\nINC D9", {0: "D0:DINT > -5", 1: "D0:DINT > -5"}),
        ("LDR<= D0 2.5\nCTU C0 3", {0: "D0:REAL <= 2.500000", 1: "C0"}),
        ("LD X0\nAND X1\nINV\nINC D0", {0: "X0", 1: "X1", 3: "not (X0 and X1)"}),
        ("LD X0\nEU\nINC D0\nLD X1\nMOV 1 D0", {0: "X0", 3: "X1", 4: "X1"}),
        ("LD X0\nMPS\nAND X1\nINC D0\nMPP\nINC D1", {0: "X0", 2: "X1", 3: "X0 and X1", 5: "X0"}),
    ],
)
def test_what_a_breakpoint_at_an_element_asks(plc, text, questions):
    plc.load(text)
    found = {}
    for tree in rungs(plc.program.main):
        found |= asked(tree, plc.model)
    assert found == questions
    for question in found.values():
        condition(plc, question)  # it can be read


def test_what_is_there_only_within_a_scan_cannot_be_asked(plc):
    plc.load(CALLED + "SUBROUTINE TWO\nLD> D0Z1 3\nINC D1\nEND_SUBROUTINE")
    for name in ("ONE", "TWO"):
        for tree in rungs(plc.program.unit(name)):
            questions = asked(tree, plc.model)
            assert set(questions.values()) <= {"SM0", "M0"}
