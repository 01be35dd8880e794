"""Recordings: what is kept of signals, and what is given out."""

import matplotlib
import numpy
import pytest
from matplotlib import pyplot

from ecsim import EcsimError, Plc, Recording
from ecsim import record as record_module
from ecsim.record import LogicAnalyser, PulseTrain

matplotlib.use("Agg")

BLINK = "VAR_GLOBAL\nLamp AT Y0\nEND_VAR\nPROGRAM MAIN\nLD SM12\nOUT Lamp\nLD SM0\nTON T0 5\nINC D0\nLD X0\nDCNT C200 3\nEND_PROGRAM"


@pytest.fixture
def plc():
    """A blinking lamp: half a second OFF, half a second ON."""
    plc = Plc("EC20", scan_ms=50, input_filter_ms=0)
    plc.load(BLINK)
    plc.run()
    return plc


def record(plc, names, scans):
    """A recording of so many scans."""
    recording = Recording(plc, names)
    for _ in range(scans):
        plc.scan()
        recording.sample()
    return recording


def test_changes_are_kept_with_their_time(plc):
    recording = record(plc, ["Y0"], 45)
    assert recording.changes("Y0") == [(50_000, 0), (550_000, 1), (1_050_000, 0), (1_550_000, 1), (2_050_000, 0)]
    assert len(recording) == 5


def test_time_in_which_nothing_changes_costs_nothing(plc):
    assert len(record(plc, ["Y0", "M5"], 10)) == 1


def test_each_signal_is_told_by_itself(plc):
    recording = record(plc, ["Y0", "T0:BOOL", "D0"], 12)
    assert recording.changes("T0:BOOL") == [(50_000, 0), (550_000, 1)]
    assert recording.changes("D0") == [(50_000 * n, n) for n in range(1, 13)]


def test_signals_are_arrays_of_seconds_and_values(plc):
    times, values = record(plc, ["Y0"], 25).signal("Y0")
    assert isinstance(times, numpy.ndarray)
    numpy.testing.assert_allclose(times, [0.05, 0.55, 1.05])
    assert values.tolist() == [0, 1, 0]


def test_names_of_the_program_and_wide_counters_can_be_recorded(plc):
    recording = record(plc, ["lamp", "C200"], 11)
    plc["X0"] = 1
    plc.scan()
    recording.sample()
    assert recording.changes("lamp") == [(50_000, 0), (550_000, 1)]
    assert recording.changes("C200") == [(50_000, 0), (600_000, 1)]


def test_one_name_needs_no_list(plc):
    assert record(plc, "Lamp", 1).names == ["Lamp"]


@pytest.mark.parametrize("name", ["D0:DINT", "D0:REAL", "K4M0"])
def test_what_is_no_single_register_cannot_be_recorded(plc, name):
    with pytest.raises(EcsimError, match=f"{name} cannot be recorded; name single bits and registers"):
        Recording(plc, [name])


def test_a_name_that_is_not_recorded_is_told_with_those_that_are(plc):
    with pytest.raises(EcsimError, match="Y1 is not recorded; recorded are Y0, D0"):
        Recording(plc, ["Y0", "D0"]).changes("Y1")


def test_forcing_goes_on_to_be_recorded(plc):
    recording = record(plc, ["Y0"], 5)
    plc.force("Y0", 1)
    plc.scan()
    recording.sample()
    plc.unforce()
    plc.scan()
    recording.sample()
    assert recording.changes("Y0") == [(50_000, 0), (300_000, 1), (350_000, 0)]


def test_what_came_after_a_moment_can_be_forgotten(plc):
    recording = record(plc, ["D0"], 10)
    recording.forget(250_000)
    assert recording.changes("D0")[-1] == (250_000, 5)
    recording.sample()
    assert recording.changes("D0")[-1] == (500_000, 10)


def test_of_very_many_changes_the_oldest_go(plc, monkeypatch):
    monkeypatch.setattr(record_module, "KEEP", 40)
    recording = record(plc, ["D0"], 100)
    assert 30 <= len(recording) <= 40
    assert recording.changes("D0")[-1] == (5_000_000, 100)


def test_a_recording_tells_what_it_holds(plc):
    assert repr(record(plc, ["Y0", "D0"], 3)) == "<Recording of Y0, D0: 3 changes>"


