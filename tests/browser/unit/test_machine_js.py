"""The machine's panel in a bare page, on a real conveyor that stands still: plates, switches, marks, keys."""

import pytest
from ecsim_exercises import conveyor, mixer

pytestmark = pytest.mark.browser


@pytest.fixture
def machine(bench, make_lab):
    """The conveyor before its first scan."""
    bench.lab = make_lab(conveyor.SOLUTION, plant=conveyor.Conveyor(), picture=conveyor.PICTURE, title=conveyor.TITLE)
    bench.connect(bench.lab.panel("machine"))
    return bench


def press(bench, name):
    bench[name].click()
    bench.settle()


def test_a_click_on_a_sensor_opens_its_plate_and_a_fault_is_marked_everywhere(machine):
    press(machine, "sensor-X1")
    assert machine["all-well"].is_disabled()
    assert machine["sensor-plate"].get_attribute("aria-label") == "X1 InLift, sensor"
    assert machine["sensor-plate"].locator("[data-act=well]").get_attribute("aria-pressed") == "true"
    press(machine, "stuck-1")
    assert machine.lab.session.faults == ["X1 stuck 1"]
    assert (machine["says"].inner_text(), machine["comes"].inner_text()) == ("0", "1")
    assert machine["stuck-1"].get_attribute("aria-pressed") == "true"
    assert machine["sensor-X1"].get_attribute("aria-label") == "X1 InLift, stuck at 1"
    ring = machine["machine"].locator("svg [id$=X1] .ailing")
    assert ring.locator("text").text_content() == "stuck at 1"
    assert machine["machine"].locator(".sub").inner_text() == "machine, 1 fault"
    machine.page.keyboard.press("Escape")
    assert machine["sensor-plate"].count() == 0
    press(machine, "all-well")
    assert (machine.lab.session.faults, ring.count()) == ([], 0)


def test_times_are_typed_and_what_cannot_be_is_told_on_the_plate(machine):
    press(machine, "sensor-X3")
    machine["delayed-amount"].fill("1.5")
    machine["delayed-amount"].press("Enter")
    machine.settle()
    assert machine.lab.session.faults == ["X3 delayed 1.5"]
    machine["bounces-amount"].fill("soon")
    press(machine, "bounces")
    assert "bounces needs a number (ms)" in machine["sensor-plate"].locator(".refused").inner_text()
    assert machine["bounces-amount"].get_attribute("aria-invalid") == "true"
    assert machine["bounces-amount"].input_value() == "soon"
    machine["bounces-amount"].fill("20")
    press(machine, "bounces")
    assert machine["sensor-plate"].locator(".refused").is_hidden()
    assert machine.lab.session.faults == ["X3 bounces 20"]
    press(machine, "sensor-X3")
    press(machine, "sensor-X3")
    assert machine["bounces-amount"].input_value() == "20"
    press(machine, "inverted")
    assert machine["sensor-X3"].inner_text().endswith("inverted")


def test_a_tag_in_the_picture_opens_the_same_plate(machine):
    machine["machine"].locator("svg [id$=X0]").click()
    assert machine["sensor-plate"].get_attribute("aria-label") == "X0 AtEntry, sensor"
    machine["machine"].locator("h2").click()
    assert machine["sensor-plate"].count() == 0


def test_the_keyboard_goes_through_sensors_and_faults(machine):
    machine["sensor-X0"].focus()
    for _ in range(2):
        machine.page.keyboard.press("ArrowRight")
    machine.page.keyboard.press("Enter")
    assert machine["sensor-plate"].get_attribute("aria-label") == "X2 Up, sensor"
    for _ in range(2):  # from "As it is" over "Stuck 0" to "Stuck 1"
        machine.page.keyboard.press("Tab")
    machine.page.keyboard.press("Space")
    machine.settle()
    assert machine.lab.session.faults == ["X2 stuck 1"]
    machine.page.keyboard.press("Escape")
    assert machine.js("() => document.activeElement.dataset.testid") == "sensor-X2"
    machine.page.keyboard.press("ArrowDown")
    machine.page.keyboard.press("Home")
    machine.page.keyboard.press("Space")
    machine.settle()
    assert machine.lab.session.faults == ["no pallets", "X2 stuck 1"]


def test_a_fault_of_the_machine_is_a_switch_with_its_words(machine):
    switch = machine["fault-left lift stops"]
    assert (switch.get_attribute("role"), switch.get_attribute("aria-checked")) == ("switch", "false")
    assert switch.get_attribute("title") == "the left lift stays where it is"
    press(machine, "fault-left lift stops")
    assert (switch.get_attribute("aria-checked"), machine.lab.plc.running) == ("true", True)
    assert machine["machine"].locator(".marks").inner_text() == "left lift stops"
    press(machine, "fault-left lift stops")
    assert machine["machine"].locator(".marks li").count() == 0


def test_a_value_can_stick(bench, make_lab):
    bench.lab = make_lab("LD SM0\nMOV D0 D100", plant=mixer.Mixer(), picture=mixer.PICTURE)
    bench.connect(bench.lab.panel("machine"))
    press(bench, "sensor-D0")
    assert bench["inverted"].count() == 0
    bench["stuck-amount"].fill("1234")
    press(bench, "stuck")
    bench.lab.session.scan(2)
    assert bench.lab.plc["D100"] == 1234


def test_without_a_kernel_nothing_can_be_switched(machine):
    machine.tell(state={"run": machine.panel.rig.run()})
    machine.js("() => { model.gone = true; model.handlers.comm_live_update(); }")
    machine.frame()
    assert machine["sensor-X0"].get_attribute("aria-disabled") == "true"
    machine["sensor-X0"].click(force=True)
    assert machine["sensor-plate"].count() == 0
