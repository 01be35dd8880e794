"""Every panel's script with the real panel behind it: it shows what the PLC is, and what is pressed arrives there."""

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

PROGRAM = """
VAR_GLOBAL
  Start AT X5      // start button
  Lamp AT Y0
  Settle AT T0
END_VAR
PROGRAM MAIN
// the lamp follows the button
LD Start
OUT Lamp
LD SM1
SET S0
// wait for a part
STL S0
LD X0
SET S20
// hold it
STL S20
OUT Y2
LD SM0
TON Settle 5
LD Settle
OUT S0
RET
LD X1
CTU C0 3
END_PROGRAM
"""


@pytest.fixture
def still(make_lab):
    """A lab with timers, counters and a chart."""
    return make_lab(PROGRAM)


@pytest.fixture
def shown(bench, still):
    """Show panels of the lab, all of them or one."""

    def show(key=None):
        bench.connect(still.panel(key) if key else still)
        return bench

    return show


def step(bench, still, scans=1):
    still.session.scan(scans)
    bench.settle()


def test_all_panels_stand_on_one_page_and_stamp_the_same_scan(shown, still):
    bench = shown()
    step(bench, still, 3)
    assert [bench[key].count() for key in ("transport", "unit", "chart", "ladder", "timers")] == [1] * 5
    assert bench["scans"].inner_text() == "3"


def test_a_switch_of_the_unit_is_an_input_of_the_plc(shown, still):
    bench = shown("unit")
    bench["X5"].click()
    bench.settle()
    assert still.rig.terminal("X5") == 1
    step(bench, still, 3)
    expect(bench["lamp-Y0"]).to_have_attribute("data-on", "")


def test_the_transport_scans_and_goes_back(shown, still):
    bench = shown("transport")
    for _ in range(2):
        bench["scan"].click()
        bench.settle()
    assert still.plc.scans == 2
    bench["back"].click()
    bench.settle()
    assert still.plc.scans == 1
    expect(bench["scans"]).to_have_text("1")


def test_the_chart_lights_the_active_step_and_says_what_it_waits_for(shown, still):
    bench = shown("chart")
    step(bench, still, 3)
    expect(bench["step-S0"]).to_have_attribute("data-on", "")
    expect(bench["chart"].locator(".facts")).to_contain_text("X0 on")


def test_the_timers_count_and_say_so(shown, still):
    bench = shown("timers")
    still.plc["X1"] = 1
    step(bench, still, 4)
    expect(bench["C0"]).to_have_text("1")
    expect(bench["row-C0"]).to_contain_text("2 to go")


def test_the_ladder_shows_the_power_of_the_scan(shown, still):
    bench = shown("ladder")
    still.plc["X5"] = 1
    step(bench, still, 3)
    expect(bench["ladder"].locator('.coil[data-device="Y0"]')).to_have_class("coil flow")


def test_a_panel_without_its_kernel_keeps_what_it_showed(shown, still):
    bench = shown()
    still.plc["X5"] = 1
    step(bench, still, 3)
    bench.js("() => { model.gone = true; model.handlers['comm_live_update'](); }")
    expect(bench["chip"]).to_have_text("Not connected: the last state")
    expect(bench["lamp-Y0"]).to_have_attribute("data-on", "")
    expect(bench["ladder"].locator(".stamp")).to_have_text("last state · scan 3")
