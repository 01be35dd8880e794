"""The first notebook in Notebook 7, which the same server shows: its panels move, and what is pressed arrives in the PLC."""

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

TOO_WIDE = """() => document.querySelector('.jp-Notebook').scrollWidth - document.querySelector('.jp-Notebook').clientWidth"""


def test_the_lab_works_in_notebook_7(open_notebook):
    expect.set_options(timeout=20_000)
    notebook = open_notebook("01-first-light.ipynb", app="notebooks")
    page = notebook.page
    assert page.evaluate("() => window.jupyterapp.name") == "Jupyter Notebook"
    notebook.run_all()
    assert notebook.errors() == []
    lab = page.get_by_test_id("ec").first
    for key in ("transport", "unit", "machine", "chart", "ladder", "microscope", "trace", "timers", "devices"):
        expect(lab.get_by_test_id(key).first).to_be_visible()
    run = lab.get_by_test_id("transport")
    expect(run).to_have_attribute("data-state", "stopped")  # by the last cell
    lab.get_by_test_id("run").click()
    expect(run).to_have_attribute("data-state", "running")
    lab.get_by_test_id("X7").click()
    expect(lab.get_by_test_id("lamp-X7")).to_have_attribute("data-on", "")
    assert notebook.kernel("print(lab.plc['X7'])") == "1"
    lab.get_by_test_id("run").focus()
    page.keyboard.press("r")  # not the notebook's own key, which would make the cell raw
    expect(run).to_have_attribute("data-state", "paused")
    assert page.evaluate("() => window.jupyterapp.shell.currentWidget.content.activeCell.model.type") != "raw"
    assert page.evaluate(TOO_WIDE) <= 0
