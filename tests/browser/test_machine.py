"""Faults from the machine's panel in a real JupyterLab: a stuck sensor stops a lift, a bouncing one is counted twice."""

import nbformat
import pytest

pytestmark = pytest.mark.browser

CELLS = [
    """
from ecsim_exercises import conveyor
from ecsim_widgets import Lab
machine = conveyor.Conveyor(first=3.0)
lift = Lab("EC20", conveyor.SOLUTION, plant=machine, picture=conveyor.PICTURE, title="Pallet lift", name="lift", speed=20)
lift.panel("machine")
""",
    """
counter = Lab("EC20", "LD X0\\nEU\\nINC D0\\nLD SM0\\nOUT Y0\\nOUT Y4", plant=conveyor.Conveyor((0.5, 9.0)), picture=conveyor.PICTURE,
              title="Counter", name="counter", autostart=False)
counter.plc.run()
counter.panel("machine")
""",
]


@pytest.fixture(scope="module")
def notebook(open_notebook, tmp_path_factory):
    """Two labs, each with the panel of its machine."""
    from playwright.sync_api import expect

    expect.set_options(timeout=20_000)
    path = tmp_path_factory.mktemp("faults") / "faults.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source.strip()) for source in CELLS], metadata=kernel), path)
    notebook = open_notebook(path, height=1500)
    notebook.run_all()
    assert notebook.errors() == []
    notebook.expect = expect
    return notebook


def wait(notebook, expression):
    """Wait until the kernel finds something true."""
    loop = f"while not ({expression}) and time.monotonic() < until: time.monotonic()"
    assert notebook.kernel(f"import time\nuntil = time.monotonic() + 15\n{loop}\nprint({expression})") == "True"


def test_a_stuck_switch_stops_the_lift_until_it_is_as_it_was(notebook):
    panel = notebook.page.get_by_test_id("machine").first
    panel.get_by_test_id("sensor-X2").click()
    plate = notebook.page.get_by_test_id("sensor-plate")
    plate.get_by_test_id("stuck-0").click()
    notebook.expect(panel.get_by_test_id("sensor-X2")).to_contain_text("stuck at 0")
    notebook.kernel("lift.session.set('X5', 1); lift.session.scan(5); lift.session.set('X5', 0); lift.session.run()")
    wait(notebook, "lift.session.plant.left == 1 and lift.session.plant.right == 1")
    stands = "(lift.plc['X2'], lift.plc['Y3'], lift.session.plant.delivered, lift.session.faults)"
    notebook.kernel("lift.session.pause(); lift.session.scan(3000)")  # half a minute: the lifts are up, and nothing goes on
    assert notebook.kernel(f"print({stands})") == "(0, 0, 0, ['X2 stuck 0'])"
    notebook.expect(panel.locator("svg [id$=X2] .ailing text")).to_have_text("stuck at 0")
    plate.get_by_test_id("as-it-is").click()
    notebook.expect(panel.locator(".ailing")).to_have_count(0)
    plate.press("Escape")
    notebook.expect(plate).to_have_count(0)
    notebook.kernel("lift.session.run()")
    wait(notebook, "lift.session.plant.delivered > 0")


def test_a_bouncing_switch_is_counted_more_than_once(notebook):
    panel = notebook.page.get_by_test_id("machine").nth(1)
    panel.get_by_test_id("sensor-X0").focus()
    notebook.page.keyboard.press("Enter")
    field = notebook.page.get_by_test_id("bounces-amount")
    field.fill("300")
    field.press("Enter")
    notebook.expect(panel.get_by_test_id("sensor-X0")).to_contain_text("bounces for 300 ms")
    arrived = (
        "counter.session.scan(500); print(counter.session.plant.incidents, counter.session.plant.fronts[0] > 2.64, counter.plc['D0'] > 1)"
    )
    assert notebook.kernel(arrived) == "() True True"
    notebook.page.keyboard.press("Escape")
    panel.get_by_test_id("all-well").click()
    notebook.expect(panel.get_by_test_id("sensor-X0")).not_to_contain_text("bounces")
    assert notebook.kernel("print(counter.session.faults)") == "[]"
