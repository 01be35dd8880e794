"""Control of a session: breakpoints, conditions, transitions held and fired by hand, the past and the ways out of it."""

from dataclasses import dataclass, field

import pytest

from ecsim import EcsimError, Plc, Session
from ecsim.conditions import condition

# Two steps: S0 until X0, S20 for 300 ms; D0 counts scans.
FLOW = """VAR_GLOBAL
  Lamp AT Y0
  Total AT D4
END_VAR
PROGRAM MAIN
LD SM1
SET S0
STL S0
LD X0
SET S20
STL S20
OUT Lamp
LD SM0
TON T0 3
LD T0
OUT S0
RET
LD SM0
INC D0
LD X5
INC D1
END_PROGRAM"""

# S0 leads to S20 and S30 at once; they meet in S40, which has a choice: X1 back to S0, X2 to S50, which ends itself by X3.
BRANCHES = """LD SM1
SET S0
STL S0
LD X0
SET S20
SET S30
STL S20
OUT Y0
STL S30
OUT Y1
STL S20
STL S30
LD X4
SET S40
STL S40
LD X1
OUT S0
LD X2
SET S50
STL S50
LD X3
RST S50
RET"""


@dataclass
class Gate:
    """A plant: Y0 opens the gate, X0 tells that it has been shut for 50 ms."""

    wiring: dict = field(default_factory=lambda: {"Y0": None, "X0": None})
    shut_s: float = 0.0

    def step(self, seconds, outputs):
        self.shut_s = 0.0 if outputs["Y0"] else self.shut_s + seconds
        return {"X0": int(self.shut_s > 0.049)}


@dataclass
class Shut:
    """A plant whose sensor is ON from the beginning."""

    wiring: dict = field(default_factory=lambda: {"X0": None, "D9": None})

    def step(self, seconds, outputs):
        return {"X0": 1, "D9": 7}


def make(text=FLOW, plant=None, engine="compiled", run=True, filter_ms=0):
    plc = Plc("EC20", input_filter_ms=filter_ms)
    plc.load(text)
    if run:
        plc.run()
    plc.engine = engine
    return Session(plc, plant=plant, name="control")


def steps(session):
    """The active steps."""
    return [str(step) for step in session.plc.in_use(("S",)) if session.plc[str(step)]]


# -- conditions ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("X1", True),
        ("X2", False),
        ("not X2", True),
        ("NOT X2 AND X1", True),
        ("D0 > 100", True),
        ("D0 > 100 and X2", False),
        ("D0 > 100 and X2 or X1", True),
        ("D0 > 100 and (X2 or not X1)", False),
        ("D0 = 101", True),
        ("D0 <> 101", False),
        ("16#65 == D0", True),
        ("D1 = -5", True),
        ("D1 < D0", True),
        ("D10:REAL >= 2.5", True),
        ("D10:REAL < 2.5", False),
        ("Lamp", True),
        ("total = 0", True),
        ("T0", False),
        ("T0 = 0", True),
        ("K2M0 = 3", True),
    ],
)
def test_a_condition_reads_devices_names_and_numbers(text, holds):
    session = make(run=False)
    session.plc.set({"X1": 1, "D0": 101, "D1": -5, "D10:REAL": 2.5, "Y0": 1, "K2M0": 3})
    session.plc.scan()
    assert condition(session.plc, text)() is holds


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "missing"),
        ("D0", "is a value; compare it"),
        ("X1 and", "missing"),
        ("X1 X2", "'X2' was not expected"),
        ("(X1", "not closed"),
        ("X9", "X9"),
        ("5", "says nothing by itself"),
        ("D0 > X", "X"),
        ("__import__('os')", "no meaning"),
        ("D0 > 1.2.3", "no meaning"),
        ("not " * 50 + "X1", "nested"),
        ("D99999 = 1", "D99999"),
    ],
)
def test_what_is_no_condition_is_refused_in_words(text, why):
    with pytest.raises(EcsimError, match="is no condition") as refusal:
        condition(make().plc, text)
    assert why in str(refusal.value)


