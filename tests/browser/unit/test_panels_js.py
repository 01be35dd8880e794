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


# -- a large chart: only what is near sight is there as elements, and the active step is always found ------------------------

CHAIN = [0, *range(20, 119)]
WAYS = zip(CHAIN, [*CHAIN[1:], 0], strict=True)
LONG = "\n".join(f"STL S{here}\nOUT M{here}\nLD X{here % 2}\n{'SET' if there else 'OUT'} S{there}" for here, there in WAYS)
FOUND = """(step) => {
  const [own, outer] = [step, '.chart-scroll'].map((each) => document.querySelector(each)?.getBoundingClientRect());
  return Boolean(own) && own.height > 0 && own.top >= outer.top && own.bottom <= outer.bottom;
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


IN_PAGE = "() => [...document.querySelectorAll('.sfc .step[data-device]')].map((step) => step.dataset.device)"
HEIGHTS = """() => {
  const outer = document.querySelector('.chart-scroll').getBoundingClientRect();
  const boxes = [...document.querySelectorAll('.sfc .step[data-device] .box')].map((box) => box.getBoundingClientRect());
  return [outer.height, Math.min(...boxes.map((box) => box.top)) - outer.top, Math.max(...boxes.map((box) => box.bottom)) - outer.bottom];
}"""


def scroll_to(bench, height):
    bench.js("(height) => { document.querySelector('.chart-scroll').scrollTop = height; }", height)
    bench.settle()
    bench.settle()


def test_steps_out_of_sight_are_no_elements(long_chart):
    """Of a chart of 100 steps, one below the other, those that are further away than about a panel's height."""
    for height in (0, 4500, 1e6, 2000):
        scroll_to(long_chart, height)
        high, above, below = long_chart.js(HEIGHTS)
        assert above >= -high - 480  # a band is there as a whole
        assert below <= high + 480
        assert above <= 100 or height == 0  # and what is in sight is there
        assert below >= -150 or height == 1e6
        assert 8 < len(long_chart.js(IN_PAGE)) < 40


def test_a_small_chart_is_there_as_a_whole(shown):
    bench = shown("chart")
    assert bench.js(IN_PAGE) == ["S0", "S20"]


def test_marks_of_a_step_are_right_when_it_comes_into_sight(long_chart):
    """S90 becomes active and gets a breakpoint while S0 is looked at; S0 ends while S90 is."""
    session = long_chart.lab.session
    long_chart["chart-follow"].click()
    session.breakpoints.add("S90")
    session.set_step("S90", True)
    long_chart.settle()
    assert "S90" not in long_chart.js(IN_PAGE)
    place = long_chart.js("() => model.get('last').chart.sheet.steps.S90[1]")
    scroll_to(long_chart, place - 200)
    step = long_chart["step-S90"]
    expect(step).to_have_class("step active")
    expect(step).to_have_attribute("data-on", "")
    expect(step).to_have_attribute("aria-label", "S90, breakpoint, active")
    expect(step.locator("xpath=following-sibling::*[2]")).to_have_class("breakpoint")
    waits = "() => document.querySelectorAll('.chart-scroll .tbar.enabled').length"
    assert long_chart.js(waits) == 1
    session.breakpoints.remove("S90")
    session.set_step("S0", False)
    long_chart.settle()
    expect(step).to_have_attribute("aria-label", "S90, active")
    assert "S0" not in long_chart.js(IN_PAGE)
    scroll_to(long_chart, 0)
    expect(long_chart["step-S0"]).to_have_class("step")
    expect(long_chart["step-S0"]).to_have_attribute("aria-label", "S0")
    assert long_chart.js(waits) == 0


def test_a_value_is_right_at_once_when_its_step_was_near_before(long_chart):
    """The steps that were looked at lately go on to be told of; those of long ago are not shown before they are true."""
    session = long_chart.lab.session
    long_chart["chart-follow"].click()
    scroll_to(long_chart, 3000)
    session.set_step("S22", True)
    long_chart.settle()
    scroll_to(long_chart, 9000)
    scroll_to(long_chart, 4000)
    scroll_to(long_chart, 9000)
    session.set_step("S22", False)
    long_chart.js("() => { model.send = () => {}; }")  # nobody answers any more
    long_chart.js("() => { document.querySelector('.chart-scroll').scrollTop = 0; }")
    long_chart.frame()
    steps = long_chart["step-S22"]
    assert steps.count() == 0 or steps.get_attribute("class") == "step"


