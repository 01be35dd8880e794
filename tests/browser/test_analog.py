"""The analog terminals of a unit in a real JupyterLab: typed and drawn with the mouse; the program reads what was put on, and drives an output."""

import nbformat
import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

CELL = """
from ecsim import Plc
from ecsim_widgets import Lab
plc = Plc("EC20", scan_ms=10, io=[(24, 16), "4AD", "4DA"])
lab = Lab(plc, '''LD SM0
FROM 0 0 D0 1
MOV 2500 D10
TO 1 0 D10 1''')
plc.run()
lab.panel("unit")
"""


@pytest.fixture(scope="module")
def notebook(open_notebook, tmp_path_factory):
    """A running unit with four analog inputs and four outputs."""
    expect.set_options(timeout=20_000)
    path = tmp_path_factory.mktemp("analog") / "analog.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL.strip())], metadata=kernel), path)
    notebook = open_notebook(path)
    notebook.run_all()
    assert notebook.errors() == []
    return notebook


def says(notebook, expression, value):
    """Wait until the kernel says so."""
    code = f"import time\nuntil = time.monotonic() + 10\nwhile {expression} != {value!r} and time.monotonic() < until: pass\nprint({expression})"
    assert notebook.kernel(code) == str(value)


def test_a_typed_voltage_is_read_by_the_program(notebook):
    """5 V of 10 V is half of 10,000 (docs/modules.md, mode 0)."""
    field = notebook.page.get_by_test_id("signal-AI0.0")
    field.fill("5")
    field.press("Enter")
    says(notebook, "plc['AI0.0:V']", 5.0)
    says(notebook, "plc['D0']", 5000)
    field.fill("much")
    field.press("Enter")
    expect(field).to_have_attribute("aria-invalid", "true")
    field.press("Escape")
    expect(field).to_have_value("5")
    assert notebook.kernel("print(plc['D0'])") == "5000"


def test_a_slider_is_drawn_with_the_mouse(notebook):
    slider = notebook.page.get_by_test_id("slider-AI0.0")
    box = slider.bounding_box()
    mouse = notebook.page.mouse
    mouse.move(box["x"] + box["width"] * 3 / 4, box["y"] + box["height"] / 2)
    mouse.down()
    mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, steps=4)
    mouse.up()
    expect(notebook.page.get_by_test_id("signal-AI0.0")).to_have_value(slider.input_value())
    volts = float(slider.input_value())
    assert abs(volts) < 0.5  # the middle of -10 to 10 V
    says(notebook, "plc['AI0.0:V']", volts)
    says(notebook, "plc['D0']", round(volts * 1000))


def test_an_output_shows_what_the_program_gives(notebook):
    """2,500 of 10,000 is a quarter of 10 V."""
    expect(notebook.page.get_by_test_id("signal-AO1.0")).to_have_text("2.500")
