"""Session: a machine and its plant, run, paused, stepped, taken back and paced. What happens when things go wrong stands in test_session_trouble.py."""

import asyncio
import random
import threading
from dataclasses import dataclass, field
from itertools import pairwise

import pytest

import ecsim.session
from ecsim import EcsimError, Plc, Recording, Session

WAIT_S = 20  # long beyond what is needed; a test that waits so long has failed

FLOW = """VAR_GLOBAL
  Lamp AT Y0
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


@dataclass
class Gate:
    """A plant: Y0 opens the gate, X0 tells that it has been shut for 50 ms. It keeps what it was told."""

    wiring: dict = field(default_factory=lambda: {"Y0": None, "X0": None})
    shut_s: float = 0.0
    told: list = field(default_factory=list)

    def step(self, seconds, outputs):
        self.told.append((round(seconds, 6), dict(outputs)))
        self.shut_s = 0.0 if outputs["Y0"] else self.shut_s + seconds
        return {"X0": int(self.shut_s > 0.049)}

    def state(self):
        return self.shut_s

    def restore(self, state):
        self.shut_s = state


@pytest.fixture
def make():
    """Make sessions; all of them have ended when the test has."""
    made = []

    def session(text=FLOW, plant=None, run=True, name="test", **more):
        plc = Plc("EC20", input_filter_ms=0)
        plc.load(text)
        if run:
            plc.run()
        made.append(Session(plc, plant=plant, name=name, **more))
        return made[-1]

    yield session
    for session in made:
        session._end()


def happens(session, condition):
    """Whether a condition comes true; it is looked at whenever the observers are called."""
    seen = threading.Event()
    leave = session.observe(lambda s: seen.set() if condition(s) else None)
    try:
        return condition(session) or seen.wait(WAIT_S)
    finally:
        leave()


# -- start and stop -----------------------------------------------------------------------------------------------


def test_a_started_session_runs_the_plc_in_a_thread_of_its_own(make):
    session = make(speed=None)
    assert session.start() is session
    assert session.state == "running"
    assert happens(session, lambda s: s.plc["D0"] > 100)
    assert threading.current_thread().name not in {t.name for t in threading.enumerate() if t.name == "ecsim test"}
    assert [thread.daemon for thread in threading.enumerate() if thread.name == "ecsim test"] == [True]


def test_a_stopped_session_has_no_thread(make):
    session = make(speed=None).start()
    session.stop()
    assert session.state == "stopped"
    assert [thread for thread in threading.enumerate() if thread.name == "ecsim test"] == []
    assert ecsim.session._sessions.get("test") is None


def test_starting_twice_makes_one_thread(make):
    session = make(speed=None).start()
    session.start()
    assert len([thread for thread in threading.enumerate() if thread.name == "ecsim test"]) == 1


def test_a_new_session_takes_the_place_of_one_with_the_same_name(make):
    first = make(speed=None).start()
    second = make(speed=None).start()
    assert first.state == "stopped"
    assert ecsim.session._sessions.get("test") is second
    assert len([thread for thread in threading.enumerate() if thread.name == "ecsim test"]) == 1


def test_sessions_of_different_names_run_side_by_side(make):
    first, second = make(speed=None, name="one").start(), make(speed=None, name="two").start()
    assert happens(first, lambda s: s.plc.scans > 50)
    assert happens(second, lambda s: s.plc.scans > 50)
    assert (ecsim.session._sessions["one"], ecsim.session._sessions["two"]) == (first, second)


def test_a_stopped_session_can_be_started_again(make):
    session = make(speed=None).start()
    session.stop()
    before = session.plc.scans
    session.start()
    assert happens(session, lambda s: s.plc.scans > before + 10)


def test_run_puts_a_plc_in_stop_into_run_and_starts(make):
    session = make(run=False, speed=None)
    session.run()
    assert session.plc.running
    assert happens(session, lambda s: s.plc["D0"] > 10)


# -- pause and step -----------------------------------------------------------------------------------------------


def test_a_paused_session_holds_time_and_goes_on_when_it_is_run(make):
    session = make(speed=None).start()
    assert happens(session, lambda s: s.plc.scans > 10)
    session.pause()
    assert session.state == "paused"
    before = session.plc.scans
    turned = threading.Event()
    session.observe(lambda s: turned.set())
    session.post(lambda plc: None)  # the loop makes a turn to call the observers
    assert turned.wait(WAIT_S)
    assert session.plc.scans == before
    session.run()
    assert happens(session, lambda s: s.plc.scans > before + 10)


def test_so_many_scans_are_done_and_then_it_is_paused(make):
    session = make(speed=None).start()
    session.pause()
    before = session.plc.scans
    session.scan()
    session.scan(9)
    assert (session.state, session.plc.scans) == ("paused", before + 10)


def test_scans_need_no_thread(make):
    session = make()
    session.scan(7)
    assert (session.state, session.plc["D0"], session.plc.time_us) == ("stopped", 7, 70_000)


def test_the_next_step_change_is_sought_in_time_order(make):
    session = make(plant=Gate())
    seen = [(session.next_step(), session.plc.time_us // 1000) for _ in range(4)]
    # the gate has been shut for 50 ms after 5 scans; 300 ms (and the scan in which the timer begins) later it shuts again
    assert [step for step, _ in seen] == ["S0", "S20", "S0", "S20"]
    assert seen[0][1] == 10
    assert seen[1][1] == 60
    assert seen[2][1] - seen[1][1] in (300, 310)


def test_step_changes_are_logged_with_time_and_scan(make):
    session = make(plant=Gate())
    session.scan(8)
    assert [(c.time_us, c.scan, c.step, c.active) for c in session.log] == [
        (10_000, 1, "S0", True),
        (60_000, 6, "S0", False),
        (60_000, 6, "S20", True),
    ]
    assert session.step_since == {"S20": 60_000}


# -- back in time -------------------------------------------------------------------------------------------------


def everything(session):
    """All that belongs to the state of a session."""
    lists = {name: [int(value) for value in values] for name, values in session.plc.memory.lists.items()}
    shut = session.plant.shut_s if session.plant else None
    return lists | {
        "time": session.plc.time_us,
        "scans": session.plc.scans,
        "shut": shut,
        "plant": session.plant_on,
        "since": dict(session.step_since),
    }


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
@pytest.mark.parametrize("plant", [True, False], ids=["with a plant", "without"])
def test_the_way_back_leads_through_the_same_states(make, engine, plant):
    """Random switches, writes and turns of the plant's switch; then back by random ways, forward again, and back."""
    chance = random.Random(7)
    session = make(plant=Gate() if plant else None)
    session.plc.engine = engine
    states = {}
    for _ in range(330):
        if chance.random() < 0.2:
            session.set("X5", chance.randint(0, 1))
        if chance.random() < 0.1:
            value = chance.randint(0, 99)
            session.post(lambda plc, value=value: plc.__setitem__("D7", value))
        if chance.random() < 0.05:
            session.plant_on = not session.plant_on
        if chance.random() < 0.05 and not session.plant_on:
            session.set("X0", chance.randint(0, 1))
        states[session.plc.scans] = everything(session)
        session.scan()
    for _ in range(12):
        behind = chance.randint(1, 40)
        assert session.back(behind)
        assert everything(session) == states[session.plc.scans]
        for _ in range(chance.randint(0, 12)):
            session.scan()
            states[session.plc.scans] = everything(session)


