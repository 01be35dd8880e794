"""The chart: what a flow is as data, where its parts lie, how it looks and what it shows of a running PLC."""

from xml.etree import ElementTree

import pytest
from hypothesis import HealthCheck, given, settings

from ecsim import Plc
from ecsim.assembler import assemble
from ecsim.session import Session
from ecsim.views import svg
from ecsim.views.chart_layout import ChartLayout, Jump, Node
from ecsim.views.chart_text import ChartCells
from ecsim.views.conditions import phrase
from ecsim.views.flows import Block, Flow, Transition
from ecsim.views.labels import Labels
from ecsim.views.sfc import ChartLengths, chart

from .programs import charts, ladders

SOME = settings(max_examples=40, suppress_health_check=list(HealthCheck))

SIMPLE = """
// wait
STL S0
LD X0
SET S20
STL S20
OUT Y0
LD X1
AND X2
EU
SET S21
STL S21
SET Y1
LD X3
RST Y1
TON T0 30
LD T0
OUT S0
RET
"""
SELECTION = """
STL S0
LD X0
SET S20
LDI X0
SET S21
STL S20
LD X1
SET S22
STL S21
LD X2
SET S22
STL S22
LD X3
OUT S0
RET
"""
PARALLEL = """
STL S0
LD X0
SET S20
SET S21
STL S20
OUT Y0
LD X1
SET S22
STL S22
OUT Y1
STL S21
OUT Y2
STL S22
STL S21
LD X4
SET S23
STL S23
LD X5
OUT S0
RET
"""
SKIP = """
STL S0
LD X0
SET S20
STL S20
LD X1
SET S21
LDI X1
OUT S22
STL S21
LD X2
SET S22
STL S22
LD X3
OUT S0
RET
"""
LOOP = """
STL S0
LD X0
SET S20
STL S20
LD X1
SET S21
LD X2
OUT S0
STL S21
LD X3
OUT S20
LD X4
RST S21
RET
"""


def flow(text):
    (only,) = chart(assemble(text, "EC20")).flows
    return only


def says(transition):
    return phrase(transition.condition, Labels(assemble("", "EC20").main)), [str(word) for word in transition.targets], transition.ends


# -- as data: 5.3, 7.2 --------------------------------------------------------------------------------------------


def test_a_step_has_actions_and_transitions():
    first, second, third = flow(SIMPLE).steps
    assert (first.title, str(first.devices[0]), first.actions) == ("wait", "S0", ())
    assert [says(t) for t in first.transitions] == [("X0", ["SET S20"], False)]
    assert [(a.qualifier, str(a.word)) for a in second.actions] == [("N", "OUT Y0")]
    assert [says(t) for t in second.transitions] == [("(X1 and X2) rises", ["SET S21"], False)]
    assert [(a.qualifier, str(a.word)) for a in third.actions] == [("S", "SET Y1"), ("R", "RST Y1"), ("TON", "TON T0 30")]
    labels = Labels(assemble(SIMPLE, "EC20").main)
    assert [phrase(a.condition, labels) for a in third.actions] == ["", "X3", "X3"]


def test_a_selection_has_a_transition_for_each_way():
    (first, *_) = flow(SELECTION).steps
    assert [says(t) for t in first.transitions] == [("X0", ["SET S20"], False), ("not X0", ["SET S21"], False)]


def test_several_set_behind_one_condition_lead_to_parallel_branches():
    steps = flow(PARALLEL).steps
    assert [says(t) for t in steps[0].transitions] == [("X0", ["SET S20", "SET S21"], False)]
    join = steps[4]
    assert join.joins
    assert list(map(str, join.devices)) == ["S22", "S21"]
    assert [says(t) for t in join.transitions] == [("X4", ["SET S23"], False)]


def test_a_step_that_resets_itself_ends_there():
    last = flow(LOOP).steps[-1]
    assert [says(t) for t in last.transitions] == [("X3", ["OUT S20"], False), ("X4", ["RST S21"], True)]
    assert last.actions == ()


def test_a_condition_reads_as_words():
    text = "STL S0\nLD X0\nOR X1\nANI X2\nLD D0\n".replace("LD D0", "LD> D0 5") + "OR M0\nANB\nINV\nSET S20\nSTL S20\nRET"
    (transition,) = flow(text).steps[0].transitions
    assert says(transition)[0] == "not ((X0 or X1) and not X2 and (D0 > 5 or M0))"


def test_a_program_is_made_of_ladder_blocks_and_flows():
    text = "LD SM1\nSET S0\n" + SIMPLE + "LD X7\nOUT Y7\n" + SELECTION.replace("S0", "S1").replace("S2", "S3")
    found = chart(assemble(text, "EC20"))
    assert [type(part) for part in found.parts] == [Block, Flow, Block, Flow]
    assert repr(found) == "<Chart, 7 steps in 2 flows>"


