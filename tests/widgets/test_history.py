"""What panels remember from scan to scan: step times, the log of steps, pulses, changed entries."""

from ecsim_widgets.history import Change, Pulses, StepTimes, changes

from ecsim.session import StepChange


def log(*entries):
    """A session's log from (milliseconds, "-S0 +S20")."""
    return [
        StepChange(milliseconds * 1000, milliseconds // 10, change[1:], change[0] == "+")
        for milliseconds, words in entries
        for change in words.split()
    ]


def test_the_usual_time_of_a_step_is_the_mean_of_its_times():
    times = StepTimes.of(log((0, "+S0"), (100, "-S0 +S20"), (300, "-S20 +S0"), (400, "-S0 +S20"), (1000, "-S20 +S0")))
    assert times.usual["S20"] == (400_000, 2)  # 200 ms and 600 ms


def test_a_step_that_was_not_left_has_no_usual_time():
    assert "S0" not in StepTimes.of(log((0, "+S0"))).usual


def test_changes_come_newest_first():
    times = StepTimes.of(log((0, "+S0"), (100, "-S0 +S20"), (250, "-S20 +S21")))
    assert times.changes == [Change(250_000, ("S20",), ("S21",)), Change(100_000, ("S0",), ("S20",)), Change(0, (), ("S0",))]


def test_a_parallel_branch_is_one_change():
    assert StepTimes.of(log((40, "-S10 +S20 +S30"))).changes == [Change(40_000, ("S10",), ("S20", "S30"))]


def test_a_bit_that_was_on_between_two_frames_has_pulsed():
    pulses = Pulses()
    pulses.take(["Y0"])
    pulses.see(["Y0"])
    pulses.see(["Y0", "Y1"])
    assert pulses.take(["Y0"]) == ["Y1"]


def test_a_bit_that_is_on_in_a_frame_has_not_pulsed():
    pulses = Pulses()
    pulses.see(["X5"])
    assert pulses.take(["X5"]) == []
    pulses.see(["X5"])
    assert pulses.take([]) == []  # the last frame has shown it


def test_a_pulse_is_told_once():
    pulses = Pulses()
    pulses.see(["X5"])
    assert pulses.take([]) == ["X5"]
    assert pulses.take([]) == []


def test_changes_are_the_entries_that_differ_and_none_for_those_that_have_gone():
    assert changes({"a": 1, "b": 2, "c": 3}, {"a": 1, "b": 5, "d": 0}) == {"b": 5, "d": 0, "c": None}


def test_a_value_of_none_is_told_when_it_is_new():
    assert changes({}, {"a": None}) == {"a": None}
