"""The input filter (2.2.1, 3.1.3): which inputs have it, what it lets pass, and when."""

import pytest

from ecsim.plc import Plc

FILTERED = {"EC10": ["X0", "X7"], "EC20": ["X0", "X17"]}
BEYOND = {"EC10": "X10", "EC20": "X20"}


def machine(model="EC20", filter_ms=None, scan_ms=1):
    """A PLC in RUN, first scan done."""
    plc = Plc(model, scan_ms=scan_ms, input_filter_ms=filter_ms)
    plc.run()
    plc.scan()
    return plc


def delay_ms(plc, name, level=1):
    """Simulated time between setting a terminal and the scan that sees it."""
    plc[name] = level
    began = plc.time_us
    while plc[name] != level:
        plc.scan()
    return (plc.time_us - began) / 1000 - plc.scan_ms  # the scan that sees it has begun a period ago


@pytest.mark.parametrize(
    ("model", "name", "ms"), [(model, name, {"EC10": 8, "EC20": 10}[model]) for model in FILTERED for name in FILTERED[model]]
)
def test_the_first_inputs_are_filtered_with_the_models_time(model, name, ms):
    assert delay_ms(machine(model), name) == ms


@pytest.mark.parametrize("model", BEYOND)
def test_the_other_inputs_are_not_filtered(model):
    assert delay_ms(machine(model), BEYOND[model]) == 0


@pytest.mark.parametrize(("model", "filter_ms"), [("EC20", 0), ("EC20", 1), ("EC20", 60), ("EC10", 0), ("EC10", 16), ("EC10", 64)])
def test_the_filters_time_can_be_set(model, filter_ms):
    plc = machine(model, filter_ms)
    assert delay_ms(plc, "X0") == filter_ms
    assert delay_ms(plc, "X0", 0) == filter_ms


@pytest.mark.parametrize(("width_scans", "seen"), [(1, 0), (9, 0), (10, 0), (11, 1)])
def test_a_pulse_shorter_than_the_filter_is_not_seen(width_scans, seen):
    plc = machine(filter_ms=10)
    plc.load("LD X0\nOUT M0\nSET M1")
    plc.run()
    plc["X0"] = 1
    plc.scan(width_scans)
    plc["X0"] = 0
    plc.scan(40)
    assert (plc["X0"], plc["M1"]) == (0, seen)


def test_a_filtered_input_goes_on_waiting_while_others_change():
    plc = machine(filter_ms=10)
    plc["X0"] = 1
    plc.scan(5)
    plc["X1"] = 1
    plc["X20"] = 1
    plc.scan(6)
    assert (plc["X0"], plc["X1"], plc["X20"]) == (1, 0, 1)
    plc.scan(5)
    assert plc["X1"] == 1


def test_the_filter_works_in_stop_too():
    plc = Plc("EC20", scan_ms=1)
    plc["X0"] = 1
    plc.scan(10)
    assert plc["X0"] == 0
    plc.scan()
    assert plc["X0"] == 1
