"""Recordings: what is kept of signals, and what is given out."""

import matplotlib
import numpy
import pytest
from matplotlib import pyplot

from ecsim import EcsimError, Plc, Recording
from ecsim import record as record_module
from ecsim.hardware.serial import PortSettings
from ecsim.record import LogicAnalyser, PulseTrain, plot_line
from ecsim.system import SystemBlock

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


# -- steps, conditions, moments --------------------------------------------------------------------------------------


CHART = """PROGRAM MAIN
LD SM1
SET S0
STL S0
LD X0
SET S20
STL S20
OUT Y0
LD X1
OUT S0
RET
LD X0
EU
OUT Y1
LD SM0
SUB D0 3 D0
END_PROGRAM"""


@pytest.fixture
def chart():
    """Two steps, each left by an input; D0 falls by 3 in every scan. X0 in scans 3 and 4, X1 in scan 6."""
    plc = Plc("EC20", scan_ms=10, input_filter_ms=0)
    plc.load(CHART)
    plc.run()
    recording = Recording(plc, ["X0", "Y1", "S", "D0"])
    for scan in range(1, 9):
        plc.set({"X0": int(scan in (3, 4)), "X1": int(scan == 6)})
        plc.scan()
        recording.sample()
    return plc, recording


def test_all_steps_are_one_signal(chart):
    _, recording = chart
    assert recording.steps == ["S0", "S20"]
    assert [(time, recording.in_words("S", value)) for time, value in recording.changes("S")] == [
        (10_000, "S0"),
        (30_000, "S20"),
        (60_000, "S0"),
    ]


def test_a_stretch_of_changes_begins_with_the_value_that_holds(chart):
    _, recording = chart
    assert recording.changes("X0", 45_000, 80_000) == [(40_000, 1), (50_000, 0)]
    assert recording.value("X0", 39_999) == 1
    assert recording.value("X0", 9_999) is None


def test_the_next_and_the_last_edge_are_found(chart):
    _, recording = chart
    assert recording.edge(30_000, names=["X0"]) == 50_000
    assert recording.edge(30_000, forward=False, names=["X0"]) is None
    assert recording.edge(79_000, forward=False, names=["S", "X0"]) == 60_000
    assert recording.edge(30_000) == 40_000  # D0 changes in every scan


@pytest.mark.parametrize(
    ("condition", "ms"),
    [
        ("X0 rises", [30]),
        ("x0 FALLS", [50]),
        ("X0 changes", [30, 50]),
        ("X0", [30]),
        ("not X0", [50]),
        ("D0 < -8", [30]),
        ("D0 = -12 and X0", [40]),
        ("D0 changes and X0", [30, 40]),
        ("D0 >= -9 and not Y1", []),
        ("D0 <> -9", [40]),
    ],
)
def test_moments_are_found_by_a_condition(chart, condition, ms):
    assert [time / 1000 for time in chart[1].when(condition)] == ms


@pytest.mark.parametrize("condition", ["X0 jumps", "X0 or Y1", "", "D0 >", "not D0 > 3", "__import__('os')"])
def test_what_is_no_condition_is_refused(chart, condition):
    with pytest.raises(EcsimError, match="is no condition; write X1 rises"):
        chart[1].when(condition)


def test_a_condition_needs_recorded_signals(chart):
    with pytest.raises(EcsimError, match="M5 is not recorded; recorded are X0, Y1, S, D0"):
        chart[1].when("X0 and M5")


def test_a_signal_is_added_and_removed_while_it_records(chart):
    plc, recording = chart
    recording.add("M7")
    recording.remove("D0")
    plc["M7"] = 1
    plc.scan()
    recording.sample()
    assert recording.names == ["X0", "Y1", "S", "M7"]
    assert recording.changes("M7") == [(90_000, 1)]
    assert recording.value("M7", 80_000) is None
    assert recording.changes("X0")[1:] == [(30_000, 1), (50_000, 0)]
    with pytest.raises(EcsimError, match="M7 is recorded already"):
        recording.add("M7")


