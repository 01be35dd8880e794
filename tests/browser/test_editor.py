"""Editor and ladder in a real JupyterLab: typed, downloaded in RUN while it runs, redrawn, forced, and undone."""

import nbformat
import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

CELL = "from ecsim_widgets import Lab\nlab = Lab('EC20', 'LD X0\\nOUT Y0\\nLD SM0\\nINC D0\\n')\nlab.panel('ladder')"


@pytest.fixture(scope="module")
def notebook(open_notebook, tmp_path_factory):
    """A lab that runs, with its ladder and its editor."""
    path = tmp_path_factory.mktemp("editor") / "editor.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    cells = [nbformat.v4.new_code_cell(source) for source in (CELL, "lab.panel('editor')")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=kernel), path)
    notebook = open_notebook(path)
    notebook.run_all()
    assert notebook.errors() == []
    return notebook


def test_a_change_goes_to_the_running_plc_and_the_ladder_is_drawn_anew(notebook):
    page = notebook.page
    area = page.get_by_test_id("text")
    area.click()
    page.keyboard.press("Control+End")
    page.keyboard.type("LD X1\nOUT Y1")
    counted = int(notebook.kernel("print(lab.plc['D0'])"))
    page.keyboard.press("Control+Enter")
    expect(page.get_by_test_id("verdict")).to_contain_text("Changed in RUN: 2 new instructions, 0 gone.", timeout=20_000)
    expect(page.get_by_test_id("ladder").locator('.coil[data-device="Y1"]')).to_have_count(1, timeout=20_000)
    assert int(notebook.kernel("print(lab.plc['D0'])")) >= counted  # it went on counting
    expect(area).to_be_focused()
    assert notebook.kernel("print(len(lab.plc.program.instructions))") == "6"


def test_a_refused_change_says_so_and_undo_brings_the_text_back(notebook):
    page = notebook.page
    area = page.get_by_test_id("text")
    before = area.input_value()
    area.click()
    page.keyboard.press("Control+End")
    page.keyboard.type("\nOUT X9")
    expect(page.get_by_test_id("problems").locator("li")).to_have_count(1, timeout=20_000)
    page.keyboard.press("Control+Enter")
    expect(page.get_by_test_id("verdict")).to_contain_text("Not downloaded: 1 problem.", timeout=20_000)
    assert area.input_value() == before + "\nOUT X9"
    for _ in range(8):
        page.keyboard.press("Control+z")
        if area.input_value() == before:
            break
    assert area.input_value() == before
    assert notebook.kernel("print(lab.session.state, lab.plc.running)") == "running True"


def test_a_double_click_in_the_ladder_forces(notebook):
    page = notebook.page
    page.get_by_test_id("ladder").locator('[data-device="X1"]').dblclick()
    page.get_by_test_id("force-on").click()
    expect(page.get_by_test_id("ladder").locator('.coil[data-device="Y1"]')).to_have_class("coil flow", timeout=20_000)
    assert notebook.kernel("print(lab.plc.forced)") == "{'X1': 1}"
    notebook.kernel("lab.stop()")
