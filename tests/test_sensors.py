"""Faults of sensors and machines: what comes to the inputs, when, in sessions, on the way back and in grading."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar, NamedTuple

import pytest

from ecsim import EcsimError, Plc, Session
from ecsim.grading import Count, Do, Exercise, Never, Scenario

COUNTER = """LD X0
EU
INC D0
LD X0
OUT Y0
LD SM0
MOV D2 D3"""


class Point(NamedTuple):
    """A terminal as a plant describes it."""

    name: str
    what: str = ""


@dataclass
class Lever:
    """A sensor X0 that is ON from `on_s` to `off_s`, a scale D2 that shows whole seconds, a switch X5 for the hand; it can stick."""

    wiring: ClassVar[dict[str, Point]] = {"X0": Point("Out"), "D2": Point("Scale"), "X5": Point("Start"), "Y0": Point("Push")}
    FAULTS: ClassVar[dict[str, str]] = {"sticks": "the lever does not move"}

    on_s: float = 0.1
    off_s: float = 0.5
    seconds: float = 0.0
    faults: frozenset = frozenset()
    moved: list = field(default_factory=list)

    def fail(self, fault, on=True):
        self.faults = frozenset({fault}) if on else frozenset()

    def step(self, seconds, outputs):
        if not self.faults:
            self.seconds = round(self.seconds + seconds, 9)
        return {"X0": int(self.on_s <= self.seconds < self.off_s), "D2": int(self.seconds)}


@pytest.fixture
def make():
    """A session whose scans the test makes, of 10 ms each."""

    def make(program=COUNTER, filter_ms=0, **more):
        plc = Plc("EC20", scan_ms=10, input_filter_ms=filter_ms)
        plc.load(program)
        plc.run()
        return Session(plc, Lever(**more), name="test")

    return make


def levels(session, scans, device="X0"):
    """What the program saw of an input in each of so many scans."""
    seen = []
    for _ in range(scans):
        session.scan()
        seen.append(session.plc[device])
    return seen


# ---- what each fault does ----------------------------------------------------------------------------------------------


def test_a_healthy_sensor_is_on_from_the_scan_behind_its_edge(make):
    # ON after 10 scans of 10 ms, so the eleventh sees it; OFF after 50
    assert levels(make(), 60) == [0] * 10 + [1] * 40 + [0] * 10


@pytest.mark.parametrize("level", [0, 1])
def test_a_stuck_sensor_says_the_same_whatever_happens(make, level):
    session = make()
    session.fail(f"X0 stuck {level}")
    assert levels(session, 60) == [level] * 60


def test_an_inverted_sensor_says_the_opposite(make):
    session = make()
    session.fail("X0 inverted")
    assert levels(session, 60) == [1] * 10 + [0] * 40 + [1] * 10


@pytest.mark.parametrize(("delay_s", "scans"), [(0.2, 20), (0.205, 21), (0.01, 1), (1.3, 130)])
def test_a_delayed_sensor_says_it_later_and_loses_nothing(make, delay_s, scans):
    session = make()
    session.fail(f"X0 delayed {delay_s}")
    assert levels(session, 60 + scans) == [0] * (10 + scans) + [1] * 40 + [0] * 10


def test_a_delayed_edge_comes_between_scans_at_its_own_time(make):
    """The filter of 10 ms begins at 0.1 s + 12 ms: it has let the level pass at 0.122 s, and the scan at 0.13 s sees it."""
    session = make(filter_ms=10)
    session.fail("X0 delayed 0.012")
    assert levels(session, 20).index(1) == 13
    later = make(filter_ms=10)
    later.fail("X0 delayed 0.0101")  # passed at 0.1201 s, a moment behind the scan at 0.12 s
    assert levels(later, 20).index(1) == 13
    earlier = make(filter_ms=10)
    earlier.fail("X0 delayed 0.0099")  # passed at 0.1199 s
    assert levels(earlier, 20).index(1) == 12


def test_a_contact_bounces_for_its_time_and_is_then_at_rest(make):
    session = make()
    session.fail("X0 bounces 80")
    seen = levels(session, 60)
    assert seen[:10] == [0] * 10  # before the edge
    assert seen[10] == 1  # the edge itself is not late
    assert seen[19:50] == [1] * 31  # 80 ms behind the edge it is at rest
    assert seen[59] == 0
    assert seen[10:19].count(0) + seen[50:59].count(1) > 0


def test_a_bouncing_contact_is_counted_more_than_once_and_a_filter_helps(make):
    counts = []
    for filter_ms in (0, 60):
        session = make(filter_ms=filter_ms, off_s=2.0)
        session.fail("X0 bounces 50")
        session.scan(100)
        counts.append(session.plc["D0"])
    assert counts[0] > 1
    assert counts[1] == 1


def test_a_fast_counter_counts_bounces_that_no_scan_sees(make):
    session = make("LD SM0\nHCNT C236 1000", off_s=2.0)
    session.fail("X0 bounces 4")  # over before the next scan
    session.scan(100)
    assert 2 <= session.plc["C236"] <= 4  # the edge and one to three bounces


def test_seeds_give_other_bounces_and_the_same_seed_the_same(make):
    def run(seed):
        session = make("LD SM0\nHCNT C236 1000", off_s=0.2)
        session.fail(f"X0 bounces 9 {seed}")
        seen = levels(session, 30, "C236")
        return tuple(seen)

    assert run(3) == run(3)
    assert len({run(seed) for seed in range(8)}) > 1


def test_a_value_can_stick_and_comes_back(make):
    session = make()
    session.scan(150)
    session.fail("Scale stuck 7")
    session.scan(100)
    assert (session.plc["D2"], session.plc["D3"], session.plant.seconds) == (7, 7, 2.5)
    session.mend("Scale")
    session.scan()
    assert session.plc["D3"] == 2


# ---- in and out --------------------------------------------------------------------------------------------------------


def test_a_fault_acts_at_once_and_mending_shows_what_the_sensor_says(make):
    session = make()
    session.scan(20)
    session.fail("Out stuck 0")
    assert (session.plc.inputs.terminals[0], session.faults) == (False, ["X0 stuck 0"])
    session.fail("X0 inverted")  # a sensor has one fault at a time
    assert session.faults == ["X0 inverted"]
    session.mend("X0")
    assert (session.plc.inputs.terminals[0], session.faults) == (True, [])


def test_mending_ends_what_is_on_its_way(make):
    session = make()
    session.fail("X0 delayed 0.3")
    session.scan(12)  # the edge at 0.1 s would come at 0.4 s
    session.mend()
    assert levels(session, 60) == [1] * 38 + [0] * 22


def test_a_fault_of_the_machine_goes_the_same_way(make):
    session = make()
    session.scan(5)
    session.fail("sticks")
    session.fail("X0 inverted")
    session.scan(50)
    assert (session.faults, session.plant.seconds) == (["sticks", "X0 inverted"], 0.05)
    session.mend("sticks")
    assert session.faults == ["X0 inverted"]
    session.mend()
    session.scan(10)
    assert (session.faults, session.plc["X0"]) == ([], 1)


def test_faults_wait_while_the_inputs_are_in_the_hand(make):
    session = make()
    session.fail("X0 stuck 1")
    session.plant_on = False
    session.set("X0", 0)
    assert levels(session, 5) == [0] * 5
    session.fail("X0 inverted")
    assert levels(session, 5) == [0] * 5
    session.plant_on = True
    assert levels(session, 5) == [1] * 5


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("rusts", "there is no fault 'rusts'; the machine has sticks, a sensor is stuck 0 or 1, inverted, delayed or bounces"),
        ("", "there is no fault ''"),
        ("X5 stuck 1", "the machine has no sensor 'X5'; it has X0 Out, D2 Scale"),
        ("X0 stuck", "'X0 stuck' is no fault: stuck needs a number (level)"),
        ("X0 stuck high", "stuck needs a number (level)"),
        ("X0 stuck nan", "stuck needs a number (level)"),
        ("X0 stuck 2", "2"),
        ("X0 inverted 1", "no number follows inverted"),
        ("X0 delayed", "delayed needs a number (s)"),
        ("X0 delayed 0", "0.001 to 600"),
        ("X0 delayed 1 2", "delayed needs a number (s)"),
        ("X0 bounces 5000", "0.1 to 1000"),
        ("X0 bounces 5 1.5", "bounces needs a number (ms)"),
        ("Scale inverted", "D2 is no contact but a value; it can be stuck only"),
        ("Scale stuck 70000", "70000"),
    ],
)
def test_what_is_no_fault_is_refused_in_words_and_changes_nothing(make, text, words):
    session = make()
    session.fail("X0 stuck 1")
    with pytest.raises(EcsimError) as refusal:
        session.fail(text)
    assert words in str(refusal.value)
    assert session.faults == ["X0 stuck 1"]


def test_what_is_not_there_cannot_be_mended(make):
    session = make()
    with pytest.raises(EcsimError, match="no sensor 'X7'"):
        session.mend("X7")


def test_without_a_machine_there_are_no_sensors():
    plc = Plc("EC20")
    with pytest.raises(EcsimError, match="no sensor 'X0'; it has none"):
        Session(plc, name="test").fail("X0 stuck 1")


# ---- the way back ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("fault", ["X0 delayed 0.07", "X0 bounces 90", "X0 inverted", "X0 stuck 1", "sticks"])
def test_the_way_back_and_forth_shows_the_same_inputs(make, fault):
    session = make(off_s=0.3)
    session.scan(5)
    session.fail(fault)
    seen = levels(session, 60)
    for behind in (50, 20, 7, 1):
        assert session.seek(session.tip.scan - behind)
        assert levels(session, behind) == seen[-behind:]
    assert session.back(62)
    assert session.faults == []
    assert levels(session, 12) == [0] * 7 + [1] * 5  # nothing was wrong yet, and on this way nothing becomes so


def test_reset_begins_without_faults(make):
    session = make()
    session.fail("X0 stuck 1")
    session.scan(3)
    session.reset()
    assert (session.faults, session.plc["X0"]) == ([], 0)


# ---- grading -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def exercise(tmp_path):
    """A lever that is to be counted once, though its contact bounces; and a stuck one, which is never to be followed."""
    folder = Path(tmp_path)
    scenarios = [
        Scenario("bounces", "The contact is worn", 1.0, script=[Do(at=0.02, fail="Out bounces 60")]),
        Scenario("stuck", "The sensor sticks and is mended", 1.0, script=[Do(at=0.2, fail="X0 stuck 0"), Do(at=0.3, mend="Out")]),
        Scenario("jam", "The lever sticks", 1.0, script=[Do(at=0.05, fail="sticks"), Do(at=0.55, mend="all")]),
    ]
    rules = [
        Count("once", "It is counted once", "Push", least=1, most=1, scenarios=("bounces",)),
        Never("follows", "The output follows the input", "Push and not Out", grace=1, needs="Out"),
        Count("twice", "A broken wire is seen as two", "Push", least=2, most=2, scenarios=("stuck",)),
        Count("later", "A lever that is mended arrives", "held(Push, 0.3)", least=1, most=1, scenarios=("jam",)),
    ]
    return Exercise(folder, "lever", Lever, scenarios, rules)


def test_a_scenario_switches_faults_in_and_out(exercise):
    report = exercise.grade("LD X0\nOUT Y0")
    verdicts = {verdict.rule: verdict.state for verdict in report.verdicts}
    assert verdicts == {"once": "failed", "follows": "passed", "twice": "passed", "later": "passed"}


def test_the_replay_of_a_failure_has_the_fault(exercise):
    report = exercise.grade("LD X0\nOUT Y0")
    failure = next(one for one in report.verdicts if one.rule == "once").failure
    replay = report.replay("once", seconds=0.5)
    before = replay.plc["X0"]
    again = Session(replay.plc, replay.plant, name="a lab of its own")
    assert again.faults == ["X0 bounces 60"]
    seen = levels(again, round(failure.second * 100) - replay.plc.scans + 60)
    rises = sum(b > a for a, b in zip([before, *seen], seen, strict=False))
    assert rises >= 2
