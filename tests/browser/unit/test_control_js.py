"""Run control and chart in a bare page, on a real PLC that stands still: the bar of the past, breakpoints, the chart by hand."""

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

PROGRAM = """
VAR_GLOBAL
  Part AT X0
END_VAR
PROGRAM MAIN
LD SM1
SET S0
// wait for a part
STL S0
LD Part
SET S20
// hold it
STL S20
OUT Y2
LD X1
SET S21
LD X2
OUT S0
STL S21
LD X3
OUT S0
RET
LD SM0
INC D0
END_PROGRAM
"""


@pytest.fixture
def real(bench, make_lab):
    """A lab whose machine stands in S20 after 60 scans."""
    real = make_lab(PROGRAM)
    real.session.scan(20)
    real.session.set("X0", 1)
    real.session.scan(40)
    bench.connect(real)
    return real


def drag(bench, share):
    """Put the hand on the bar at a share of its length; it is still there."""
    box = bench["history"].bounding_box()
    bench.page.mouse.move(box["x"] + box["width"] * share, box["y"] + box["height"] / 2)


def test_the_handle_is_dragged_into_the_past_and_stays_there(bench, real):
    drag(bench, 1)
    bench.page.mouse.down()
    drag(bench, 0.25)
    bench.settle()
    assert real.plc.scans == 15
    expect(bench["chip"]).to_have_text("45 scans back")
    expect(bench["step-S0"]).to_have_attribute("data-on", "")
    drag(bench, 0.5)
    bench.settle()
    assert real.plc.scans == 30
    expect(bench["step-S20"]).to_have_attribute("data-on", "")
    bench.page.mouse.up()
    bench.settle()
    assert (real.plc.scans, real.session.in_past) == (30, True)
    expect(bench["transport"]).to_have_class("transport past")
    expect(bench["transport"].locator(".clock .past")).to_have_text("−300 ms")
    bench["scan"].click()
    bench.settle()
    assert (real.plc.scans, real.session.in_past) == (31, False)
    expect(bench["history"]).to_have_attribute("aria-valuemax", "31")


def test_the_handle_goes_by_keys(bench, real):
    bench["history"].focus()
    for key, scan in (("ArrowLeft", 59), ("PageUp", 21), ("PageUp", 1), ("Home", 0), ("PageDown", 1), ("ArrowRight", 2), ("End", 60)):
        bench.page.keyboard.press(key)
        bench.settle()
        assert real.plc.scans == scan
    assert not real.session.in_past


def test_step_changes_are_ticks(bench, real):
    ticks = bench["history"].locator(".ev.s")
    assert [tick.get_attribute("title") for tick in ticks.all()] == ["S0, scan 1", "S20, scan 21"]


def test_ticks_move_twice_a_second_while_it_runs_and_stand_right_when_it_stops(bench):
    bench.show({"transport": {}})
    bench.js("() => { window.moment = 1000; performance.now = () => window.moment; }")
    left = "() => [...document.querySelectorAll('.ev')].map((tick) => tick.style.left)"

    def scan(number, moment, state="running", **more):
        bench.js("(moment) => { window.moment = moment; }", moment)
        bench.tell(n=1, state={"run": {"state": state, "scan": number, "time_us": 10_000 * number}, **more})
        return bench.js(left)

    try:
        first = {"first": 0, "events": [[50, "step", "S20"]]}
        assert scan(100, 2000, transport=first) == ["50%"]
        assert scan(125, 2400) == ["50%"]
        assert scan(200, 2501) == ["25%"]
        assert scan(400, 2600, transport={"events": [[50, "step", "S20"], [300, "step", "S21"]]}) == ["25%", "75%"]  # a new one at once
        assert scan(500, 2700, "paused") == ["10%", "60%"]
    finally:
        bench.js("() => { delete performance.now; }")


def test_a_breakpoint_is_written_kept_refused_and_switched_off(bench, real):
    bench["breaks"].click()
    field = bench["break-text"]
    field.fill("D0 >")
    field.press("Enter")
    bench.settle()
    expect(bench["break-problem"]).to_contain_text("is no condition")
    expect(field).to_have_value("D0 >")
    field.fill("D0 > 70")
    bench["break-add"].click()
    bench.settle()
    expect(field).to_have_value("")
    expect(bench["break-problem"]).to_be_hidden()
    assert [point.text for point in real.session.breakpoints] == ["D0 > 70"]
    real.session.scan(100)
    bench.settle()
    assert real.plc["D0"] == 71
    expect(bench["points"]).to_contain_text("1 stop")
    bench["break-0"].click()
    bench.settle()
    assert not real.session.breakpoints["D0 > 70"].enabled
    bench["break-0-remove"].click()
    bench.settle()
    assert len(real.session.breakpoints) == 0
    field.press("Escape")
    expect(bench["points"]).to_be_hidden()


def test_the_chart_is_broken_held_and_fired_by_keys_and_buttons(bench, real):
    bench["step-S21"].click()
    bench["step-S21"].focus()
    bench.page.keyboard.press("b")
    bench.settle()
    assert "S21" in real.session.breakpoints
    expect(bench["break"]).to_have_attribute("aria-pressed", "true")
    expect(bench["step-S21"]).to_have_attribute("aria-label", "S21, breakpoint")
    bench["hold"].click()
    bench.settle()
    assert real.session.transitions_held
    expect(bench["hold"]).to_have_attribute("aria-pressed", "true")
    bench["step-S20"].click()
    bench["fire-S21"].click()
    bench.settle()
    assert real.plc["S21"] == 1
    bench["step-S21"].focus()
    bench.page.keyboard.press("f")
    bench.settle()
    assert (real.plc["S21"], real.plc["S0"]) == (0, 1)


def test_a_choice_of_transitions_is_refused_in_words(bench, real):
    bench["step-S20"].focus()
    bench.page.keyboard.press("f")
    bench.settle()
    assert real.plc["S20"] == 1
    expect(bench["chip"]).to_contain_text("2 transitions lead out of S20")


def test_a_step_is_set_and_reset_by_hand(bench, real):
    bench["step-S21"].click()
    bench["set-step"].click()
    bench.settle()
    assert real.plc["S21"] == 1
    bench["reset-step"].click()
    bench.settle()
    assert real.plc["S21"] == 0


def test_a_step_shows_its_network_in_the_ladder(bench, real):
    bench["step-S21"].click()
    bench["network"].click()
    position = bench.js("() => Number(document.activeElement.dataset.position)")
    assert str(real.plc.program.instructions[position]).startswith(("STL S21", "LD X3"))


def test_without_a_kernel_the_past_stays_readable_and_rests(bench, real):
    bench.js("() => { model.gone = true; document.querySelector('[data-testid=scan]').click(); }")
    expect(bench["history"]).to_have_attribute("aria-disabled", "true")
    expect(bench["history"].locator(".ev.s")).to_have_count(2)


@pytest.mark.parametrize("width", [700, 900, 1280])
def test_the_bar_of_the_past_has_the_row_for_itself(bench, real, width):
    bench.page.set_viewport_size({"width": width, "height": 900})
    bench.connect(real.panel("transport"))
    assert bench["history"].bounding_box()["width"] > width - 240