def test_steps_of_a_program_that_is_loaded_later_are_recorded_too(chart):
    plc, recording = chart
    plc.load("LD SM1\nSET S30\nSTL S30\nOUT Y0\nRET")
    plc.run()
    plc.scan()
    recording.sample()
    assert recording.in_words("S", recording.changes("S")[-1][1]) == "S30"


def test_each_moment_has_its_scan_also_when_scans_take_different_times():
    plc = Plc("EC20", scan_ms=10)
    recording = Recording(plc, "D0")
    lasted = [10, 10, 25, 25, 5, 10]
    for ms in lasted:
        plc._fixed_us = 1000 * ms
        plc.scan()
        recording.sample()
    ends = [1000 * sum(lasted[: n + 1]) for n in range(len(lasted))]
    assert [recording.scan_at(time) for time in ends] == [1, 2, 3, 4, 5, 6]
    assert [recording.scan_at(time - 1) for time in ends[1:]] == [1, 2, 3, 4, 5]
    recording.forget(ends[3])
    plc.scan()
    assert recording.scan_at(ends[2]) == 3


# -- files -----------------------------------------------------------------------------------------------------------


def read_vcd(text):
    """A strict reader of value change dumps (IEEE 1364-2005, 18.2): {reference: [(time, value)]} of wires and integers."""
    head, body = text.split("$enddefinitions $end\n")
    assert "$timescale 1 us $end" in head
    assert head.count("$scope module ") == head.count("$upscope $end") == 1
    references, found, time, dumping = {}, {}, None, False
    for line in head.splitlines():
        if line.startswith("$var"):
            _, sort, size, code, reference, end = line.split(" ")
            assert (sort, size) in (("wire", "1"), ("integer", "32"))
            assert end == "$end"
            assert all("!" <= sign <= "~" for sign in code)
            assert code not in references
            references[code] = (reference, sort)
            found[reference] = []
    for line in body.splitlines():
        if line.startswith("#"):
            assert time is None or int(line[1:]) > time, "times must rise"
            time = int(line[1:])
        elif line == "$dumpvars":
            dumping = True
        elif line == "$end":
            assert dumping
            assert all(found.values()), "all variables are dumped at the beginning"
            dumping = False
        else:
            value, code = line[1:].split(" ") if line[0] == "b" else (line[0], line[1:])
            reference, sort = references[code]
            assert (line[0] == "b") == (sort == "integer")
            assert set(value) <= set("01x")
            found[reference].append((time, value))
    assert not dumping
    return found


def test_a_vcd_file_holds_every_change(chart, tmp_path):
    _, recording = chart
    recording.add("C0:BOOL")
    found = read_vcd(recording.save(tmp_path / "all.vcd").read_text())
    assert found["X0"] == [(10_000, "0"), (30_000, "1"), (50_000, "0")]
    assert found["Y1"] == [(10_000, "0"), (30_000, "1"), (40_000, "0")]
    assert found["S0"] == [(10_000, "1"), (30_000, "0"), (60_000, "1")]
    assert found["S20"] == [(10_000, "0"), (30_000, "1"), (60_000, "0")]
    assert [int(value, 2) - 2**32 for _, value in found["D0"]] == [-3 * n for n in range(1, 9)]
    assert found["C0_BOOL"] == [(10_000, "x")]


def test_a_csv_file_has_a_row_for_each_change(chart, tmp_path):
    _, recording = chart
    lines = recording.save(tmp_path / "all.csv").read_text().splitlines()
    assert lines[0] == "time_s,scan,X0,Y1,S,D0"
    assert lines[3] == "0.030000,3,1,1,S20,-9"
    assert len(lines) == 9


def test_a_png_file_is_a_picture(chart, tmp_path):
    path = chart[1].save(tmp_path / "all.png")
    height, width, _ = pyplot.imread(path).shape
    assert (width, height) == (1650, 435)  # 11 in x 2.9 in at 150 dots an inch