# -- where it lies ------------------------------------------------------------------------------------------------


def sketches(text, kind="px"):
    program = assemble(text, "EC20")
    labels = Labels(program.main, program)
    for one in chart(program).flows:
        lengths = ChartLengths(labels, program.model) if kind == "px" else ChartCells(labels)
        for sketch in ChartLayout(lengths).flow(one):
            yield sketch, lengths


def body(mark, lengths):
    """What a mark covers."""
    what, x, y = mark.what, mark.x, mark.y
    if isinstance(what, Transition):
        left, right, up, down = lengths.transition(what)
        return (x - left, y - up + lengths.above / 2 - 1, x + right, y + down - lengths.below / 2 + 1)
    if isinstance(what, Jump):
        left, right = lengths.arrow(what)
        return (x - left, y + 1, x + right, y + lengths.jump - 8)
    left, right, height = lengths.node(what)
    return (x - left, y, x + right, y + height)


def overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


@SOME
@given(charts())
def test_nothing_in_a_chart_overlaps(text):
    for sketch, lengths in sketches(text):
        found = [(body(mark, lengths), mark) for mark in sketch.marks]
        crossing = [(a[1], b[1]) for n, a in enumerate(found) for b in found[:n] if overlap(a[0], b[0])]
        assert not crossing


@SOME
@given(charts())
def test_lines_pass_beside_steps_and_conditions(text):
    for sketch, lengths in sketches(text):
        for mark in sketch.marks:
            left, top, right, bottom = body(mark, lengths)
            for x1, y1, x2, y2, _ in sketch.lines:
                if y1 == y2:
                    crossed = top + 1 < y1 < bottom - 1 and min(x1, x2) < right - 1 and left + 1 < max(x1, x2)
                else:
                    own = abs(x1 - mark.x) < 1  # its own axis runs through it
                    crossed = not own and left + 1 < x1 < right - 1 and min(y1, y2) < bottom - 1 and top + 1 < max(y1, y2)
                assert not crossed, (mark.what, (x1, y1, x2, y2))


@SOME
@given(charts())
def test_every_step_and_transition_is_drawn_once(text):
    for kind in ("px", "cells"):
        drawn = [mark.what for sketch, _ in sketches(text, kind) for mark in sketch.marks]
        nodes = [node.devices for node in drawn if isinstance(node, Node)]
        steps = [step for one in chart(assemble(text, "EC20")).flows for step in one.steps]
        assert sorted(map(str, nodes)) == sorted(str(step.devices) for step in steps)
        assert sum(isinstance(what, Transition) for what in drawn) == sum(len(step.transitions) for step in steps)


@SOME
@given(charts())
def test_a_nested_flow_has_jumps_only_where_the_program_jumps(text):
    program = assemble(text, "EC20")
    jumps = [
        mark.what
        for sketch, _ in sketches(text)
        for mark in sketch.marks
        if isinstance(mark.what, Jump) and mark.what.target and not mark.what.join
    ]
    steps = [step for one in chart(program).flows for step in one.steps]
    order = {step.devices[0]: place for place, step in enumerate(steps) if not step.joins}
    back = [
        target
        for place, step in enumerate(steps)
        for transition in step.transitions
        for target in transition.steps
        if order.get(target, -1) <= (order.get(step.devices[0], place) if not step.joins else place)
    ]
    assert sorted(map(str, (jump.target for jump in jumps))) == sorted(map(str, back))


def test_a_way_past_the_place_where_all_ways_meet_is_a_jump():
    text = SELECTION.replace("LD X1\nSET S22", "LD X1\nSET S22\nLD X5\nOUT S21")
    (found,) = [sketch for sketch, _ in sketches(text)]
    assert sorted(str(mark.what) for mark in found.marks if isinstance(mark.what, Jump)) == ["S0", "S22"]


def test_a_flow_as_long_as_steps_go_is_drawn():
    lines = ["STL S0", "LD X0", "SET S20"]
    for number in range(20, 900):
        lines += [f"STL S{number}", "LD X0", f"SET S{number + 1}", "LD X1", "OUT S0"]
    lines += ["STL S900", "LD X1", "OUT S0", "RET"]
    (found,) = [sketch for sketch, _ in sketches("\n".join(lines))]
    assert sum(isinstance(mark.what, Node) for mark in found.marks) == 882