def test_the_way_back_ends_where_memory_ends(make):
    session = make()
    session.scan(5)
    assert session.back(5)
    assert session.plc.scans == 0
    assert not session.back()
    assert session.plc.scans == 0


def test_a_minute_is_remembered(make):
    session = make()
    session.scan(6_500)
    assert session.back(5_900)
    assert session.plc["D0"] == 600
    session.scan(6_000)
    assert not session.back(6_400)


def test_going_back_pauses(make):
    session = make(speed=None).start()
    assert happens(session, lambda s: s.plc.scans > 30)
    assert session.back(20)
    assert session.state == "paused"


def test_a_new_program_cannot_be_gone_back_behind(make):
    session = make()
    session.scan(20)
    session.plc.load("LD SM0\nINC D2")
    session.plc.run()
    session.scan(5)
    assert not session.back(10)
    assert session.back(3)
    assert session.plc["D2"] == 2


# -- reset --------------------------------------------------------------------------------------------------------


def test_reset_begins_anew(make):
    session = make(plant=Gate())
    session.scan(100)
    session.set("X5", 1)
    session.scan(3)
    session.reset()
    assert (session.plc.time_us, session.plc["D0"], session.plant.shut_s, list(session.log), session.step_since) == (0, 0, 0.0, [], {})
    assert session.plc.running
    session.scan(8)
    assert [(c.time_us, c.step) for c in session.log if c.active] == [(10_000, "S0"), (60_000, "S20")]
    assert session.plc["D1"] == 0  # X5 is OFF again


