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


# -- a large chart: only what is looked at is laid out, and the active step is always found ------------------------

CHAIN = [0, *range(20, 119)]
WAYS = zip(CHAIN, [*CHAIN[1:], 0], strict=True)
LONG = "\n".join(f"STL S{here}\nOUT M{here}\nLD X{here % 2}\n{'SET' if there else 'OUT'} S{there}" for here, there in WAYS)
FOUND = """(step) => {
  const [own, outer] = [step, '.chart-scroll'].map((each) => document.querySelector(each).getBoundingClientRect());
  return own.height > 0 && own.top >= outer.top && own.bottom <= outer.bottom;
}"""


@pytest.fixture
def long_chart(bench, make_lab):
    bench.lab = make_lab(f"LD SM1\nSET S0\n{LONG}\nRET")
    bench.lab.session.scan(2)
    bench.connect(bench.lab.panel("chart"))
    return bench


def set_step(bench, number):
    for step in bench.lab.rig.active():
        bench.lab.session.set_step(step, False)
    bench.lab.session.set_step(f"S{number}", True)
    bench.settle()
    bench.settle()


def test_a_large_chart_scrolls_in_its_panel_and_lays_out_what_is_looked_at(long_chart):
    laid_out = "() => [...document.querySelectorAll('.step')].filter((step) => step.getClientRects().length).length"
    assert long_chart.js("() => document.querySelector('.chart-scroll').scrollHeight") > 9000
    assert long_chart.js("() => document.querySelector('.chart-scroll').clientHeight") <= 960
    assert 10 < long_chart.js(laid_out) < 50
    long_chart.js("() => { document.querySelector('.chart-scroll').scrollTop = 1e6; }")
    long_chart.frame()
    long_chart.settle()
    assert long_chart.js(FOUND, '[data-testid="step-S118"]')
    assert long_chart.js(laid_out) < 50


def test_the_active_step_is_followed_until_somebody_scrolls(long_chart):
    set_step(long_chart, 90)
    assert long_chart.js(FOUND, '[data-testid="step-S90"]')
    expect(long_chart["step-S90"]).to_have_class("step active")
    long_chart["chart"].locator(".chart-scroll").hover()
    long_chart.page.mouse.wheel(0, -200)
    expect(long_chart["chart-follow"]).to_have_attribute("aria-pressed", "false")
    set_step(long_chart, 30)
    assert not long_chart.js(FOUND, '[data-testid="step-S30"]')
    long_chart["chart-follow"].click()
    long_chart.settle()
    assert long_chart.js(FOUND, '[data-testid="step-S30"]')


def test_the_chart_is_zoomed_around_its_middle(long_chart):
    set_step(long_chart, 70)
    wide = "() => document.querySelector('[data-testid=step-S70] .box').getBoundingClientRect().width"
    before = long_chart.js(wide)
    for _ in range(3):
        long_chart["zoom-out"].click()
        long_chart.settle()
    assert long_chart.js(wide) == pytest.approx(before / 2, rel=0.05)
    assert long_chart.js(FOUND, '[data-testid="step-S70"]')
    expect(long_chart["zoom-out"]).to_be_disabled()
    long_chart["step-S70"].focus()
    long_chart.page.keyboard.press("+")
    assert long_chart.js(wide) == pytest.approx(before * 0.67, rel=0.05)
