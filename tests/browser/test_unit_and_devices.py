"""Unit, device table and timers in a real JupyterLab: typed, clicked, dragged and pressed; the PLC tells what came of it."""

import nbformat
import pytest

pytestmark = pytest.mark.browser

CELLS = [
    """
from ecsim_widgets import Lab
lab = Lab("EC20", '''
VAR_GLOBAL
  Start AT X5 // start button
  Knob AT D5
END_VAR
PROGRAM MAIN
LD Start
OUT Y0
TON T0 30000
LD SM0
VRRD 0 Knob
INC D100
END_PROGRAM
''', name="by hand", controls={"X5": "push"}, devices=["D0-D7999"])
lab.panel("unit")
""",
    'lab.panel("devices")',
    'lab.panel("timers")',
]
TOO_WIDE = """(panel) => [...panel.querySelectorAll('*:not(svg *)')].filter((node) => {
  const [box, mine] = [panel.getBoundingClientRect(), node.getBoundingClientRect()];
  return mine.width && !node.closest('.scroll, .visually-hidden') && (mine.right > box.right + 1 || mine.left < box.left - 1);
}).length"""


class Panels:
    """The panels in an open notebook, by the names of their controls."""

    def __init__(self, notebook, expect):
        self.notebook, self.expect = notebook, expect

    def __getitem__(self, name):
        return self.notebook.page.get_by_test_id(name)

    def plc(self, expression):
        """What the kernel says of the PLC."""
        return self.notebook.kernel(f"print(lab.plc{expression})")

    def wait(self, expression, value):
        """Wait until the PLC says so."""
        code = f"import time\nuntil = time.monotonic() + 10\nwhile lab.plc{expression} != {value!r} and time.monotonic() < until: pass\nprint(lab.plc{expression})"
        assert self.notebook.kernel(code) == str(value)


@pytest.fixture(scope="module")
def panels(open_notebook, tmp_path_factory):
    """A running lab, its unit, devices and timers each alone."""
    from playwright.sync_api import expect

    expect.set_options(timeout=20_000)
    path = tmp_path_factory.mktemp("hand") / "panels.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source.strip()) for source in CELLS], metadata=kernel), path)
    notebook = open_notebook(path, height=1400)
    notebook.run_all()
    assert notebook.errors() == []
    return Panels(notebook, expect)


def test_a_value_is_written_and_forced_in_the_table(panels):
    panels["add"].fill("D12")
    panels["add"].press("Enter")
    row = panels["device-D12"]
    panels.expect(row).to_have_attribute("aria-selected", "true")
    row.dblclick()
    panels["plate-value"].fill("16#0FA0")
    panels.expect(panels["plate"]).to_contain_text("4000 decimal")
    panels["plate-value"].press("Enter")
    panels.expect(row.locator(".value")).to_have_text("4,000")
    panels.wait("['D12']", 4000)
    panels["grid"].press("F2")
    panels["plate-value"].fill("7")
    panels["plate-value"].press("Shift+Enter")
    panels.expect(row).to_have_attribute("data-forced", "")
    panels.wait(".forced", {"D12": 7})
    panels["grid"].press("Delete")
    panels.expect(row).not_to_have_attribute("data-forced", "")
    panels.wait(".forced", {})


def test_a_refused_value_stays_in_its_field_and_notebook_keys_stay_away(panels):
    cells = len(panels.notebook.sources())
    panels["device-D12"].dblclick()
    panels["plate-value"].fill("70000")
    panels["plate-value"].press("Enter")
    panels.expect(panels["plate"]).to_contain_text("does not fit into 16 bits")
    panels.expect(panels["plate-value"]).to_have_value("70000")
    panels["plate-value"].press("Escape")
    panels.expect(panels["plate"]).to_have_count(0)
    for key in ("a", "b", "x"):  # what JupyterLab would do to a cell
        panels["grid"].press(key)
    assert len(panels.notebook.sources()) == cells


def test_a_name_is_added_with_completion_and_follows_the_program(panels):
    panels["add"].press_sequentially("kno")
    panels.expect(panels["offers"]).to_contain_text("Knob")
    panels["add"].press("ArrowDown")
    panels["add"].press("Enter")
    panels.expect(panels["device-D5"]).to_have_attribute("aria-selected", "true")
    panels.expect(panels["device-D5"]).to_contain_text("Knob")


def test_all_registers_can_be_scrolled_to_and_keep_counting(panels):
    panels["grid"].press("End")
    panels.expect(panels["device-D7999"]).to_be_visible()
    panels["rows"].hover()
    panels.notebook.page.mouse.wheel(0, -30 * 8000)
    panels.expect(panels["device-D0"]).to_be_visible()
    panels["find"].fill("D100")
    counter = panels["device-D100"].locator(".value")
    before = counter.inner_text()
    panels.expect(counter).not_to_have_text(before)
    panels["find"].fill("")


def test_a_push_button_lights_its_output_while_it_is_held_and_starts_the_timer(panels):
    mouse = panels.notebook.page.mouse
    panels["X5"].hover()
    mouse.down()
    panels.expect(panels["lamp-Y0"]).to_have_attribute("data-on", "")
    panels.expect(panels["row-T0"]).to_have_attribute("data-state", "run")
    panels.expect(panels["T0"]).not_to_have_text("0")
    mouse.up()
    panels.expect(panels["lamp-Y0"]).not_to_have_attribute("data-on", "")
    panels.expect(panels["row-T0"]).to_have_attribute("data-state", "off")


def test_a_potentiometer_is_dragged_and_the_program_reads_it(panels):
    box = panels["pot-0"].locator(".body").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = panels.notebook.page.mouse
    mouse.move(x - 12, y)
    mouse.down()
    mouse.move(x, y - 14, steps=4)
    mouse.up()
    panels.expect(panels["pot-0"]).to_have_attribute("aria-valuenow", "128")
    panels.wait("['D5']", 128)
    panels["pot-0"].press("ArrowUp")
    panels.wait("['D5']", 129)


def test_the_mode_switch_stops_and_runs_the_plc(panels):
    panels["mode-OFF"].click()
    panels.expect(panels["lamp-RUN"]).not_to_have_attribute("data-on", "")
    panels.wait(".running", False)
    panels["mode-OFF"].press("ArrowLeft")
    panels.notebook.page.keyboard.press("ArrowLeft")
    panels.notebook.page.keyboard.press("Space")
    panels.expect(panels["mode-ON"]).to_have_attribute("aria-checked", "true")
    panels.wait(".running", True)


def test_a_point_is_forced_on_its_plate_by_keyboard(panels):
    page = panels.notebook.page
    panels["lamp-Y3"].focus()
    page.keyboard.press("Enter")
    panels.expect(panels["plate"]).to_contain_text("at the output")
    panels["force-on"].press("Enter")
    panels.expect(panels["lamp-Y3"]).to_have_attribute("data-forced", "")
    panels.wait(".forced", {"Y3": 1})
    panels["release"].press("Space")
    panels.wait(".forced", {})
    page.keyboard.press("Escape")
    panels.expect(panels["lamp-Y3"]).to_be_focused()


@pytest.mark.parametrize("width", [900, 1280, 1920])
def test_nothing_overflows(panels, width):
    page = panels.notebook.page
    page.set_viewport_size({"width": width, "height": 1400})
    for panel in page.get_by_test_id("ec").all():
        page.wait_for_function(f"(panel) => ({TOO_WIDE})(panel) === 0", arg=panel.element_handle())