# -- plant and actions --------------------------------------------------------------------------------------------


def test_the_plant_gets_the_outputs_and_the_time_of_a_scan_and_gives_inputs(make):
    session = make(plant=Gate())
    session.scan(8)
    # it is asked once before any time passes; 50 ms later it tells that it is shut
    assert session.plant.told == [(0.0, {"Y0": 0})] + [(0.01, {"Y0": 0})] * 5 + [(0.01, {"Y0": 1})] * 3
    assert session.plc["X0"] == 0


def test_without_the_plant_the_inputs_are_in_the_users_hand(make):
    session = make(plant=Gate())
    session.plant_on = False
    session.plant.told.clear()
    session.scan(20)
    assert session.plant.told == []
    session.set("X0", 1)
    assert session.next_step() == "S20"
    session.plant_on = True
    session.scan(3)
    assert (len(session.plant.told), session.plc["X0"]) == (3, 0)


def test_an_action_is_done_before_the_next_scan(make):
    session = make(speed=None).start()
    done = threading.Event()
    at = []

    def action(plc):
        at.append((threading.current_thread().name, plc["D1"]))
        plc["X5"] = 1
        done.set()

    session.post(action)
    assert done.wait(WAIT_S)
    assert at == [("ecsim test", 0)]
    assert happens(session, lambda s: s.plc["D1"] > 3)


@pytest.mark.parametrize(("device", "value"), [("X400", 1), ("Q", 1), ("D0", 99_999), ("M0", 2), ("X0", "on")])
def test_a_wrong_write_raises_where_it_is_asked_for(make, device, value):
    session = make()
    with pytest.raises(EcsimError):
        session.set(device, value)
    session.scan(3)
    assert session.plc["D0"] == 3


def test_names_of_the_program_can_be_written(make):
    session = make("VAR_GLOBAL\nStart AT X5\nEND_VAR\nPROGRAM MAIN\nLD Start\nINC D1\nEND_PROGRAM")
    session.set("start", 1)
    session.scan(2)
    assert session.plc["D1"] == 2


def test_the_plc_is_held_between_two_scans(make):
    session = make("LD SM0\nINC D0\nINC D1", speed=None).start()
    for _ in range(50):
        with session.held() as plc:
            before = plc.scans
            assert plc["D0"] == plc["D1"]
            assert plc.scans == before


def test_observers_end_when_they_want_to(make):
    session = make()
    calls = []
    end = session.observe(lambda s: calls.append(s.plc.scans))
    session.scan()
    end()
    session.scan()
    end()
    assert calls == [1]


def test_a_recording_follows_the_session_and_its_way_back(make):
    session = make(plant=Gate())
    session.recording = Recording(session.plc, ["Y0", "S20"])
    session.scan(50)
    # Y0 ON in scan 6; T0 is full in scan 36, 300 ms later; Y0 is cleared in scan 37 and ON again after five scans of the shut gate.
    assert session.recording.changes("Y0") == [(10_000, 0), (60_000, 1), (370_000, 0), (420_000, 1)]
    session.back(45)
    assert session.recording.changes("Y0") == [(10_000, 0)]
    session.scan(3)
    assert session.recording.changes("Y0")[-1] == (60_000, 1)


