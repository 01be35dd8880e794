"""Instruction list in a real JupyterLab: %%il cells and .il files are highlighted, completed, run, and their errors are marked."""

import nbformat
import pytest

pytestmark = pytest.mark.browser

CELLS = [
    "%load_ext ecsim_widgets",
    "%%il --lab cells --run\nLD X0   // start\nTON T0 50\nSET S20",
    "%%il --lab cells\nLD X0\nOUT X9",
    "plain = 'LD X0'",
]
KINDS = """(index) => {
  const cell = window.jupyterapp.shell.currentWidget.content.widgets[index];
  return Object.fromEntries([...cell.node.querySelectorAll('.cm-content [class*="il-"]')].map((node) => [node.textContent, node.className.replace('ec il-', '')]));
}"""
COLOUR = "(index) => getComputedStyle(window.jupyterapp.shell.currentWidget.content.widgets[index].node.querySelector('.il-number')).color"
OUTPUT = "(index) => window.jupyterapp.shell.currentWidget.content.widgets[index].node.querySelector('.jp-OutputArea')?.innerText ?? ''"


@pytest.fixture(scope="module")
def notebook(open_notebook, tmp_path_factory):
    """A notebook with cells of both languages, not yet run."""
    path = tmp_path_factory.mktemp("il") / "cells.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in CELLS], metadata=kernel), path)
    return open_notebook(path)


def wait_for_kinds(notebook, index, text):
    """The kinds of words in a cell, once a word of it has one."""
    notebook.page.wait_for_function(f"([index, text]) => text in ({KINDS})(index)", arg=[index, text])
    return notebook.page.evaluate(KINDS, index)


def test_a_cell_of_il_is_highlighted_and_one_of_python_is_not(notebook):
    kinds = wait_for_kinds(notebook, 1, "TON")
    assert kinds == {
        "%%il --lab cells --run": "keyword",
        "LD": "op",
        "X0": "device",
        "// start": "comment",
        "TON": "op",
        "T0": "device",
        "50": "number",
        "SET": "op",
        "S20": "step",
    }
    assert notebook.page.evaluate(COLOUR, 1) == "rgb(138, 59, 18)"  # --ec-il-number in the light theme
    assert notebook.page.evaluate(KINDS, 3) == {}


def test_a_cell_becomes_il_and_python_again_while_it_is_typed(notebook):
    source = "([index, text]) => window.jupyterapp.shell.currentWidget.content.widgets[index].model.sharedModel.setSource(text)"
    notebook.page.evaluate(source, [3, "%%il\nLD X0"])
    assert wait_for_kinds(notebook, 3, "LD")["X0"] == "device"
    notebook.page.evaluate(source, [3, "plain = 'LD X0'"])
    notebook.page.wait_for_function(f"() => !('LD' in ({KINDS})(3))")


def test_a_cell_runs_and_a_wrong_one_is_marked_while_the_lab_goes_on(notebook):
    for index in (0, 1):
        notebook.run_cell(index)
    notebook.wait_until_idle()
    notebook.page.get_by_test_id("ec").first.wait_for()
    assert wait_for_kinds(notebook, 1, "TON")["TON"] == "op"  # the kernel has said what it speaks; the cell stays ours
    notebook.run_cell(2)
    notebook.page.wait_for_function(f"() => ({OUTPUT})(2).includes('^^')")
    said = notebook.page.evaluate(OUTPUT, 2)
    assert "The program has an error" in said
    assert "   2  OUT X9" in said
    assert (
        notebook.kernel("from ecsim_widgets import Lab; print(Lab.named('cells').plc.program.steps > 0, Lab.named('cells').session.state)")
        == "True running"
    )


def test_the_tab_key_completes_in_a_cell(notebook):
    page = notebook.page
    cell = page.locator(".jp-Notebook-cell").nth(3)
    page.evaluate("() => window.jupyterapp.shell.currentWidget.content.widgets[3].model.sharedModel.setSource('%%il\\nLD X0\\nTON')")
    cell.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    page.keyboard.press("Tab")
    page.locator(".jp-Completer-item", has_text="TONR").first.wait_for()
    page.keyboard.press("Escape")


def test_a_file_is_highlighted(notebook, server):
    (server.folder / "motor.il").write_text("LD Start\nOUT Y0\n", encoding="utf-8")
    page = notebook.page
    notebook.command("docmanager:open", path="motor.il")
    words = page.locator(".jp-FileEditor .cm-content .il-op")
    words.first.wait_for()
    assert words.all_inner_texts() == ["LD", "OUT"]
