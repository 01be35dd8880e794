"""The trace and the scan microscope in a bare page, with the real panels behind them: mouse, wheel, keys, fields, files."""

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

PROGRAM = """PROGRAM MAIN
LD X0
EU
OUT Y1
LD SM1
SET S0
STL S0
OUT Y2
LD X0
SET S20
STL S20
OUT Y3
RET
LD SM0
INC D0
END_PROGRAM"""


@pytest.fixture
def still(make_lab):
    """Ten scans of 10 ms with X0 on from scan 3 to 5."""
    made = make_lab(PROGRAM, trace=["X0", "Y1", "S", "D0"])
    for scan in range(1, 11):
        made.session.set("X0", int(3 <= scan <= 5))
        made.session.scan()
    return made


@pytest.fixture
def trace(bench, still):
    """The trace, with all of the hundred milliseconds in sight."""
    bench.connect(still.panel("trace"))
    bench["trace-all"].click()
    bench.settle()
    bench.scope = still.rig.scope
    return bench


def spot(bench, ms):
    """Where a moment stands on the plane, relative to it."""
    begin, span = bench.scope.window()
    box = bench["trace-plane"].bounding_box()
    return {"x": (1000 * ms - begin) / span * box["width"], "y": 80}


def test_lanes_are_drawn_and_a_pulse_of_one_scan_has_its_pin(trace):
    assert trace.page.locator("svg.trace .lane").count() == 4
    for _ in range(5):
        trace["trace"].locator(".panel-body").press("-")
        trace.settle()
    assert trace.page.locator("svg.trace .pin").count() == 1
    expect(trace.page.locator("svg.trace .bus-text", has_text="S20")).not_to_have_count(0)


def test_a_click_places_a_cursor_and_a_second_one_measures(trace):
    trace["trace-plane"].click(position=spot(trace, 30.2))
    trace.settle()
    assert trace.scope.cursors == {"A": 30_000, "B": None}  # caught by the edge
    trace["trace-plane"].click(position=spot(trace, 59.8), modifiers=["Shift"])
    trace.settle()
    assert trace.scope.cursors == {"A": 30_000, "B": 60_000}
    expect(trace.page.locator(".interval text")).to_have_text("30 ms · 3 scans")
    expect(trace["cursor-B"]).to_have_attribute("aria-valuetext", "0.060000 s")


def test_a_cursor_is_dragged_and_goes_from_edge_to_edge_by_keys(trace):
    trace["trace-plane"].click(position=spot(trace, 45))
    trace.settle()
    trace["cursor-A"].locator(".grip").hover()
    trace.page.mouse.down()
    box = trace["trace-plane"].bounding_box()
    trace.page.mouse.move(box["x"] + spot(trace, 60.1)["x"], box["y"] + 10, steps=4)
    trace.settle()
    trace.page.mouse.up()
    trace.settle()
    assert trace.scope.cursors["A"] == 60_000
    trace["lane-X0"].focus()
    trace["lane-X0"].press("ArrowLeft")
    trace.settle()
    assert trace.scope.cursors["A"] == 30_000


def test_the_plane_is_pulled_along_and_zoomed_by_the_wheel(trace):
    begin, span = trace.scope.window()
    trace.js("() => document.activeElement.blur()")
    trace["trace-plane"].hover(position=spot(trace, 60))
    trace.page.mouse.wheel(0, -400)
    trace.settle()
    assert trace.scope.window() == (begin, span)  # without the focus the wheel is the page's
    trace["trace"].locator(".panel-body").focus()
    trace.page.mouse.wheel(0, -400)
    trace.settle()
    now_begin, now_span = trace.scope.window()
    assert abs(now_span - span / 2) < 100
    assert abs((60_000 - now_begin) / now_span - (60_000 - begin) / span) < 0.01  # the moment under the pointer stays
    box = trace["trace-plane"].bounding_box()
    trace.page.mouse.move(box["x"] + 300, box["y"] + 90)
    trace.page.mouse.down()
    trace.page.mouse.move(box["x"] + 200, box["y"] + 90, steps=3)
    trace.settle()
    trace.page.mouse.up()
    trace.settle()
    assert abs(trace.scope.window()[0] - now_begin - 100 / box["width"] * now_span) < 100
    assert trace.scope.cursors["A"] is None


