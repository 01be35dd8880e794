"""Signals on inputs: the filter, bounce, recorded edges, what a program sees of them."""

import pytest

from ecsim import EcsimError, Plc
from ecsim.hardware.signals import Train, bouncing


def counting(filter_ms, program="LD X0\nEU\nINC D0", scan_ms=1):
    plc = Plc("EC20", scan_ms=scan_ms, input_filter_ms=filter_ms)
    plc.load(program)
    plc.run()
    plc.scan()
    return plc


def test_an_unfiltered_input_shows_each_slow_pulse():
    plc = counting(0)
    plc.pulse("X0", count=10, ms=100)
    plc.advance(ms=110)
    assert plc["D0"] == 10
    assert plc["X0"] == 0


@pytest.mark.parametrize(("width_ms", "seen"), [(8, 0), (12, 10)])
def test_the_filter_lets_pass_what_is_longer(width_ms, seen):
    plc = counting(10)
    plc.pulse("X0", count=10, ms=20 * width_ms)
    plc.advance(ms=20 * width_ms + 30)
    assert plc["D0"] == seen


def test_the_filter_delays_a_signal():
    plc = counting(10)
    plc.signal("X0", [(5, 1), (50, 0)])
    plc.advance(ms=14)
    assert plc["X0"] == 0
    plc.advance(ms=3)
    assert plc["X0"] == 1
    plc.advance(ms=40)
    assert plc["X0"] == 1
    plc.advance(ms=6)
    assert plc["X0"] == 0


def test_a_bouncing_contact_is_seen_several_times_and_the_filter_helps():
    seen = {}
    for filter_ms in (0, 10):
        plc = counting(filter_ms, scan_ms=0.1)
        plc.signal("X0", [(5, 1), (100, 0)], bounce_ms=6)
        plc.advance(ms=130)
        seen[filter_ms] = plc["D0"]
    assert seen[10] == 1
    assert seen[0] > 2


def test_bounce_keeps_the_level_between_edges():
    train = Train(0, 100_000, 5, 5)
    bounced = bouncing(train, 0, 2_000)
    for place in range(5):
        rise, fall = 20_000 * place + 5_000, 20_000 * place + 15_000
        assert bounced.level(rise + 2_001)
        assert not bounced.level(fall + 2_001)
    assert bounced.count(True, 0, 100_000) > 5


def test_setting_the_input_ends_its_signal():
    plc = counting(0)
    plc.square("X0", hz=100)
    plc.advance(ms=50)
    plc["X0"] = 1
    plc.advance(ms=50)
    assert plc["X0"] == 1


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda plc: plc.pulse("Y0"), "Y0 is no input"),
        (lambda plc: plc.quadrature("X0", "X1", direction=2), "the direction is 1 or -1"),
        (lambda plc: plc.square("X0", hz=0), "frequencies go up to"),
        (lambda plc: plc.wire("Y7", "X0"), "Y7 is no pulse output"),
    ],
)
def test_a_wrong_signal_is_refused_in_words(act, words):
    with pytest.raises(EcsimError, match=words):
        act(counting(0))


def test_signals_go_on_in_stop():
    plc = counting(0)
    plc.pulse("X0", count=1, ms=100)
    plc.stop()
    plc.advance(ms=50)
    assert plc["X0"] == 1
    plc.advance(ms=50)
    assert plc["X0"] == 0
