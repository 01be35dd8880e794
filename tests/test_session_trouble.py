"""Session when things go wrong or come at an awkward moment: failing plants, observers that meddle, the way back."""

import threading
from dataclasses import dataclass
from typing import ClassVar

import pytest

from ecsim import EcsimError, Plc, Session

COUNT = "LD SM0\nINC D0"
WAIT = 5.0


def running_plc(text: str = COUNT) -> Plc:
    plc = Plc(input_filter_ms=0)
    plc.load(text)
    plc.run()
    return plc


def happens(session: Session, condition) -> bool:
    """Whether a condition comes true while observers are called."""
    seen = threading.Event()
    leave = session.observe(lambda s: seen.set() if condition(s) else None)
    try:
        return condition(session) or seen.wait(WAIT)
    finally:
        leave()


@dataclass
class Belt:
    """A plant without a memory of its own: its attributes are all there is."""

    wiring: ClassVar = {"Y0": None, "X0": None}
    position: int = 0
    jams_at: int = 1_000_000

    def step(self, seconds: float, outputs: dict[str, int]) -> dict[str, int]:
        self.position += 1
        if self.position == self.jams_at:
            raise ValueError("jammed")
        return {"X0": self.position % 2}


def test_an_observer_may_stop_the_session():
    session = Session(running_plc(), name="stopped by an observer", speed=None)
    ended = threading.Event()

    def look(session):
        if session.plc["D0"] >= 10:
            session.stop()
        if session.state == "stopped":
            ended.set()

    session.observe(look)
    session.start()
    assert ended.wait(WAIT)
    assert session.error is None


def test_an_observer_may_pause_and_go_on_scan_by_scan():
    session = Session(running_plc(), name="paused by an observer", speed=None)
    done = threading.Event()

    def look(session):
        if session.plc["D0"] >= 10 and not done.is_set():
            session.scan(3)
            done.set()

    session.observe(look)
    session.start()
    assert done.wait(WAIT)
    assert session.state == "paused"
    session.stop()


def test_a_session_stopped_and_started_by_its_own_observer_runs_one_loop():
    session = Session(running_plc(), name="restarted by an observer", speed=None)
    again = threading.Event()

    def look(session):
        if not again.is_set():
            session.stop()
            session.start()
            again.set()

    session.observe(look)
    session.start()
    first = session._thread
    assert again.wait(WAIT)
    if first is not session._thread:
        first.join(WAIT)
    assert sum(thread.name == "ecsim restarted by an observer" for thread in threading.enumerate()) == 1
    session.stop()


def test_observers_are_called_in_the_sessions_thread_also_for_what_a_cell_does():
    session = Session(running_plc(), name="observed", speed=None)
    callers, told = [], threading.Event()

    def look(session):
        callers.append(threading.current_thread())
        if session.state == "paused":
            told.set()

    session.observe(look)
    session.start()
    thread = session._thread
    session.pause()
    assert told.wait(WAIT)
    assert set(callers) == {thread}
    session.stop()


def test_after_a_failure_reset_lets_it_run_again():
    plant = Belt(jams_at=5)
    session = Session(running_plc(), plant=plant, name="jam", speed=None)
    session.start()
    assert happens(session, lambda s: s.state == "failed")
    with pytest.raises(EcsimError, match=r"jammed; reset\(\) begins anew"):
        session.run()
    session.reset()
    plant.jams_at = 1_000_000
    session.run()
    assert happens(session, lambda s: s.plc["D0"] > 20)
    session.stop()


def test_stop_raises_what_went_wrong_inside():
    session = Session(running_plc(), plant=Belt(jams_at=3), name="jam told")
    session.start()
    assert happens(session, lambda s: s.state == "failed")
    with pytest.raises(ValueError, match="jammed"):
        session.stop()


def test_a_plant_needs_nothing_but_wiring_and_step_for_the_way_back():
    plant = Belt()
    session = Session(running_plc(), plant=plant, name="bare plant")
    session.scan(8)
    assert session.back(3)
    assert plant.position == 6  # it was asked once before the first scan
    session.reset()
    assert plant.position == 1


def test_an_action_before_a_keyframe_is_not_done_twice_on_the_way_back():
    session = Session(running_plc(), name="keyframe")
    session.scan(100)  # the next keyframe is taken here
    session.post(lambda plc: plc.set({"D1": plc["D1"] + 1}))
    session.scan(7)
    assert session.back(3)
    assert (session.plc["D0"], session.plc["D1"]) == (104, 1)


def test_going_back_too_far_forgets_nothing():
    session = Session(running_plc(), name="too far")
    session.scan(5)
    assert not session.back(50)
    assert session.back(2)
    assert session.plc["D0"] == 3


def test_next_step_names_the_step_that_begins():
    session = Session(running_plc("LD SM1\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\nLDI X0\nOUT S0\nRET"), name="steps")
    assert session.next_step() == "S0"
    session.set("X0", 1)
    assert session.next_step() == "S20"
    session.set("X0", 0)
    assert session.next_step() == "S0"  # S20 ends in the same scan


@pytest.mark.parametrize("stop", [False, True])
def test_next_step_gives_up_at_once_where_no_step_can_change(stop):
    plc = running_plc("LD SM1\nSET S0" if stop else COUNT)
    if stop:
        plc.stop()
    session = Session(plc, name="no steps")
    assert session.next_step() is None
    assert plc.scans == 1


@pytest.mark.parametrize("speed", [0, -1, 2_000_000, "fast", float("nan")])
def test_a_wrong_speed_is_refused_from_the_beginning(speed):
    with pytest.raises(EcsimError, match="factor above 0"):
        Session(running_plc(), speed=speed)


def test_there_is_no_way_back_across_another_program():
    session = Session(running_plc(), name="another program")
    session.scan(10)
    session.plc.load("LD X0\nEU\nOUT Y0\nLD X1\nEU\nCTU C0 5")
    session.plc.run()
    assert not session.back(3)
    session.scan(3)
    assert session.plc.scans == 13


def test_reset_begins_anew_with_the_program_that_is_loaded_now():
    plant = Belt()
    session = Session(running_plc(), plant=plant, name="reset another program")
    session.scan(10)
    session.plc.load("LD SM1\nEU\nSET Y1")
    session.reset()
    session.scan()
    assert (plant.position, session.plc["Y1"]) == (2, 1)  # asked once when the session was made, then moved by one scan


def test_a_snapshot_of_another_program_is_refused():
    plc = running_plc()
    snapshot = plc.snapshot()
    plc.load("LD X0\nEU\nOUT Y0")
    with pytest.raises(EcsimError, match="taken with another program"):
        plc.restore(snapshot)


def test_forcing_a_device_does_not_begin_the_active_step_again():
    session = Session(running_plc("LD SM1\nSET S0\nSTL S0\nOUT Y0\nLD X0\nRST S0\nRET"), name="forced in a step")
    session.scan(5)
    since, changes = dict(session.step_since), list(session.log)
    session.post(lambda plc: plc.force("Y5", 1))
    session.scan(5)
    assert (session.step_since, list(session.log)) == (since, changes)


def test_a_session_refuses_at_once_what_the_plc_would_refuse_later():
    session = Session(running_plc(), name="refusing")
    with pytest.raises(EcsimError, match="SM0 cannot be written"):
        session.set("SM0", 0)
    with pytest.raises(EcsimError, match="back by 0 scans"):
        session.back(0)
