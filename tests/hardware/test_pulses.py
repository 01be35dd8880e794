"""Pulse outputs against independent arithmetic: times, counts, ramps and positions, pulse by pulse."""

import itertools
from math import isclose, sqrt

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from ecsim import EcsimError, Plc
from ecsim.hardware.trains import Ramps, Segment, envelope, least_hertz, least_pulses, stepped
from ecsim.record import PulseTrain


def machine(program, model="EC10", scan_ms=10, **values):
    plc = Plc(model, scan_ms=scan_ms, input_filter_ms=0)
    plc.load(program)
    plc.run()
    plc.set(values)
    return plc


@given(st.integers(1, 100_000), st.integers(1, 300), st.integers(0, 3_000_000))
def test_a_segment_counts_what_its_edges_say(hertz, pulses, moment):
    segment = Segment(1_000, hertz, pulses)
    rises = [1_000 + (2 * place + 1) * 500_000 // hertz for place in range(pulses)]
    falls = [1_000 + (place + 1) * 1_000_000 // hertz for place in range(pulses)]
    assert [segment.edge(True, place) for place in range(pulses)] == rises
    assert [segment.edge(False, place) for place in range(pulses)] == falls
    assert segment.counted(moment) == sum(edge <= moment for edge in rises)
    assert segment.completed(moment) == sum(edge <= moment for edge in falls)
    assert segment.level(moment) == any(on <= moment < off for on, off in zip(rises, falls, strict=True))


@given(st.floats(20, 50_000), st.floats(20, 50_000), st.integers(2, 400), st.integers(0, 2_000_000))
def test_a_ramp_counts_what_its_edges_say_and_reaches_its_speed(low, high, pulses, moment):
    assume(abs(high - low) > 1)
    segment = Segment(0, low, pulses, (high * high - low * low) / (2 * pulses))
    rises = [segment.edge(True, place) for place in range(pulses)]
    assert rises == sorted(rises)
    assert segment.counted(moment) == sum(edge <= moment for edge in rises)
    # so many pulses at the mean of both speeds
    assert isclose(segment.end / 1e6, 2 * pulses / (low + high), rel_tol=1e-6, abs_tol=2e-6)
    assert abs(segment.frequency(segment.end) - high) <= abs(segment.slope) * 1e-6 + 1e-6  # its end is a whole microsecond


@given(st.integers(10, 20_000), st.integers(110, 200_000), st.integers(1, 5_000))
def test_plsr_puts_out_all_its_pulses_in_steps_of_a_tenth(hertz, pulses, ramp):
    work = min(max(hertz * ramp, 100_000), pulses * 909)
    plan = stepped(0, hertz, pulses, work)
    assert sum(segment.pulses for segment in plan) == pulses
    assert {round(segment.hertz * 10) for segment in plan} <= {hertz * step for step in range(1, 11)}
    assert all(a.end == b.start for a, b in itertools.pairwise(plan))


@settings(max_examples=300)
@given(st.integers(1, 100_000), st.integers(10, 100_000), st.integers(1, 10_000), st.integers(1, 5_000))
def test_a_move_puts_out_all_its_pulses_and_never_passes_its_speed(pulses, hertz, base, ramp):
    top = 100_000
    ramps = Ramps(base, (top - base) * 1000 / ramp)
    plan = ramps.move(0, pulses, hertz, 1)
    assert sum(segment.pulses for segment in plan) == pulses
    assert all(max(segment.hertz, segment.frequency(segment.end)) <= hertz * (1 + 1e-9) + 1e-6 for segment in plan)
    assert all(abs(segment.slope) <= ramps.slope * 2.1 for segment in plan)


def test_the_printed_example_of_a_ramp():
    # 8.4: from 20000 to 50000 Hz with 5000 to 100000 Hz in 1000 ms: 316 ms, 11060 pulses (with the 316 ms rounded)
    assert isclose(least_pulses(5_000, 100_000, 20_000, 50_000, 1_000), 11_052.6, abs_tol=0.1)
    plan = envelope(0, [(20_000, 10_000), (50_000, 60_000)], 5_000, 100_000, 1_000, 1_000)
    rise = next(segment for segment in plan if segment.hertz == 20_000 and segment.slope > 0)
    assert isclose((rise.end - rise.start) / 1000, 315.8, abs_tol=0.2)
    assert sum(segment.pulses for segment in plan) == 70_000


@pytest.mark.parametrize(
    ("steps", "accepted"),
    [
        ([(10_000, 9_900)], True), ([(10_000, 9_899)], False),  # one step: both ramps, 4950 pulses each
        ([(10_000, 4_950), (10_000, 1)], True), ([(10_000, 4_949), (10_000, 1)], False),  # up from the least speed
        ([(10_000, 5_000), (1_000, 9_900)], True), ([(10_000, 5_000), (1_000, 9_899)], False),  # the last one: the sum of both times
        ([(10_000, 5_000), (1_000, 4_950), (1_000, 1)], True), ([(10_000, 5_000), (1_000, 4_949), (1_000, 1)], False),  # down
        ([(10_000, 999_999)], True), ([(10_000, 1_000_000)], False),
        ([(10_001, 20_000)], False), ([(999, 20_000)], False),
    ],
)  # fmt: skip
def test_an_envelope_keeps_the_least_pulses_of_each_step(steps, accepted):
    plan = envelope(0, steps, 1_000, 10_000, 900, 900)
    assert (plan is not None) is accepted


def test_the_least_frequency_of_positioning():
    assert isclose(least_hertz(100_000, 1_000), sqrt(100_000 * 500 / 1_000))


@settings(max_examples=60)
@given(st.lists(st.tuples(st.integers(1, 20_000), st.integers(1, 9)), min_size=1, max_size=8))
def test_plsy_keeps_whole_pulses_when_its_frequency_changes(changes):
    plc = machine("LD SM0\nPLSY D0 0 Y0")
    for hertz, scans in changes:
        plc["D0:DINT"] = hertz
        plc.scan(scans)
    on, off = PulseTrain(plc, "Y0").times
    assert len(on) == len(off) == plc["SD50:DINT"]
    assert (off > on).all()
    assert (on[1:] >= off[:-1]).all()


def test_a_train_is_read_as_times_and_as_a_curve():
    plc = machine("LD M0\nDRVI 5000 2500 Y0 Y4", **{"SD84": 500, "SD85:DINT": 10_000, "SD87": 950, "M0": 1})
    plc.advance(ms=3000)
    train = PulseTrain(plc, "Y0")
    assert repr(train) == "<PulseTrain of Y0: 5000 pulses>"
    times, hertz = train.frequency
    assert list(hertz.round()) == [0, 500, 2500, 2500, 2500, 2500, 500, 0]
    assert times[-1] == pytest.approx(2.16, abs=0.001)  # 200 + 1760 + 200 ms
    on, off = train.times
    assert len(on) == 5000
    assert off[-1] == pytest.approx(2.16, abs=0.001)


def test_the_curve_can_be_drawn():
    from matplotlib.figure import Figure

    plc = machine("LD SM0\nPLSR 1000 500 100 Y0")
    plc.advance(ms=1000)
    axes = PulseTrain(plc, "Y0").plot(Figure().subplots())
    assert axes.get_lines()[0].get_ydata().max() == 1000


def test_only_pulse_outputs_have_trains():
    with pytest.raises(EcsimError, match="Y2 is no pulse output"):
        PulseTrain(machine("LD M0\nOUT Y0"), "Y2")


def test_a_wired_output_is_counted_pulse_by_pulse():
    plc = machine("LD SM0\nPLSY D0 0 Y0\nHCNT C236 100\nDHSCS 150 C236 Y10\nSPD X1 100 D10\nLD SM0\nPLSY 1000 70 Y1", model="EC20")
    plc["D0:DINT"] = 1000
    plc.wire("Y0", "X0")
    plc.wire("Y1", "X1")
    plc.advance(ms=100)
    assert plc["C236"] == 100
    assert plc["SD50:DINT"] == 100
    assert plc["D10"] == 70
    plc["D0:DINT"] = 5000
    plc.advance(ms=10)
    assert plc["Y10"] == 0
    assert plc["C236"] == 146
    plc.advance(ms=10)
    assert plc["Y10"] == 1
    assert abs(plc["C236"] - plc["SD50:DINT"]) <= 1


def test_positions_follow_every_pulse_while_the_flow_comes_and_goes():
    plc = machine("LD M0\nDRVI 400 3000 Y0 Y4\nLD M1\nDRVI -300 3000 Y0 Y4", **{"SD84": 500, "SD85:DINT": 20_000, "SD87": 200})
    for _ in range(4):
        for name in ("M0", "M1"):
            plc[name] = 1
            plc.advance(ms=400)
            plc[name] = 0
            plc.advance(ms=20)
    assert plc["SD80:DINT"] == 4 * 400 - 4 * 300
    assert plc["SD50:DINT"] == 4 * 400 + 4 * 300


def test_another_move_may_not_begin_in_the_scan_in_which_the_output_is_given_back():
    plc = machine("LD M0\nDRVI 10 5000 Y0 Y4\nLDI M0\nDRVI -10 5000 Y0 Y4", M0=1)
    plc.advance(ms=50)
    assert plc["SD80:DINT"] == 10
    plc["M0"] = 0
    plc.scan()
    assert plc["SM82"] == 0
    assert plc["SD80:DINT"] == 10
    plc.advance(ms=50)
    assert plc["SD80:DINT"] == 0