def test_branches_nested_without_end_are_drawn_with_jumps():
    lines = ["STL S0", "LD X0", "SET S20"]
    for number in range(20, 300, 2):
        lines += [f"STL S{number}", "LD X0", f"SET S{number + 1}", "LD X1", f"SET S{number + 2}", f"STL S{number + 1}", "LD X2", "SET S301"]
    lines += ["STL S300", "LD X1", "SET S301", "STL S301", "LD X3", "OUT S0", "RET"]
    program = assemble("\n".join(lines), "EC20")
    assert ElementTree.fromstring(chart(program).svg()) is not None
    assert "S301" in str(chart(program))


# -- as text ------------------------------------------------------------------------------------------------------

PICTURES = {
    SIMPLE: """\
  ╔═════╗
  ║ S0  ║
  ╚══╤══╝
     │
    ─┼─ X0
  ┌──┴──┐
  │ S20 ├─ N Y0
  └──┬──┘
     │
    ─┼─ (X1 and X2) rises
  ┌──┴──┐
  │ S21 ├─ S Y1
  └──┬──┘  R Y1, when X3
     │     TON T0 30, when X3
     │
    ─┼─ T0
     ▼ S0""",
    SELECTION: """\
         ╔═════╗
         ║ S0  ║
         ╚══╤══╝
     ┌──────┴──────┐
    ─┼─ X0        ─┼─ not X0
  ┌──┴──┐       ┌──┴──┐
  │ S20 │       │ S21 │
  └──┬──┘       └──┬──┘
     │             │
    ─┼─ X1        ─┼─ X2
     └──────┬──────┘
         ┌──┴──┐
         │ S22 │
         └──┬──┘
            │
           ─┼─ X3
            ▼ S0""",
    PARALLEL: """\
          ╔═════╗
          ║ S0  ║
          ╚══╤══╝
             │
            ─┼─ X0
  ═══╤═══════╧═══════╤═══
  ┌──┴──┐         ┌──┴──┐
  │ S20 ├─ N Y0   │ S21 ├─ N Y2
  └──┬──┘         └──┬──┘
     │               │
    ─┼─ X1           │
  ┌──┴──┐            │
  │ S22 ├─ N Y1      │
  └──┬──┘            │
  ═══╧═══════╤═══════╧═══
             │ join S22 S21
             │
            ─┼─ X4
          ┌──┴──┐
          │ S23 │
          └──┬──┘
             │
            ─┼─ X5
             ▼ S0""",
    SKIP: """\
  ╔═════╗
  ║ S0  ║
  ╚══╤══╝
     │
    ─┼─ X0
  ┌──┴──┐
  │ S20 │
  └──┬──┘
     ├─────────┐
    ─┼─ X1    ─┼─ not X1
  ┌──┴──┐      │
  │ S21 │      │
  └──┬──┘      │
     │         │
    ─┼─ X2     │
     ├─────────┘
  ┌──┴──┐
  │ S22 │
  └──┬──┘
     │
    ─┼─ X3
     ▼ S0""",
    LOOP: """\
  ╔═════╗
  ║ S0  ║
  ╚══╤══╝
     │
    ─┼─ X0
  ┌──┴──┐
  │ S20 │
  └──┬──┘
     ├─────────┐
    ─┼─ X1    ─┼─ X2
  ┌──┴──┐      ▼ S0
  │ S21 │
  └──┬──┘
     ├─────────┐
    ─┼─ X3    ─┼─ X4
     ▼ S20     ▼ end""",
}


@pytest.mark.parametrize("text", PICTURES)
def test_a_flow_as_text(text):
    assert str(chart(assemble(text, "EC20"))) == PICTURES[text]


# -- as SVG -------------------------------------------------------------------------------------------------------


def elements(picture):
    root = ElementTree.fromstring(picture)
    found = [(node.get("id"), node) for node in root.iter() if node.get("id")]
    assert len({key for key, _ in found}) == len(found)
    return dict(found)


@settings(max_examples=25, suppress_health_check=list(HealthCheck))
@given(charts() | ladders())
def test_the_state_speaks_of_elements_that_the_picture_has(text):
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(text)
    picture = chart(plc.program)
    for width in (None, 344):
        ids = elements(picture.svg("p-", width))
        for tracing in (False, True):
            plc.tracing = tracing
            plc.run()
            plc.scan(2)
            state = picture.state(plc)
            assert {f"p-{key.rpartition(':')[0]}" for key in state} <= ids.keys()
            elements(svg.applied(picture.svg("p-", width), state, "p-"))
        plc.stop()


def test_an_initial_step_is_double():
    ids = elements(chart(assemble(SIMPLE, "EC20")).svg())
    assert [len([r for r in ids[step] if r.get("class") == "inner"]) for step in ("S0", "S20")] == [1, 0]


