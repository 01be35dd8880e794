"""A large ladder and a large chart in a real JupyterLab: scrolled to the end, gone through by search, clicked, and alive where one looks."""

import json

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

NETWORKS = 1500
LADDER = "\\n".join(f"LD X{n % 6}\\nANI X7\\nOUT M{n}" for n in range(NETWORKS))
CHAIN = [0, *range(20, 119)]
WAYS = zip(CHAIN, [*CHAIN[1:], 0], strict=True)
CHART = "\\n".join(f"STL S{here}\\nOUT M{here}\\nLD X{here % 2}\\n{'SET' if there else 'OUT'} S{there}" for here, there in WAYS)
CELLS = [
    f"from ecsim_widgets import Lab\nlab = Lab('EC20', '{LADDER}', name='ladder')\nlab.panel('ladder')",
    f"other = Lab('EC20', 'LD SM1\\nSET S0\\n{CHART}\\nRET', name='chart')\nother.panel('chart')",
]


@pytest.fixture(scope="module")
def notebook(open_notebook, tmp_path_factory):
    place = tmp_path_factory.mktemp("large") / "large.ipynb"
    cells = [
        {"cell_type": "code", "execution_count": None, "id": f"c{n}", "metadata": {}, "outputs": [], "source": source}
        for n, source in enumerate(CELLS)
    ]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    place.write_text(json.dumps({"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}), encoding="utf-8")
    opened = open_notebook(place)
    opened.run_all()
    assert opened.errors() == []
    expect(opened.page.get_by_test_id("chart").locator(".step").first).to_be_attached(timeout=30_000)
    return opened


def test_a_large_ladder_is_scrolled_to_its_end_and_lives_there(notebook):
    page = notebook.page
    ladder = page.get_by_test_id("ladder")
    ladder.scroll_into_view_if_needed()
    ladder.locator(".ladder-scroll").evaluate("(body) => { body.scrollTop = body.scrollHeight; }")
    last = ladder.locator(f'.net[data-network="{NETWORKS - 1}"]')
    expect(last).to_be_visible(timeout=20_000)
    assert ladder.locator(".net").count() < 60
    coil = last.locator(".coil")
    expect(coil).to_have_class("coil open")
    notebook.kernel(f"lab.session.set('X{(NETWORKS - 1) % 6}', 1)")
    expect(coil).to_have_class("coil flow", timeout=20_000)
    coil.click()
    expect(ladder.locator("rect.selected")).to_have_count(1)


def test_the_search_goes_to_a_network_that_is_not_drawn(notebook):
    page = notebook.page
    page.get_by_test_id("find").fill("M700")
    expect(page.get_by_test_id("uses")).to_contain_text("network 701", timeout=20_000)
    page.keyboard.press("Enter")
    coil = page.get_by_test_id("ladder").locator('.coil[data-device="M700"]')
    expect(coil).to_be_focused(timeout=20_000)
    expect(page.get_by_test_id("where")).to_contain_text("of 1,500")
    page.keyboard.press("b")
    expect(page.get_by_test_id("ladder").locator(".break-mark")).to_have_count(1, timeout=20_000)
    assert notebook.kernel("print([point.text for point in lab.session.breakpoints])") == "['M700']"


def test_a_large_chart_finds_its_active_step(notebook):
    page = notebook.page
    chart = page.get_by_test_id("chart")
    chart.scroll_into_view_if_needed()
    expect(page.get_by_test_id("step-S0")).to_have_class("step active", timeout=20_000)
    notebook.kernel("other.session.set_step('S0', False); other.session.set_step('S90', True)")
    step = page.get_by_test_id("step-S90")
    expect(step).to_have_class("step active", timeout=20_000)
    inside = """(step) => {
      const [own, outer] = [step, step.closest('.chart-scroll')].map((node) => node.getBoundingClientRect());
      return own.height > 0 && own.top >= outer.top && own.bottom <= outer.bottom;
    }"""
    page.wait_for_function(f"() => ({inside})(document.querySelector('[data-testid=step-S90]'))", timeout=20_000)
    step.click()
    expect(chart.locator(".who")).to_contain_text("S90")
