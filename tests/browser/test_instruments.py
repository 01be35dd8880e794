"""Trace, microscope, chart, history and ladder in a real JupyterLab: dragged, clicked, typed, pressed and touched; the PLC tells what came of it."""

import nbformat
import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

CELL = """
from ecsim import Plc
from ecsim_widgets import Lab
lab = Lab(Plc("EC20", scan_ms=10, input_filter_ms=0), '''
VAR_GLOBAL
  Part AT X0 // a part is there
  Press AT X5 // a button
  Lamp AT Y1
END_VAR
PROGRAM MAIN
LD Part
EU
OUT Lamp
LD SM1
SET S0
// wait for a part
STL S0
OUT Y2
LD Part
SET S20
// hold it
STL S20
OUT Y3
LD X1
SET S21
LD X2
OUT S0
STL S21
LD X3
OUT S0
RET
LD Press
INC D0
END_PROGRAM
''', name="instruments", autostart=False, controls={"X5": "push"}, trace=["X0", "Y1", "S", "D0"])
lab.plc.run()
"""


class Instruments:
    """The panels in an open notebook, by the names of their controls, and the lab in its kernel."""

    def __init__(self, notebook):
        self.notebook, self.page = notebook, notebook.page

    def __getitem__(self, name):
        return self.page.get_by_test_id(name)

    def lab(self, expression):
        """What the kernel says of the lab."""
        return self.notebook.kernel(f"print(lab.{expression})")

    def becomes(self, expression, text):
        """Wait until the lab says so: what the page asked for comes by way of the server."""
        code = f"import time\nuntil = time.monotonic() + 10\nwhile str(lab.{expression}) != {text!r} and time.monotonic() < until: pass\nprint(lab.{expression})"
        assert self.notebook.kernel(code) == text

    def ten_scans(self):
        """From the beginning: scans 1 to 10 of 10 ms each, the part is there from scan 3 to 5."""
        self.notebook.kernel("lab.session.reset(); lab.session.transitions_held = False; lab.plc.unforce()")
        self.notebook.kernel("for scan in range(1, 11): lab.session.set('X0', int(3 <= scan <= 5)); lab.session.scan()")
        expect(self["scans"]).to_have_text("10")

    def along(self, name, share):
        """A place on a bar, counted from its left end to its right one."""
        box = self[name].bounding_box()
        return box["x"] + box["width"] * share, box["y"] + box["height"] / 2

    def drag(self, name, start, end):
        """Take hold of a bar at one share of its length and let go at another."""
        self[name].hover()
        self.page.mouse.move(*self.along(name, start))
        self.page.mouse.down()
        self.page.mouse.move(*self.along(name, end), steps=4)
        self.page.mouse.up()


@pytest.fixture(scope="module")
def opened(open_notebook, tmp_path_factory):
    """A lab that stands still, with all its panels."""
    expect.set_options(timeout=20_000)
    path = tmp_path_factory.mktemp("instruments") / "instruments.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    cells = [nbformat.v4.new_code_cell(source.strip()) for source in (CELL, "lab")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=kernel), path)
    notebook = open_notebook(path, height=1100)
    notebook.run_all()
    assert notebook.errors() == []
    return Instruments(notebook)


@pytest.fixture
def panels(opened):
    """The same after ten scans."""
    opened.ten_scans()
    return opened


def test_cursors_are_placed_dragged_and_measure(panels):
    panels["trace-all"].click()
    panels.becomes("rig.scope.following", "False")
    begin, span = map(int, panels.lab("rig.scope.window()").strip("()").split(","))
    panels["trace-plane"].scroll_into_view_if_needed()
    box = panels["trace-plane"].bounding_box()
    spot = {ms: {"x": (1000 * ms - begin) / span * box["width"], "y": 80} for ms in (30.4, 45.0, 59.7)}
    panels["trace-plane"].click(position=spot[45.0])
    expect(panels["cursor-A"]).to_be_visible()
    panels["cursor-A"].locator(".grip").hover()
    panels.page.mouse.down()
    panels.page.mouse.move(box["x"] + spot[30.4]["x"], panels["cursor-A"].bounding_box()["y"] + 10, steps=4)
    panels.page.mouse.up()
    panels.becomes("rig.scope.cursors['A']", "30000")  # caught by the edge of X0
    panels["trace-plane"].click(position=spot[59.7], modifiers=["Shift"])
    expect(panels["trace"].locator(".interval text")).to_have_text("30 ms · 3 scans")
    panels["lane-X0"].focus()
    panels["lane-X0"].press("ArrowLeft")  # the cursor that was placed last, to the edge before
    panels.becomes("rig.scope.cursors", "{'A': 30000, 'B': 30000}")
    panels.page.keyboard.press("Escape")
    panels.becomes("rig.scope.cursors", "{'A': None, 'B': None}")