def test_a_session_tells_its_name_and_state(make):
    session = make()
    assert repr(session) == "<Session 'test' stopped>"
    session.start()
    assert repr(session) == "<Session 'test' running>"


# -- pace ---------------------------------------------------------------------------------------------------------


class Clock:
    """A wall clock that stands until it is moved."""

    def __init__(self):
        self.now = 100.0

    def perf_counter(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    """The wall clock of sessions, in the test's hand."""
    clock = Clock()
    monkeypatch.setattr(ecsim.session, "time", clock)
    return clock


def turning(session):
    """The session's loop without its thread: each `next` is one turn and gives the seconds it would wait."""
    session.state, session._loop = "running", object()
    turns = session._turns(session._loop)
    next(turns)
    return turns


@pytest.mark.parametrize(("speed", "expected"), [(1.0, 10), (2.0, 20), (0.5, 5), (10.0, 100)])
def test_simulated_time_follows_the_wall_clock_by_the_speed(make, clock, speed, expected):
    session = make(speed=speed)
    turns = turning(session)
    for _ in range(10):
        clock.now += 0.01001
        next(turns)
    assert session.plc.scans == expected


def test_what_is_due_is_not_lost_between_turns(make, clock):
    session = make(speed=1.0)
    turns = turning(session)
    for _ in range(1_000):
        clock.now += 0.003315
        next(turns)
    assert session.plc.scans == 331


def test_it_waits_for_the_next_scan_but_never_longer_than_a_frame(make, clock):
    session = make(speed=1.0)
    turns = turning(session)
    clock.now += 0.004
    assert next(turns) == pytest.approx(0.006)
    session.speed = 0.01
    clock.now += 0.004
    assert next(turns) == pytest.approx(1 / 30)


def test_a_long_delay_is_given_up_instead_of_being_made_up_for(make, clock):
    session = make(speed=1.0)
    turns = turning(session)
    clock.now += 60
    next(turns)
    assert (session.plc.scans, session.late) == (25, 1)  # a quarter of a second
    clock.now += 0.1001
    next(turns)
    assert (session.plc.scans, session.late) == (35, 1)


def test_a_change_of_speed_takes_effect_at_once(make, clock):
    session = make(speed=1.0)
    turns = turning(session)
    clock.now += 0.1001
    next(turns)
    session.speed = 5
    clock.now += 0.1001
    next(turns)
    assert session.plc.scans == 60


def test_the_time_of_a_pause_is_not_made_up_for(make, clock):
    session = make(speed=1.0)
    turns = turning(session)
    session.pause()
    clock.now += 5
    assert next(turns) == 0.25
    session.state = "running"
    clock.now += 0.05
    next(turns)
    assert session.plc.scans <= 5
    assert session.late == 0


def test_observers_are_called_thirty_times_a_second_at_most(make, clock):
    session = make(speed=1.0)
    calls = []
    session.observe(lambda s: calls.append(clock.now))
    turns = turning(session)
    for _ in range(1_000):
        clock.now += 0.002
        next(turns)
    assert 55 <= len(calls) <= 61
    assert min(later - earlier for earlier, later in pairwise(calls)) >= 1 / 30


# -- where there are no threads -----------------------------------------------------------------------------------


def test_without_threads_the_session_is_a_task_of_the_event_loop(make, monkeypatch):
    def no_thread(self):
        raise RuntimeError("can't start new thread")

    async def story():
        session = make(plant=Gate(), speed=None)
        reached = asyncio.Event()
        session.observe(lambda s: reached.set() if s.plc["D0"] > 200 else None)
        session.start()
        await asyncio.wait_for(reached.wait(), WAIT_S)
        session.pause()
        before = session.plc.scans
        session.scan(3)
        assert session.plc.scans == before + 3
        session.stop()
        assert session.state == "stopped"

    monkeypatch.setattr(threading.Thread, "start", no_thread)
    asyncio.run(story())