# -- until --------------------------------------------------------------------------------------------------------


def test_until_moves_the_plant_too():
    session = make(plant=Gate())
    assert session.until("Lamp") == 60  # shut for 50 ms after five scans, seen by the sixth
    assert session.state == "stopped"
    assert session.until("D0 >= 10 and not X5") == 40


def test_until_raises_when_it_does_not_happen():
    with pytest.raises(EcsimError, match="Y1 did not come true within 200 ms"):
        make(plant=Gate()).until("Y1", timeout_ms=200)
    with pytest.raises(EcsimError, match=r"in STOP, run\(\) starts it"):
        make(run=False).until("Y1", timeout_ms=50)


# -- the plant's first answers ------------------------------------------------------------------------------------


@pytest.mark.parametrize("filter_ms", [0, 10])
def test_the_first_scan_sees_what_the_plant_says(filter_ms):
    session = make("LD SM1\nAND X0\nSET M0\nLD SM1\nMOV D9 D20", plant=Shut(), run=False, filter_ms=filter_ms)
    session.plc.run()
    session.scan()
    assert session.plc["M0"] == 1


def test_after_a_reset_the_first_scan_sees_it_too():
    session = make("LD SM1\nAND X0\nSET M0", plant=Shut(), run=False, filter_ms=10)
    session.scan(3)
    session.reset()
    session.scan()
    assert session.plc["M0"] == 1


# -- breakpoints --------------------------------------------------------------------------------------------------


def test_a_run_stops_when_a_condition_becomes_true():
    session = make(plant=Gate())
    session.breakpoints.add("S20")
    session.breakpoints.add("D0 > 30")
    session.scan(1000)
    assert (session.hit.text, session.plc.scans) == ("S20", 6)
    session.scan(1000)
    assert (session.hit.text, session.plc["D0"]) == ("D0 > 30", 31)
    session.scan(1000)
    assert (session.hit.text, session.breakpoints["S20"].hits, session.breakpoints["D0 > 30"].hits) == ("S20", 2, 1)
    assert [(mark.kind, mark.words) for mark in session.marks] == [("breakpoint", "S20"), ("breakpoint", "D0 > 30"), ("breakpoint", "S20")]


def test_what_is_true_already_does_not_stop_a_run():
    session = make()
    session.scan(5)
    session.breakpoints.add("D0 > 3")
    session.scan(5)
    assert (session.hit, session.plc.scans) == (None, 10)


def test_a_breakpoint_may_be_switched_off_and_on_and_taken_away():
    session = make()
    point = session.breakpoints.add("D0 = 5")
    session.breakpoints.enable("D0 = 5", False)
    session.scan(10)
    assert (session.hit, point.hits, point.enabled) == (None, 0, False)
    session.breakpoints.add("D0 = 15")
    session.scan(10)
    assert session.plc["D0"] == 15
    session.breakpoints.remove("D0 = 15")
    assert [each.text for each in session.breakpoints] == ["D0 = 5"]
    with pytest.raises(EcsimError, match="there is no breakpoint 'D0 = 15'; there are D0 = 5"):
        session.breakpoints.remove("D0 = 15")


def test_a_breakpoint_whose_name_the_next_program_does_not_know_rests():
    session = make()
    session.breakpoints.add("Lamp")
    session.plc.load("LD SM0\nINC D0")
    session.plc.run()
    session.scan(3)
    assert "Lamp" in session.breakpoints["Lamp"].problem
    session.plc.load(FLOW)
    session.plc.run()
    session.scan()
    assert session.breakpoints["Lamp"].problem == ""


