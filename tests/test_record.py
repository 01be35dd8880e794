"""Recordings: what is kept of signals, and what is given out."""

import numpy
import pytest

from ecsim import EcsimError, Plc, Recording
from ecsim import record as record_module

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