def test_another_kind_of_file_is_refused(chart, tmp_path):
    with pytest.raises(EcsimError, match="cannot be written as 'fst'; it can as csv, vcd or png"):
        chart[1].save(tmp_path / "all.fst")
    assert list(tmp_path.iterdir()) == []


def test_a_diagram_shows_steps_cursors_and_pins(chart):
    _, recording = chart
    axes = recording.plot(ms=(10, 1500), cursors=(30, 60))
    words = [text.get_text() for text in axes.texts]
    assert "30 ms · 3 scans" in words
    assert words[-3:-1] == ["A", "B"]
    assert "S0" in words
    pins = {each.get_gid(): each.get_offsets().tolist() for each in axes.collections if each.get_gid()}
    assert pins == {"pins of Y1": [[30, 2.64]]}  # the third row from below, on for one scan
    pyplot.close("all")


def test_a_line_shows_who_spoke_when_and_what():
    class Parrot:
        def hear(self, message):
            return b"\x0a\x0b" * 2

    plc = Plc("EC20", system=SystemBlock(port1=PortSettings("freeport", baud=9600)))
    plc.load("LD SM1\nXMT 1 D0 3")
    plc.run()
    plc.ports[1].connect(Parrot(), delay_ms=2)
    plc.set({"D0": 1, "D1": 0x22, "D2": 255})
    plc.scan(5)
    # a character of 10 bits at 9600 baud takes 1.0417 ms; the parrot hears 3.5 of them of silence and waits for 2 ms
    sent, answer = plc.ports[1].wire.spans
    assert sent == (0, 3125, "port 1", "0122ff")
    assert answer == (3125 + 3645 + 2000, 3125 + 3645 + 2000 + 4166, "Parrot", "0a0b0a0b")
    axes = plot_line(plc.ports[1].wire)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["port 1", "Parrot"]
    assert axes.get_xlim() == pytest.approx((0, 12.936))
    assert {text.get_text() for text in axes.texts} == {"01 22 FF", "0A 0B 0A 0B"}
    bars = [path.get_extents().bounds for each in axes.collections for path in each.get_paths() if len(path.vertices) > 2]
    assert [(x, width) for x, _, width, _ in bars] == [pytest.approx((0, 3.125)), pytest.approx((8.77, 4.166))]
    assert {text.get_text() for text in plot_line(plc.ports[1].wire, ms=(0, 60)).texts} == {"01 …", "0A 0B …"}
    assert [label.get_text() for label in plot_line(plc.ports[1].wire, ms=(0, 5)).get_yticklabels()] == ["port 1"]
    pyplot.close("all")


@pytest.mark.parametrize(("seconds", "unit", "last"), [(0.5, "ms", "500"), (12, "s", "12"), (900, "min", "14")])
def test_the_scale_of_a_diagram_is_in_the_unit_that_fits(seconds, unit, last):
    plc = Plc("EC20", scan_ms=100)
    plc.load("LD SM12\nOUT Y0")
    recording = Recording(plc, ["Y0"])
    plc.run()
    for _ in range(round(seconds * 10)):
        plc.scan()
        recording.sample()
    axes = recording.plot()
    axes.figure.canvas.draw()
    shown = [tick.get_text() for tick in axes.get_xticklabels() if 0 <= tick.get_position()[0] <= seconds * 1000]
    assert (axes.get_xlabel(), shown[-1]) == (unit, last)


def test_many_scans_are_not_marked_in_a_diagram():
    plc = Plc("EC20", scan_ms=10)
    plc.load("LD SM13\nOUT Y0")
    analyser = LogicAnalyser(plc, ["Y0"])
    plc.run()
    plc.scan(10)
    marked = [line for line in analyser.plot().collections if len(line.get_paths()) == 10]
    assert marked
    plc.scan(100)
    assert [line for line in analyser.plot().collections if len(line.get_paths()) > 50] == []
