"""The first notebook in a real JupyterLab: every control is pressed, and what it does is seen on the page."""

import re

import pytest

pytestmark = pytest.mark.browser

CONNECTED = "() => Boolean(window.jupyterapp.shell.currentWidget?.sessionContext?.session?.kernel)"
NOTEBOOK = "01-first-light.ipynb"
TOO_WIDE = """(panel) => [...panel.querySelectorAll('*:not(svg *)')].filter((node) => {
  const box = panel.getBoundingClientRect();
  const mine = node.getBoundingClientRect();
  return mine.width && !node.closest('.scroll') && (mine.right > box.right + 1 || mine.left < box.left - 1);
})"""
BUSY_UNTIL_X7 = """
import time
deadline = time.monotonic() + 20
while not lab.plc["X7"] and time.monotonic() < deadline: pass
print("X7 is", lab.plc["X7"])"""
EXECUTE_LATER = """(code) => {
  const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
  const future = kernel.requestExecute({ code, store_history: false });
  window.said = '';
  future.onIOPub = (message) => { if (message.header.msg_type === 'stream') window.said += message.content.text; };
}"""


class Bench:
    """The lab in an open notebook, by the names of its controls."""

    def __init__(self, notebook, expect):
        self.notebook, self.expect = notebook, expect
        self.lab = notebook.page.get_by_test_id("ec").first

    def __getitem__(self, name):
        return self.lab.get_by_test_id(name)

    def press(self, *names):
        for name in names:
            self[name].click()

    def state(self, state):
        self.expect(self["transport"]).to_have_attribute("data-state", state)

    def lit(self, *names):
        for name in names:
            self.expect(self[name]).to_have_attribute("data-on", "")

    def dark(self, *names):
        for name in names:
            self.expect(self[name]).not_to_have_attribute("data-on", "")

    def scans(self):
        return int(self["scans"].inner_text().replace(",", ""))

    def hold(self):
        """Pause, and wait until the page shows the scan at which it stands."""
        self.press("run")
        self.state("paused")
        scan = self.notebook.kernel("print(f'{lab.plc.scans:,}')")
        self.expect(self["scans"]).to_have_text(scan)

    def coil(self, device):
        """The first coil of a device in the ladder."""
        return self["ladder"].locator(f'.coil[data-device="{device}"]').first


def run_notebook(open_notebook, **size):
    """Open the first notebook, run all of it, and start its lab again, which the last cell has stopped."""
    from playwright.sync_api import expect

    expect.set_options(timeout=20_000)
    notebook = open_notebook(NOTEBOOK, **size)
    notebook.run_all()
    assert notebook.errors() == []
    bench = Bench(notebook, expect)
    bench.state("stopped")
    bench.press("run")
    bench.state("running")
    return bench


@pytest.fixture(scope="module")
def opened(open_notebook):
    """The lab of the first notebook; the tests share it."""
    return run_notebook(open_notebook)


@pytest.fixture
def bench(opened):
    """The lab as at the beginning, running, with its machine."""
    opened.notebook.kernel("lab.session.speed = 1.0; lab.session.reset(); lab.session.run()")
    opened.state("running")
    opened.expect(opened["plant"]).to_have_attribute("aria-checked", "true")
    return opened


@pytest.fixture
def by_hand(bench):
    """The same with the machine disconnected and the start button pressed: in the first step."""
    bench.press("plant")
    bench.expect(bench["plant"]).to_have_attribute("aria-checked", "false")
    bench.press("X5")
    bench.lit("lamp-Y4", "lamp-Y5", "step-S0")
    return bench


def test_a_switch_lights_lamp_rung_and_step(by_hand):
    bench = by_hand
    bench.dark("lamp-X0", "lamp-Y0", "step-S20")
    bench.press("X0")
    bench.expect(bench["X0"]).to_have_attribute("aria-checked", "true")
    bench.lit("lamp-X0", "step-S20", "lamp-Y0")
    bench.dark("step-S0")
    bench.expect(bench.coil("Y0")).to_have_class(re.compile("flow"))
    bench.press("X1")
    bench.lit("step-S21", "lamp-Y1", "lamp-Y2")
    bench.dark("lamp-Y0")


def test_the_machine_drives_its_sensors_and_moves(bench):
    bench.press("X5")
    bench.lit("lamp-Y4")
    bench.expect(bench["X0"]).to_have_attribute("data-kind", "machine")
    drum = bench["machine"].locator('[id$="drum-left-0"]')
    before = drum.get_attribute("transform")
    bench.expect(drum).not_to_have_attribute("transform", before)
    bench["speed"].press("End")  # as fast as it goes: the pallet comes to the gate and through it
    bench.lit("lamp-X0", "step-S20", "step-S21")


def test_pause_one_scan_next_step_back_and_reset(by_hand):
    bench = by_hand
    bench.hold()
    scan, clock = bench.scans(), bench["clock"].inner_text()
    bench.press("scan")
    bench.expect(bench["scans"]).to_have_text(f"{scan + 1:,}")
    bench.expect(bench["clock"]).not_to_have_text(clock)
    bench.press("back")
    bench.expect(bench["scans"]).to_have_text(f"{scan:,}")
    bench.expect(bench["clock"]).to_have_text(clock)
    bench.press("X0", "next-step")
    bench.lit("step-S20")
    bench.expect(bench["log"].locator("li").first).to_contain_text("S0 → S20")
    bench.expect(bench["chart"]).to_contain_text("InLift")  # what it waits for, in words
    bench.state("paused")
    bench.press("reset")
    bench.expect(bench["scans"]).to_have_text("0")
    bench.dark("step-S20", "step-S0")
    bench.expect(bench["plant"]).to_have_attribute("aria-checked", "true")  # all is as it was at first