def test_the_way_through_the_past_meets_no_breakpoint_twice():
    session = make(plant=Gate())
    session.breakpoints.add("S20")
    session.scan(100)
    session.scan(10)
    assert session.back(12)
    assert (session.hit, session.breakpoints["S20"].hits, len(session.marks)) == (None, 1, 1)
    session.scan(100)
    assert (session.hit.text, session.breakpoints["S20"].hits, session.plc.scans) == ("S20", 2, 6)


def test_next_step_and_until_stop_at_a_breakpoint():
    session = make(plant=Gate())
    session.scan(2)
    session.breakpoints.add("D0 = 4")
    assert session.next_step() is None
    assert session.plc["D0"] == 4
    session.breakpoints.add("D0 = 5")
    with pytest.raises(EcsimError, match="the breakpoint D0 = 5 stopped the run after 10 ms"):
        session.until("Lamp")


# -- the chart by hand --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_held_transitions_leave_the_steps_as_they_are(engine):
    session = make(BRANCHES, engine=engine)
    session.set("X0", 1)
    session.transitions_held = True
    session.scan(5)
    assert steps(session) == ["S0"]  # the ladder before the chart begins it; its transition does nothing
    session.transitions_held = False
    session.scan()
    assert steps(session) == ["S20", "S30"]
    session.transitions_held = True
    session.set("X4", 1)
    session.scan(3)
    assert steps(session) == ["S20", "S30"]
    assert (session.plc["Y0"], session.plc["Y1"]) == (1, 1)  # their actions go on
    session.set_step("S50")
    session.set("X3", 1)
    session.scan(3)
    assert "S50" in steps(session)  # it does not end itself
    session.transitions_held = False
    session.scan(2)
    assert steps(session) == ["S40"]


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_a_transition_is_fired_by_hand(engine):
    session = make(BRANCHES, engine=engine)
    session.scan()
    session.fire("S0")
    assert steps(session) == ["S20", "S30"]
    assert [(change.step, change.active) for change in session.log][-3:] == [("S0", False), ("S20", True), ("S30", True)]
    session.fire("S20")  # the join takes both
    assert steps(session) == ["S40"]
    session.fire("S40", to="S50")
    assert steps(session) == ["S50"]
    session.fire("S50")
    assert steps(session) == []


@pytest.mark.parametrize(
    ("step", "to", "why"),
    [
        ("S40", None, "2 transitions lead out of S40, to S0, S50"),
        ("S40", "S20", "no transition leads from S40 to S20; it leads to S0, S50"),
        ("S20", None, "S20 and S30 are not active"),
        ("S50", None, "S50 is not active"),
        ("S99", None, "no transition leads out of S99"),
        ("M5", None, "no transition leads out of M5"),
    ],
)
def test_what_cannot_be_fired_is_refused_and_changes_nothing(step, to, why):
    session = make(BRANCHES)
    session.scan()
    with pytest.raises(EcsimError) as refusal:
        session.fire(step, to)
    assert why in str(refusal.value)
    assert steps(session) == ["S0"]


def test_a_step_is_set_and_reset_by_hand():
    session = make(BRANCHES)
    session.scan()
    session.set_step("S40")
    session.set_step("S0", False)
    assert steps(session) == ["S40"]
    with pytest.raises(EcsimError, match="D5 is no step"):
        session.set_step("D5")


def test_what_the_hand_does_to_the_chart_is_repeated_on_the_way_back():
    session = make(BRANCHES)
    session.scan(3)
    session.fire("S0")
    session.scan(3)
    session.transitions_held = True
    session.set("X4", 1)
    session.scan(3)
    assert session.seek(5)
    assert (steps(session), session.transitions_held) == (["S20", "S30"], False)
    assert session.seek(9)
    assert (steps(session), session.transitions_held) == (["S20", "S30"], True)
    assert session.seek(2)
    assert steps(session) == ["S0"]


# -- the past -----------------------------------------------------------------------------------------------------