def test_flows_stand_side_by_side_as_far_as_they_fit():
    text = SIMPLE + SELECTION.replace("S0", "S1").replace("S2", "S3")
    picture = chart(assemble(text, "EC20"))
    wide, narrow = (ElementTree.fromstring(picture.svg(width=width)) for width in (1000, 340))
    assert float(wide.get("height")) < float(narrow.get("height"))


# -- live ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def plc():
    plc = Plc("EC20", input_filter_ms=0)
    plc.tracing = True
    return plc


def begin(plc, text):
    plc.load("LD SM1\nSET S0\n" + text)
    plc.tracing = True
    plc.run()
    plc.scan(2)
    return chart(plc.program)


def position(plc, code):
    return next(i.position for i in plc.program.instructions if str(i) == code)


def test_the_active_step_is_lit_and_its_transition_waits(plc):
    picture = begin(plc, SIMPLE)
    state = picture.state(plc)
    leaving = position(plc, "SET S20")
    assert (state["S0:class"], state["S20:class"]) == ("step active", "step")
    assert (state[f"b{leaving}:class"], state[f"p{leaving}:class"]) == ("tbar enabled", "wait-plate on")
    assert state[f"b{position(plc, 'SET S21')}:class"] == "tbar"


def test_a_transition_fires_for_one_scan(plc):
    picture = begin(plc, SIMPLE)
    leaving = position(plc, "SET S20")
    plc["X0"] = 1
    plc.scan()
    state = picture.state(plc)
    assert (state[f"b{leaving}:class"], state[f"p{leaving}:class"]) == ("tbar fires", "wait-plate")
    assert (state["S0:class"], state["S20:class"]) == ("step", "step active")
    plc.scan()
    state = picture.state(plc)
    assert state[f"b{leaving}:class"] == "tbar"
    assert state[f"e{position(plc, 'OUT Y0')}:class"] == "action on"


def test_the_contacts_of_a_condition_show_how_far_it_holds(plc):
    picture = begin(plc, SIMPLE)
    plc["X0"] = 1
    plc.scan(2)
    first = position(plc, "LD X1")
    assert [picture.state(plc)[f"e{first + n}:class"] for n in range(3)] == ["contact open"] * 3
    plc["X1"] = 1
    plc.scan()
    assert [picture.state(plc)[f"e{first + n}:class"] for n in range(3)] == ["contact flow", "contact open", "contact open"]
    plc["X2"] = 1
    plc.scan()
    assert [picture.state(plc)[f"e{first + n}:class"] for n in range(3)] == ["contact flow"] * 3


def test_a_contact_of_a_resting_step_shows_what_it_is_without_power(plc):
    picture = begin(plc, SIMPLE)
    plc["X1"] = 1
    plc.scan()
    assert picture.state(plc)[f"e{position(plc, 'LD X1')}:class"] == "contact closed"


def test_a_join_says_who_is_missing(plc):
    picture = begin(plc, PARALLEL)
    plc["X0"] = 1
    plc.scan(2)
    key = max(i.position for i in plc.program.instructions if str(i) == "STL S22")
    state = picture.state(plc)
    assert (state[f"j{key}.S22:class"], state[f"j{key}.S21:class"]) == ("arrive", "arrive here")
    assert state[f"w{key}:text"] == "waits for S22"
    plc["X1"] = 1
    plc.scan(2)
    state = picture.state(plc)
    assert state[f"w{key}:text"] == ""
    assert state[f"b{position(plc, 'SET S23')}:class"] == "tbar enabled"


def test_a_timer_of_a_step_shows_its_value(plc):
    picture = begin(plc, SIMPLE)
    plc.set({"X0": 1, "X1": 0, "X2": 1, "X3": 1})
    plc.scan(2)
    plc["X1"] = 1
    plc.scan(30)
    assert picture.state(plc)[f"v{position(plc, 'TON T0 30')}:text"] == "2"


def test_a_session_tells_since_when_a_step_is_active(plc):
    begin(plc, SIMPLE)
    session = Session(plc, name="chart of a step")
    picture = chart(plc.program)
    plc["X0"] = 1
    session.scan(1)
    session.scan(25)
    state = picture.state(session)
    assert (state["tS20:text"], state["tS0:text"]) == ("0.25 s", "")


def test_without_a_trace_the_memory_speaks(plc):
    picture = begin(plc, SIMPLE)
    plc.tracing = False
    plc["X0"] = 1
    plc.scan(2)
    state = picture.state(plc)
    assert (state["S20:class"], state[f"e{position(plc, 'OUT Y0')}:class"]) == ("step active", "action on")
    assert "tbar fires" not in state.values()