# -- between two scans ---------------------------------------------------------------------------------------------


COUNTING = """PROGRAM MAIN
LD SM1
EI
SET SM65
LD SM0
HCNT C236 8
DHSCS 5 C236 Y10
DHSCI 8 C236 20
LD X0
OUT M0
END_PROGRAM
INTERRUPT I EVENT 20
LD SM0
INC D0
RST Y10
END_INTERRUPT"""


def analysed(names):
    """Ten pulses on X0 in 18 ms, from 10 ms on: the n-th one, from 0, rises at 10.45 + 1.8 n ms and falls 0.9 ms later."""
    plc = Plc("EC20", scan_ms=10)
    plc.load(COUNTING)
    plc.run()
    plc.scan()
    analyser = LogicAnalyser(plc, names)
    plc.pulse("X0", count=10, ms=18)
    plc.scan(3)
    analyser.stop()
    return plc, analyser


def test_an_analyser_notes_events_at_their_microsecond():
    _, analyser = analysed(["X0", "C236", "C236:BOOL", "Y10", "D0", "M0"])
    rises = [10_450 + 1_800 * n for n in range(10)]
    edges = sorted([(t, 1) for t in rises] + [(t + 900, 0) for t in rises])
    assert analyser.changes("X0") == [(10_000, 0), *edges]
    assert analyser.changes("C236") == [(10_000, 0), *((t, n) for n, t in enumerate(rises, 1))]
    assert analyser.changes("C236:BOOL") == [(10_000, 0), (rises[7], 1)]
    assert analyser.changes("Y10") == [(10_000, 0), (rises[4], 1), (rises[7], 0)]
    assert analyser.changes("D0") == [(10_000, 0), (rises[7], 1)]
    assert analyser.changes("M0") == [(10_000, 0), (20_000, 1), (30_000, 0)]  # X0 as the program sees it: ON at 20 ms
    assert (analyser.scans, analyser.interrupts) == ([10_000, 20_000, 30_000], [rises[7]])


def test_an_analyser_sees_each_pulse_of_an_output():
    plc = Plc("EC20", scan_ms=10)
    plc.load("LD SM0\nPLSY 1000 5 Y0")
    plc.run()
    analyser = LogicAnalyser(plc, ["Y0", "SM82"])
    plc.scan()
    on, off = PulseTrain(plc, "Y0").times
    assert [time for time, level in analyser.changes("Y0") if level] == (1e6 * on).round().tolist() == [500 + 1000 * n for n in range(5)]
    assert [time for time, level in analyser.changes("Y0") if not level][1:] == (1e6 * off).round().tolist()
    assert analyser.changes("SM82") == [(0, 0), (0, 1), (5_000, 0)]


def test_an_analyser_changes_nothing_and_ends():
    plc, analyser = analysed(["X0"])
    other = Plc("EC20", scan_ms=10)
    other.load(COUNTING)
    other.run()
    other.scan()
    other.pulse("X0", count=10, ms=18)
    other.scan(3)
    assert plc.memory.snapshot() == other.memory.snapshot()
    noted = len(analyser)
    plc.pulse("X0", count=10, ms=18)
    plc.scan(3)
    assert len(analyser) == noted


def test_a_timing_diagram_has_a_row_for_each_device_and_marks_for_scans_and_interrupts():
    _, analyser = analysed(["X0", "C236", "Y10"])
    axes = analyser.plot()
    assert [label.get_text() for label in axes.get_yticklabels()] == ["Y10", "C236", "X0"]
    assert axes.get_xlim() == (10, 40)
    assert {text.get_text() for text in axes.texts} >= {"scan", *"123456789", "10"}
    assert axes.lines[-1].get_xdata().tolist() == [23.05]
    assert axes.lines[2].get_ydata().tolist() == pytest.approx([0, 0.64, 0, 0])  # Y10, the lowest row: OFF, ON, OFF to the end
    assert analyser.plot(ms=(15, 20)).get_xlim() == (15, 20)
    pyplot.close("all")


def test_a_recording_without_an_analyser_is_drawn_too(plc):
    axes = record(plc, ["Lamp", "D0"], 12).plot()
    assert axes.get_xlim() == (50, 600)
    assert axes.lines[0].get_xdata().tolist() == [50, 550, 600]
    pyplot.close("all")