def test_the_keys_of_the_keyboard_do_the_same(by_hand):
    bench, page = by_hand, by_hand.notebook.page
    bench["run"].focus()
    page.keyboard.press("r")
    bench.state("paused")
    scan = int(bench.notebook.kernel("print(lab.plc.scans)"))
    page.keyboard.press("Space")
    bench.expect(bench["scans"]).to_have_text(f"{scan + 1:,}")
    page.keyboard.press("ArrowLeft")
    bench.expect(bench["scans"]).to_have_text(f"{scan:,}")
    bench["X0"].focus()
    page.keyboard.press("Space")
    bench.expect(bench["X0"]).to_have_attribute("aria-checked", "true")
    bench.expect(bench["scans"]).to_have_text(f"{scan:,}")  # it flips the switch, it is not one scan
    page.keyboard.press("n")
    bench.lit("step-S20")


def test_the_speed_has_detents(bench):
    for key, words in (("ArrowRight", "2 times real time"), ("Home", "0.25 times real time"), ("End", "as fast as possible")):
        bench["speed"].press(key)
        bench.expect(bench["speed"]).to_have_attribute("aria-valuetext", words)
    assert bench.notebook.kernel("print(lab.session.speed)") == "None"


def test_a_point_can_be_forced_and_released(by_hand):
    bench = by_hand
    bench.press("lamp-Y3", "force-on")
    bench.lit("lamp-Y3")
    bench.expect(bench["lamp-Y3"]).to_have_attribute("data-forced", "")
    bench.press("release")
    bench.expect(bench["lamp-Y3"]).not_to_have_attribute("data-forced", "")


def test_a_sensor_can_be_taken_from_the_machine_and_given_back(bench):
    bench.press("X4")
    bench.expect(bench["X4"]).to_have_attribute("data-kind", "stuck")
    bench.lit("lamp-X4")
    bench.press("X4")
    bench.expect(bench["X4"]).to_have_attribute("data-kind", "machine")
    bench.dark("lamp-X4")


def test_the_panel_works_while_a_cell_is_busy(by_hand):
    bench, page = by_hand, by_hand.notebook.page
    page.evaluate(EXECUTE_LATER, BUSY_UNTIL_X7)
    clock = bench["clock"].inner_text()
    bench.expect(bench["clock"]).not_to_have_text(clock)
    bench.press("X7")
    page.wait_for_function("() => window.said !== ''")
    assert page.evaluate("() => window.said.trim()") == "X7 is 1"
    bench.lit("lamp-X7")


def test_cells_work_while_it_runs(bench):
    assert bench.notebook.kernel("print(6 * 7)") == "42"
    bench.notebook.kernel("lab.session.set('X7', 1)")
    bench.lit("lamp-X7")


def test_running_the_cell_again_leaves_one_loop(bench):
    cell = next(index for index, source in enumerate(bench.notebook.sources()) if "lab = Lab(" in source)
    for _ in range(2):
        former = bench.notebook.kernel("print(id(lab))")
        bench.notebook.run_cell(cell)
        bench.notebook.wait_until_idle()
        assert bench.notebook.kernel("print(id(lab))") != former
    loops = bench.notebook.kernel("import threading; print([t.name for t in threading.enumerate()].count('ecsim lab'))")
    assert loops == "1"
    bench.state("running")
    bench.press("X7")
    bench.lit("lamp-X7")


def test_a_second_view_shows_the_same(by_hand):
    bench = by_hand
    bench.press("X0")
    bench.lit("step-S20")
    cell = next(index for index, source in enumerate(bench.notebook.sources()) if "lab = Lab(" in source)
    bench.notebook.page.evaluate("(index) => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = index }", cell)
    page = bench.notebook.page
    bench.notebook.command("notebook:create-output-view")
    try:
        second = page.get_by_test_id("ec").last.get_by_test_id
        bench.expect(second("step-S20")).to_have_attribute("data-on", "")
        second("X1").click()
        bench.expect(second("step-S21")).to_have_attribute("data-on", "")
        bench.lit("step-S21")
    finally:
        page.evaluate("() => window.jupyterapp.shell.currentWidget.close()")
        page.wait_for_function(CONNECTED)


def test_without_a_kernel_the_last_state_stays_and_says_so(open_notebook):
    bench = run_notebook(open_notebook)
    bench.press("reset", "plant", "X5")
    bench.lit("step-S0")
    bench.press("X0")
    bench.lit("step-S20")
    bench.notebook.page.evaluate("() => window.jupyterapp.shell.currentWidget.sessionContext.shutdown()")
    bench.expect(bench["chip"]).to_have_text("Not connected: the last state")
    bench.expect(bench["run"]).to_be_disabled()
    bench.lit("step-S20", "lamp-X0")
    bench.expect(bench["ladder"].locator(".stamp")).to_contain_text("last state")


@pytest.mark.parametrize("width", [900, 1280, 1920])
def test_nothing_overflows(bench, width):
    page = bench.notebook.page
    page.set_viewport_size({"width": width, "height": 900})
    for panel in page.get_by_test_id("ec").all():
        panel.evaluate("(panel) => panel.scrollIntoView()")  # what is out of sight is not laid out
        bench.expect(panel.get_by_test_id("chart").or_(panel.get_by_test_id("unit")).first).to_be_visible()
        page.wait_for_function(f"(panel) => ({TOO_WIDE})(panel).length === 0", arg=panel.element_handle())