def test_the_past_can_be_looked_at_without_losing_what_came_later():
    session = make(plant=Gate())
    for scan in range(300):
        if scan in (50, 250):
            session.set("X5", int(scan == 50))
        session.scan()
    seen = {}
    for scan in (10, 299, 51, 5, 251, 260, 0):
        assert session.seek(scan)
        seen[scan] = session.plc["D0"], session.plc["D1"]
        assert (session.plc.scans, session.in_past, session.tip.scan) == (scan, True, 300)
    assert seen == {10: (10, 0), 299: (299, 200), 51: (51, 1), 5: (5, 0), 251: (251, 200), 260: (260, 200), 0: (0, 0)}
    assert session.seek(300)
    assert (session.in_past, session.plc["D1"]) == (False, 200)


def test_there_is_nothing_beyond_the_newest_moment_or_before_the_first():
    session = make()
    session.scan(10)
    assert not session.seek(11)
    assert not session.seek(-1)
    assert (session.plc.scans, session.in_past) == (10, False)


@pytest.mark.parametrize("what", ["scan", "write", "receive", "edit"])
def test_what_happens_in_the_past_begins_another_way(what):
    session = make()
    session.scan(20)
    session.set("X5", 1)
    session.scan(20)
    session.seek(15)
    if what == "scan":
        session.scan()
    elif what == "write":
        session.set("D7", 5)
    elif what == "receive":
        with session.held():
            session.receive("D", 7, [5])
    else:
        session.edit(FLOW.replace("INC D1", "INC D2"))
    assert not session.in_past
    assert session.tip.scan == session.plc.scans
    assert not session.seek(30)
    session.scan(30)
    assert session.plc["D1"] == 0  # X5 was switched on in the other future
    assert session.seek(15)
    assert session.plc["D0"] == 15


# -- looking on ---------------------------------------------------------------------------------------------------


def test_only_the_scan_that_is_shown_is_traced():
    session = make(plant=Gate())
    session.trace_frames = True
    traced = []
    session.each_scan(lambda: traced.append(session.plc.tracing))
    session.scan(5)
    assert traced == [False, False, False, False, True]
    traced.clear()
    assert session.until("Lamp") == 10
    assert session.plc.tracing
    set_s20 = next(i.position for i in session.plc.program.instructions if str(i) == "SET S20")
    assert session.plc.trace.flow[set_s20] is True  # the scan in which it came true
    session.back(1)
    assert session.plc.trace.flow[set_s20] is False


def test_a_breakpoints_scan_is_traced():
    session = make(plant=Gate())
    session.trace_frames = True
    session.breakpoints.add("S20")
    session.scan(100)
    set_s20 = next(i.position for i in session.plc.program.instructions if str(i) == "SET S20")
    assert session.plc.tracing
    assert session.plc.trace.flow[set_s20] is True
    assert session.breakpoints["S20"].hits == 1


def test_each_scan_is_told_until_the_hook_is_taken_off():
    session = make()
    scans = []
    end = session.each_scan(lambda: scans.append(session.plc.scans))
    session.scan(3)
    end()
    session.scan(3)
    assert scans == [1, 2, 3]


def test_an_action_that_is_refused_is_told_and_the_session_goes_on():
    session = make()
    with pytest.raises(EcsimError, match="cannot be written"):
        session.post(lambda plc: plc.__setitem__("SD3", 1))
    session.scan()
    assert "cannot be written" in session.refused
    session.post(lambda plc: plc.__setitem__("D7", 1))
    assert session.refused == ""
    session.scan()
    assert session.back(2)  # the refused action is repeated, and refused again


def test_faults_of_the_program_are_marked():
    session = make("LD X0\nMOV 9000 Z0\nLD X1\nMOV 5 D7Z0")
    session.scan(3)
    session.plc.set({"X0": 1, "X1": 1})
    session.scan(5)
    assert [(mark.kind, mark.scan) for mark in session.marks] == [("fault", 4)]
    assert session.marks[0].words.startswith("Error 65, ")