def test_the_screen_reader_is_told_how_many_steps_there_are(long_chart):
    set_step(long_chart, 90)
    expect(long_chart["step-S90"]).to_have_attribute("aria-setsize", "100")
    expect(long_chart["step-S90"]).to_have_attribute("aria-posinset", "72")  # S0, then S20 to S118
    expect(long_chart["step-S90"]).to_have_attribute("role", "treeitem")


def test_the_arrows_go_on_from_a_step_that_was_scrolled_away(long_chart):
    long_chart["step-S21"].focus()
    for _ in range(30):
        long_chart.page.keyboard.press("ArrowDown")
        long_chart.settle()
    expect(long_chart["step-S51"]).to_be_focused()
    assert long_chart.js(FOUND, '[data-testid="step-S51"]')
    assert "S0" not in long_chart.js(IN_PAGE)
    scroll_to(long_chart, 9000)
    expect(long_chart["step-S51"]).to_be_focused()
    long_chart.page.keyboard.press("ArrowDown")
    long_chart.settle()
    expect(long_chart["step-S52"]).to_be_focused()
    assert long_chart.js(FOUND, '[data-testid="step-S52"]')


def test_a_step_that_keeps_the_focus_far_away_is_whole_when_it_comes_back(long_chart):
    """It is told of no more after many others have been looked at; S21 ends meanwhile."""
    session = long_chart.lab.session
    long_chart["chart-follow"].click()
    session.set_step("S21", True)
    long_chart.settle()
    long_chart["step-S21"].focus()
    for height in (2500, 4500, 6500, 8500, 10500):
        scroll_to(long_chart, height)
    assert 0 not in long_chart.js("() => model.get('last').chart.live")
    expect(long_chart["step-S21"]).to_be_focused()
    session.set_step("S21", False)
    long_chart.settle()
    expect(long_chart["step-S21"]).to_have_attribute("aria-label", "S21")
    scroll_to(long_chart, 0)
    expect(long_chart["step-S21"]).to_have_class("step")
    expect(long_chart["step-S21"]).to_be_focused()


def test_tab_finds_a_step_wherever_the_chart_is_scrolled(long_chart):
    stops = "() => document.querySelectorAll('.sfc .step[tabindex=\"0\"]').length"
    assert long_chart.js(stops) == 1
    long_chart["chart-follow"].click()
    scroll_to(long_chart, 9000)
    assert long_chart.js(stops) == 1
    long_chart["chart-follow"].focus()
    long_chart.page.keyboard.press("Tab")
    assert long_chart.js("() => document.activeElement.matches('.sfc .step')")


def test_a_step_far_away_is_chosen_by_a_click_and_stays_chosen(long_chart):
    set_step(long_chart, 90)
    long_chart["step-S91"].click()
    expect(long_chart["chart"].locator(".who")).to_contain_text("S91")
    scroll_to(long_chart, 0)
    assert "S91" not in long_chart.js(IN_PAGE) or long_chart["step-S91"].evaluate("(step) => step === document.activeElement")
    scroll_to(long_chart, 1e6)
    set_step(long_chart, 92)
    expect(long_chart["step-S91"]).to_have_attribute("data-selected", "")


def test_a_saved_chart_opens_where_it_was_looked_at(long_chart):
    """Without a kernel the page has the bands that were looked at lately, and does not open on an empty place."""
    long_chart["chart-follow"].click()
    scroll_to(long_chart, 7000)
    scroll_to(long_chart, 9300)
    long_chart.js("() => show({ face: model.get('face'), last: structuredClone(model.get('last')) })")
    long_chart.frame()
    long_chart.js("() => { model.gone = true; model.handlers['comm_live_update'](); }")
    long_chart.frame()
    long_chart.frame()
    assert long_chart.js(HEIGHTS)[1] <= 100
    assert "S110" in long_chart.js(IN_PAGE)


def test_a_large_chart_scrolls_in_its_panel_to_its_last_step(long_chart):
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
