"""The supervisory page in a real JupyterLab: its buttons, its slider and what it shows go over Modbus and nothing else."""

import pytest

pytestmark = pytest.mark.browser

NOTEBOOK = "19-supervisory.ipynb"


@pytest.fixture
def page(open_notebook):
    """The notebook with the page on the screen, and Playwright's expect."""
    from playwright.sync_api import expect

    notebook = open_notebook(NOTEBOOK)
    sources = notebook.sources()
    last = sources.index("page.view")
    for index in range(last + 1):
        notebook.run_cell(index)
        notebook.wait_until_idle()
    return notebook, expect


def test_buttons_and_slider_command_the_plc_and_the_page_shows_it(page):
    notebook, expect = page
    shown = {name: notebook.page.locator(f".page-{name}").first for name in ("line", "pump", "allowed", "alarm", "litres")}
    expect(shown["line"]).to_have_text("connected", timeout=20_000)
    expect(shown["allowed"]).to_have_text("○ allowed off")
    notebook.page.locator(".page-start").click()
    expect(shown["allowed"]).to_have_text("● allowed on")
    expect(shown["pump"]).to_have_text("● pump on")
    handle = notebook.page.locator(".noUi-handle, [role=slider]").first
    handle.press("Home")
    expect(shown["litres"]).to_contain_text("limit 40 l")
    assert notebook.kernel("print(plc['Limit'])") == "400"
    notebook.kernel("with session.held(): session.plant.litres = 93.0")
    expect(shown["alarm"]).to_have_text("● alarm on")
    expect(shown["pump"]).to_have_text("○ pump off")
    notebook.page.locator(".page-halt").click()
    expect(shown["allowed"]).to_have_text("○ allowed off")
    notebook.kernel("with session.held(): session.plant.litres = 20.0")
    notebook.page.locator(".page-acknowledge").click()
    expect(shown["alarm"]).to_have_text("○ alarm off")
    notebook.kernel("server.stop()")
    expect(shown["line"]).to_have_text("no answer")
    assert notebook.errors() == []