def test_lanes_are_added_moved_and_removed_by_keys(trace):
    trace["trace-add"].fill("M5 C0")
    trace["trace-add"].press("Enter")
    trace.settle()
    assert [lane.name for lane in trace.scope.lanes] == ["X0", "Y1", "S", "D0", "M5", "C0"]
    expect(trace["trace-add"]).to_have_value("")
    trace["lane-Y1"].focus()
    trace["lane-Y1"].press("Alt+ArrowUp")
    trace.settle()
    trace["lane-D0"].focus()
    trace["lane-D0"].press("Enter")
    trace.settle()
    assert trace.scope.lanes[3].style == "bus"
    trace["lane-X0"].focus()
    trace["lane-X0"].press("Delete")
    trace.settle()
    assert [lane.name for lane in trace.scope.lanes] == ["Y1", "S", "D0", "M5", "C0"]


def test_what_is_refused_is_said_and_the_field_keeps_it(trace):
    trace["trace-add"].fill("Q9")
    trace["trace-add"].press("Enter")
    trace.settle()
    expect(trace["trace-refused"]).to_contain_text("'Q9' is no device of EC20")
    expect(trace["trace-add"]).to_have_value("Q9")
    trace["trace-trigger"].fill("X0 jumps")
    trace["trace-trigger"].press("Enter")
    trace.settle()
    expect(trace["trace-refused"]).to_contain_text("'X0 jumps' is no condition")
    expect(trace["trace-trigger"]).to_have_value("X0 jumps")


def test_a_trigger_waits_and_holds(trace, still):
    trace["trace-trigger"].fill("X0 rises")
    trace["trace-trigger"].press("Enter")
    trace.settle()
    expect(trace["trace"].locator(".armed")).to_have_text("waits for the trigger")
    expect(trace["trace-follow"]).to_have_attribute("aria-pressed", "true")
    still.session.set("X0", 1)
    still.session.scan(3)
    trace.settle()
    expect(trace["trace"].locator(".armed")).to_have_text("trigger at 0.110 s")
    expect(trace["trace-follow"]).to_have_attribute("aria-pressed", "false")
    expect(trace.page.locator(".trig")).to_be_visible()


@pytest.mark.parametrize(("form", "beginning"), [("csv", b"time_s,scan,X0,Y1,S,D0\n"), ("vcd", b"$version"), ("png", b"\x89PNG")])
def test_a_file_is_kept(trace, form, beginning):
    with trace.page.expect_download() as waited:
        trace[f"trace-{form}"].click()
        trace.settle()
    assert waited.value.suggested_filename == f"trace.{form}"
    with open(waited.value.path(), "rb") as file:
        assert file.read().startswith(beginning)


def test_the_microscope_shows_the_hand_over_of_one_scan(bench, still):
    """7.4.1(5): both outputs are on in the scan in which the second step is reached."""
    still.session.back(8)  # scan 3 is the next one
    bench.connect(still.panel("microscope"))
    bench["micro-next"].click()
    bench.settle()
    expect(bench["micro-words"]).to_have_text("The inputs are latched: X0 goes on.")
    outputs = bench["micro-points"].locator("tbody tr")
    bits = outputs.locator(".bit")
    bench["micro-place"].focus()
    bench["micro-place"].press("End")
    bench.settle()
    assert dict(zip(outputs.locator(".dev").all_inner_texts(), zip(*[iter(bits.all_inner_texts())] * 2, strict=True), strict=True)) == {
        "Y1": ("1", "1"),
        "Y2": ("1", "1"),
        "Y3": ("1", "1"),
    }
    expect(bench["microscope"].locator(".phases [aria-current]")).to_have_text("Output refresh")
    bench["micro-place"].press("Home")
    bench.settle()
    for _ in range(2):
        bench["micro-place"].press("ArrowDown")
        bench.settle()
    expect(bench["micro-words"]).to_have_text("SET S20: power flows, S20 goes from 0 to 1 and S0 goes from 1 to 0.")
    assert bench["micro-net"].locator(".here").count() == 1
    assert bench["micro-writes"].locator('[data-is="here"]').count() == 2
    bench["micro-on"].click()
    bench.settle()
    expect(bench["micro-words"]).not_to_contain_text("SET S20")


def test_the_microscope_plays(bench, still):
    bench.connect(still.panel("microscope"))
    bench["micro-play"].click()
    expect(bench["micro-play"]).to_have_attribute("aria-pressed", "true")
    bench.page.wait_for_function("() => model.sent.some((message) => message.do === 'move')")
    bench.settle()
    expect(bench["microscope"].locator(".sub")).to_contain_text("instruction 1 of")
    bench["micro-play"].click()
    expect(bench["micro-play"]).to_have_attribute("aria-pressed", "false")
