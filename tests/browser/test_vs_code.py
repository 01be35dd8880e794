"""Every panel in VS Code's own widget manager, with VS Code's colours and no `--jp-*` of JupyterLab's; the PLC tells what came of it."""

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

CODE = """
from ecsim_exercises import conveyor
from ecsim_widgets import Lab
lab = Lab("EC20", conveyor.SOLUTION, plant=conveyor.Conveyor(), picture=conveyor.PICTURE, devices=["D0-D9"])
lab
"""
PANELS = ("transport", "unit", "machine", "chart", "ladder", "microscope", "trace", "timers", "devices")
THEMES = {
    "vscode-light": {"editor-background": "#ffffff", "editor-foreground": "#3b3b3b"},
    "vscode-dark": {"editor-background": "#1f1f1f", "editor-foreground": "#cccccc"},
    "vscode-high-contrast": {"editor-background": "#000000", "editor-foreground": "#ffffff"},
}
DRESS = """([theme, variables]) => {
  document.body.className = theme;
  for (const [name, value] of Object.entries(variables)) document.documentElement.style.setProperty(`--vscode-${name}`, value);
}"""
GROUND = "() => getComputedStyle(document.querySelector('.ec-root')).backgroundColor"
TOO_WIDE = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def page(root, server, browser):
    """A lab with a machine in the outputs of a notebook as VS Code shows them."""
    if not (root / "build" / "vs_code" / "site").exists():
        pytest.skip("VS Code's widget manager is not there: python bench/vs_code.py")
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(60_000)
    expect.set_options(timeout=20_000)
    faults = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto(f"{server.address}/static/host.html?token={server.token}")
    page.wait_for_function("() => window.ready")
    page.evaluate(DRESS, ["vscode-dark", THEMES["vscode-dark"]])
    page.evaluate("(token) => window.begin(token)", server.token)
    page.evaluate("(code) => window.run(code)", CODE)
    assert page.evaluate("() => window.errors") == faults == []
    yield page
    assert page.evaluate("() => window.errors") == faults == []
    page.evaluate("() => window.kernel.shutdown()")
    page.close()


def kernel(page, code):
    """What the kernel prints for a piece of code."""
    return page.evaluate("(code) => window.run(code)", code)


def test_each_panel_shows_and_moves(page):
    lab = page.get_by_test_id("ec").first
    for key in PANELS:
        expect(lab.get_by_test_id(key).first).to_be_visible()
    transport = lab.get_by_test_id("transport")
    expect(transport).to_have_attribute("data-state", "running")
    scans = int(kernel(page, "print(lab.plc.scans)"))
    expect(lab.get_by_test_id("lamp-X0")).to_be_visible()
    page.wait_for_function(
        "(scans) => Number(document.querySelector('[data-testid=scans]').textContent.replace(/\\D/g, '')) > scans", arg=scans
    )


def test_what_is_clicked_typed_and_pressed_arrives(page):
    lab = page.get_by_test_id("ec").first
    lab.get_by_test_id("X7").click()
    expect(lab.get_by_test_id("lamp-X7")).to_have_attribute("data-on", "")
    assert kernel(page, "print(lab.plc['X7'])") == "1"
    lab.get_by_test_id("device-D3").dblclick()
    lab.get_by_test_id("plate-value").fill("16#0FA0")
    lab.get_by_test_id("plate-value").press("Shift+Enter")
    expect(lab.get_by_test_id("device-D3")).to_have_attribute("data-forced", "")
    assert kernel(page, "print(lab.plc.forced)") == "{'D3': 4000}"
    lab.get_by_test_id("run").focus()
    page.keyboard.press("r")
    expect(lab.get_by_test_id("transport")).to_have_attribute("data-state", "paused")
    before = int(kernel(page, "print(lab.plc.scans)"))
    page.keyboard.press("Space")
    expect(lab.get_by_test_id("scans")).to_contain_text(str(before + 1)[-2:])
    assert int(kernel(page, "print(lab.plc.scans)")) == before + 1


def test_the_editor_downloads_into_the_running_plc(page):
    kernel(page, "lab.panel('editor')")
    area = page.get_by_test_id("text")
    area.click()
    area.evaluate("(area) => area.setSelectionRange(...Array(2).fill(area.value.lastIndexOf('END_PROGRAM')))")
    page.keyboard.type("LD X7\nOUT Y13\n")
    page.keyboard.press("Control+Enter")
    expect(page.get_by_test_id("verdict")).to_contain_text("2 new instructions, 0 gone.")
    assert kernel(page, "print(lab.plc.program.instructions[-1])").startswith("OUT Y13")


@pytest.mark.parametrize("theme", THEMES)
def test_panels_lie_on_a_ground_of_the_theme_and_fit(page, theme):
    page.evaluate(DRESS, [theme, THEMES[theme]])
    red, green, blue = (int(number) for number in page.evaluate(GROUND).split("(")[1].rstrip(")").split(",")[:3])
    assert (red + green + blue < 200) == (theme != "vscode-light")
    for width in (900, 1280, 1920):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(TOO_WIDE) <= 0