def test_a_trigger_is_armed_by_typing_and_fires_while_the_plc_runs(panels):
    field = panels["trace-trigger"]
    field.fill("Lamp rises")
    field.press("Enter")
    armed = panels["trace"].locator(".armed")
    expect(armed).to_have_text("waits for the trigger")
    panels["run"].click()
    expect(panels["transport"]).to_have_attribute("data-state", "running")
    panels["X0"].click()
    expect(armed).to_contain_text("trigger at ")
    expect(panels["trace-follow"]).to_have_attribute("aria-pressed", "false")
    panels["run"].click()
    expect(panels["transport"]).to_have_attribute("data-state", "paused")
    assert panels.lab("plc['S20']") == "1"
    hit = float(armed.inner_text().removeprefix("trigger at ").removesuffix(" s"))
    assert hit * 1e6 == pytest.approx(int(panels.lab("rig.scope.hit_us")), abs=500)
    panels["trace"].locator(".panel-body").focus()
    panels.page.keyboard.press("h")
    expect(panels["trace-follow"]).to_have_attribute("aria-pressed", "true")


@pytest.mark.parametrize(("form", "beginning"), [("csv", b"time_s,scan,X0,Y1,S,D0\n"), ("vcd", b"$version"), ("png", b"\x89PNG")])
def test_the_trace_is_kept_as_a_file(panels, form, beginning):
    with panels.page.expect_download() as waited:
        panels[f"trace-{form}"].click()
    with open(waited.value.path(), "rb") as file:
        assert file.read().startswith(beginning)


def test_the_microscope_goes_through_the_scan_of_the_hand_over(panels):
    """7.4.1(5): both steps' outputs are on in the scan in which the second one is reached."""
    panels.notebook.kernel("lab.session.back(8)")
    expect(panels["scans"]).to_have_text("2")
    panels.notebook.kernel("lab.session.set('X0', 1)")
    panels["micro-next"].click()
    expect(panels["micro-words"]).to_have_text("The inputs are latched: Part X0 goes on.")
    place = panels["micro-place"]
    place.focus()
    place.press("ArrowRight")
    expect(panels["microscope"].locator(".sub")).to_contain_text("instruction 1 of ")
    panels["micro-on"].click()
    expect(panels["microscope"].locator(".sub")).to_contain_text("instruction 2 of ")
    for _ in range(2):
        place.press("ArrowDown")
    expect(panels["micro-words"]).to_contain_text("SET S20: power flows, S20 goes from 0 to 1 and S0 goes from 1 to 0.")
    bits = panels["micro-points"].locator("tbody tr", has_text="Y3").locator(".bit")
    expect(bits).to_have_text(["0", "0"])
    place.press("End")
    expect(panels["microscope"].locator(".phases [aria-current]")).to_have_text("Output refresh")
    expect(bits).to_have_text(["1", "1"])
    both = panels["micro-points"].locator("tbody tr", has_text="Y2").locator(".bit")
    expect(both).to_have_text(["1", "1"])
    panels["micro-back"].click()
    expect(panels["microscope"].locator(".phases [aria-current]")).to_have_text("Housekeeping")
    expect(bits).to_have_text(["1", "0"])  # the program has written it, the terminal has not got it
    assert panels.lab("plc['Y2'], lab.plc['Y3'], lab.plc['S0']") == "1 1 0"


def test_the_chart_is_held_fired_set_reset_and_gone_back_over(panels):
    expect(panels["step-S20"]).to_have_attribute("data-on", "")
    panels["hold"].click()
    expect(panels["hold"]).to_have_attribute("aria-pressed", "true")
    panels["X1"].click()
    panels["scan"].click()
    expect(panels["scans"]).to_have_text("11")
    assert panels.lab("plc['S20'], lab.plc['S21']") == "1 0"  # held although the condition holds
    panels["fire-S21"].click()
    expect(panels["step-S21"]).to_have_attribute("data-on", "")
    assert panels.lab("plc['S20'], lab.plc['S21']") == "0 1"
    expect(panels["log"].locator("li").first).to_contain_text("S20 → S21")
    panels["step-S0"].focus()
    panels["step-S0"].press("Enter")
    panels["set-step"].click()
    panels.becomes("plc['S0']", "1")
    panels["reset-step"].click()
    panels.becomes("plc['S0']", "0")
    panels["back"].click()
    expect(panels["chip"]).to_contain_text("back")
    expect(panels["step-S20"]).to_have_attribute("data-on", "")
    assert panels.lab("plc['S20']") == "1"


