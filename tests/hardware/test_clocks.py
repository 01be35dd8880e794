"""SM10 to SM15 against waves counted independently (appendix 1, section 2)."""

import pytest

from ecsim.plc import Plc

PERIODS_MS = {"SM10": 10, "SM11": 100, "SM12": 1_000, "SM13": 60_000, "SM14": 3_600_000}


def expected(name, scan_start_us):
    """The first half of every period is OFF."""
    half_us = PERIODS_MS[name] * 1000 // 2
    return scan_start_us // half_us % 2


@pytest.mark.parametrize(
    ("scan_ms", "scans", "stride"),
    [(1, 2_500, 1), (3, 2_000, 1), (7, 1_500, 1), (10, 1_000, 1), (2.5, 900, 1), (0.7, 900, 1), (333, 2_000, 1), (25_000, 700, 1)],
)
def test_the_clock_relays_are_square_waves_from_the_begin_of_run(scan_ms, scans, stride):
    plc = Plc("EC20", scan_ms=scan_ms)
    plc.scan(3)
    plc.run()
    began = plc.time_us
    for _ in range(scans):
        start = plc.time_us - began
        plc.scan(stride)
        assert {name: plc[name] for name in PERIODS_MS} == {name: expected(name, start) for name in PERIODS_MS}, start


def test_the_waves_begin_anew_at_each_run():
    plc = Plc("EC20", scan_ms=10)
    plc.run()
    plc.scan(77)
    assert plc["SM12"] == 1
    plc.stop()
    plc.scan(13)
    plc.run()
    plc.scan(50)
    assert plc["SM12"] == 0
    plc.scan()
    assert plc["SM12"] == 1


def test_the_scan_relay_toggles_from_off():
    plc = Plc("EC20")
    plc.run()
    seen = []
    for _ in range(6):
        plc.scan()
        seen.append(plc["SM15"])
    assert seen == [0, 1, 0, 1, 0, 1]


def test_a_program_sees_the_relays_of_its_scan():
    plc = Plc("EC20", scan_ms=50)
    plc.load("LD SM12\nEU\nINC D0\nLD SM15\nOUT Y0")
    plc.run()
    plc.scan(200)  # ten seconds
    assert plc["D0"] == 10
    assert plc["Y0"] == 1
