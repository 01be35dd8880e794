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


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda plc: plc.pulse("X0", ms=0), "ms is 0"),
        (lambda plc: plc.pulse("X0", count=-1), "-1 pulses"),
        (lambda plc: plc.pulse("X0", count=2.5), "2.5 pulses"),
        (lambda plc: plc.quadrature("X0", "X1", count=5, ms=-3), "ms is -3"),
        (lambda plc: plc.signal("X0", [(5, 1), (3, 0)]), "a point at 3 ms behind one at 5 ms"),
        (lambda plc: plc.signal("X0", [(-1, 1)]), "a point at -1 ms behind one at 0 ms"),
    ],
)
def test_a_signal_that_cannot_be_is_refused_and_the_old_one_stays(act, words):
    plc = counting(0)
    plc.square("X0", hz=100)
    with pytest.raises(EcsimError, match=words):
        act(plc)
    plc.advance(ms=100)
    assert plc["D0"] == 10


def burst(pulses, begin=0.3, gap=1.0):
    """Points of pulses 0.4 us wide, `gap` us apart: both edges of each fall on one microsecond."""
    return [point for n in range(pulses) for point in ((begin + (gap * n + 0.1) / 1000, 1), (begin + (gap * n + 0.5) / 1000, 0))]


def test_a_megahertz_loses_no_pulse_from_its_first_one_on():
    plc = Plc("EC20", scan_ms=1)
    plc.load("LD SM0\nHCNT C236 1000\nLD SM93\nOUT M93\nLD SM92\nOUT M92")
    plc.run()
    plc.scan()
    plc.pulse("X0", count=1000, ms=1)
    plc.pulse("X3", count=1, ms=0.001)
    plc.scan(2)
    assert (plc["C236"], plc["C236:BOOL"]) == (1000, 1)
    assert (plc["M93"], plc["M92"]) == (1, 0)


@pytest.mark.parametrize("gap", [1.0, 0.5])  # 1 MHz, and two pulses in each microsecond
def test_pulses_shorter_than_a_microsecond_are_counted_and_caught(gap):
    plc = Plc("EC20", scan_ms=1)
    plc.load(
        "LD SM0\nHCNT C236 20\nDHSCS 7 C236 M7\nDHSCR 9 C236 M7\nDHSCS 12 C236 M12\nSPD X4 1000 D10\nLD SM93\nOUT M93\nLD SM92\nOUT M92"
    )
    plc.run()
    plc.scan()
    for name in ("X0", "X3", "X4"):
        plc.signal(name, burst(20, gap=gap))
    plc.scan(2)
    assert (plc["C236"], plc["C236:BOOL"], plc["D11"]) == (20, 1, 20)
    assert (plc["M7"], plc["M12"]) == (0, 1)
    assert (plc["M93"], plc["M92"]) == (1, 0)
    assert (plc["X0"], plc["X3"]) == (0, 0)


def test_a_comparison_that_clears_its_counter_within_a_microsecond_lets_it_count_on():
    plc = Plc("EC20", scan_ms=1)
    plc.load("PROGRAM MAIN\nLD SM1\nEI\nSET SM65\nLD SM0\nHCNT C236 99\nDHSCR 4 C236 C236\nDHSCI 4 C236 21\nEND_PROGRAM\n"
             "INTERRUPT I EVENT 21\nLD SM0\nINC D0\nEND_INTERRUPT")  # fmt: skip
    plc.run()
    plc.scan()
    plc.pulse("X0", count=19, ms=0.002)  # 9.5 MHz
    plc.scan()
    assert (plc["C236"], plc["D0"]) == (19 % 4, 19 // 4)


def test_each_edge_of_a_microsecond_asks_for_its_interrupt():
    plc = Plc("EC20", scan_ms=1)
    plc.load("PROGRAM MAIN\nLD SM1\nEI\nSET SM43\nSET SM44\nEND_PROGRAM\nINTERRUPT A EVENT 3\nLD SM0\nINC D0\nEND_INTERRUPT\n"
             "INTERRUPT B EVENT 14\nLD SM0\nINC D1\nEND_INTERRUPT")  # fmt: skip
    plc.run()
    plc.scan()
    plc.signal("X3", burst(6, gap=0.4))
    plc.signal("X4", burst(5))
    plc.scan()
    assert (plc["D0"], plc["D1"]) == (6, 5)


def test_a_reset_pulse_shorter_than_a_microsecond_clears_the_counter():
    plc = Plc("EC20", scan_ms=1)
    plc.load("LD SM0\nHCNT C244 2")
    plc.run()
    plc["X6"] = 1
    plc.scan()
    plc.pulse("X0", count=10, ms=1)  # a rise every 100 us from 25 us on
    plc.signal("X2", [(0.4501, 1), (0.4504, 0)])  # behind the fifth
    plc.scan()
    assert (plc["C244"], plc["C244:BOOL"]) == (5, 1)


@pytest.mark.parametrize(
    ("b", "value"),
    [
        ([(0.2002, 1), (0.2004, 0)], 0),  # up and down again within the microsecond, A being ON
        ([(0.2002, 1), (0.2003, 0), (0.2004, 1)], 1),
    ],
)
def test_phases_with_several_edges_in_a_microsecond(b, value):
    plc = Plc("EC20", scan_ms=1)
    plc.load("LD SM0\nHCNT C251 5\nDHSCS 1 C251 M1")
    plc.run()
    plc.scan()
    plc.signal("X0", [(0.1, 1)])
    plc.signal("X1", b)
    plc.scan()
    assert (plc["C251"], plc["M1"]) == (value, 1)


@pytest.mark.parametrize(("width", "rises"), [(0, 0), (10, 1), (4, 4)])
def test_pwm_on_a_wired_input_has_an_edge_for_each_change_and_no_other(width, rises):
    plc = Plc("EC20", scan_ms=10)
    plc.load(
        "PROGRAM MAIN\nLD SM1\nEI\nSET SM43\nLD SM0\nHCNT C240 99\nLD M0\nPWM D5 10 Y0\nEND_PROGRAM\nINTERRUPT I EVENT 3\nLD SM0\nINC D0\nEND_INTERRUPT"
    )
    plc.run()
    plc.wire("Y0", "X3")
    plc.wire("Y0", "X4")
    plc.scan()
    plc.set({"M0": 1, "D5": width})
    plc.advance(ms=25)  # three scans; ON at 10, 20, 30 and 40 ms
    assert plc.time_us == 40_000
    assert (plc["C240"], plc["D0"]) == (rises, rises)