def test_a_breakpoint_on_a_step_stops_the_run_and_next_step_goes_on(panels):
    panels["step-S0"].focus()
    panels["step-S0"].press("b")
    expect(panels["step-S0"]).to_have_attribute("aria-label", "S0 wait for a part, breakpoint")
    panels["run"].click()
    panels["X2"].click()
    expect(panels["chip"]).to_contain_text("Stopped: S0 began")
    panels.becomes("session.state", "paused")
    assert panels.lab("plc['S0'], lab.plc['S20']") == "1 0"
    panels["X2"].click()
    panels["X0"].click()
    panels["next-step"].click()
    expect(panels["step-S20"]).to_have_attribute("data-on", "")
    panels["step-S0"].focus()
    panels["step-S0"].press("b")
    panels.becomes("session.breakpoints.__len__()", "0")


def test_the_handle_of_the_past_is_dragged_and_brought_back_to_now(panels):
    panels.drag("history", 1.0, 0.2)
    panels.becomes("plc.scans", "2")
    expect(panels["chip"]).to_have_text("8 scans back")
    expect(panels["step-S0"]).to_have_attribute("data-on", "")
    expect(panels["scans"]).to_have_text("2")
    panels["history"].focus()
    panels["history"].press("PageDown")  # the next step change
    expect(panels["step-S20"]).to_have_attribute("data-on", "")
    assert panels.lab("plc.scans") == "3"
    panels["history"].press("ArrowLeft")
    expect(panels["step-S0"]).to_have_attribute("data-on", "")
    panels["history"].press("End")
    expect(panels["scans"]).to_have_text("10")
    panels.becomes("session.in_past", "False")


def test_the_ladder_writes_by_double_click_and_forces_and_finds_by_keys(panels):
    ladder = panels["ladder"]
    box = ladder.locator('[data-device="D0"]').first
    box.dblclick()
    panels["plate-value"].fill("16#20")
    panels["plate-value"].press("Enter")
    panels.becomes("plc['D0']", "32")
    coil = ladder.locator('.coil[data-device="Y1"]')
    coil.focus()
    coil.press("Enter")
    panels["force-on"].press("Enter")
    panels.becomes("plc.forced", "{'Y1': 1}")
    panels["release"].click()
    panels.becomes("plc.forced", "{}")
    panels.page.keyboard.press("Escape")
    contact = ladder.locator('[data-device="X0"]').first
    contact.focus()
    contact.press("u")
    uses = panels["uses"].locator("button")
    expect(uses).to_have_count(2)
    uses.nth(1).click()
    expect(panels["uses"]).to_have_count(0)
    chosen = panels.page.evaluate("() => Number(document.activeElement.dataset.position)")
    assert panels.lab(f"plc.program.instructions[{chosen}]") == "LD Part"
    assert chosen != int(contact.get_attribute("data-position"))


def test_a_push_button_is_held_by_a_finger(panels):
    button = panels["X5"]
    button.scroll_into_view_if_needed()
    box = button.bounding_box()
    finger = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
    touch = panels.page.context.new_cdp_session(panels.page)
    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [finger]})
    panels.becomes("rig.terminal('X5')", "1")
    panels.notebook.kernel("lab.session.scan(3)")
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    touch.detach()
    panels.notebook.kernel("lab.session.scan(3)")
    panels.becomes("rig.terminal('X5')", "0")
    assert int(panels.lab("plc['D0']")) >= 3
    expect(button).to_have_attribute("aria-pressed", "false")


def test_a_saved_notebook_opened_again_shows_the_last_state(panels, server):
    """JupyterLab keeps the panels' state in the notebook; another kernel has no lab behind it."""
    page = panels.page
    scans, path = panels["scans"].inner_text(), page.evaluate("() => window.jupyterapp.shell.currentWidget.context.path")
    panels.notebook.command("docmanager:save")
    page.wait_for_function("() => !window.jupyterapp.shell.currentWidget.context.model.dirty")
    again = page.context.browser.new_page(viewport={"width": 1280, "height": 1100})
    try:
        page.evaluate("() => window.jupyterapp.shell.currentWidget.sessionContext.shutdown()")
        again.goto(f"{server.address}/lab/tree/{path}?token={server.token}&reset")
        expect(again.get_by_test_id("chip")).to_have_text("Not connected: the last state", timeout=60_000)
        expect(again.get_by_test_id("scans")).to_have_text(scans)
        expect(again.get_by_test_id("step-S20")).to_have_attribute("data-on", "")
        expect(again.get_by_test_id("ladder").locator(".stamp")).to_have_text(f"last state · scan {scans}")
        expect(again.get_by_test_id("run")).to_be_disabled()
    finally:
        again.close()
