"""The machine's panel in a bare page, on a real conveyor that stands still: plates, switches, marks, keys."""

import pytest
from ecsim_exercises import conveyor, mixer, operator_panel

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


@pytest.fixture
def panel(bench, make_lab):
    """An operator's panel with some of its parts."""
    plant = operator_panel.OperatorPanel(("keys", "arrows", "switches", "wheels"))
    bench.lab = make_lab("LD SM0\nOUT Y21", plant=plant, picture=operator_panel.PICTURE, title="Panel")
    bench.connect(bench.lab.panel("machine"))
    return bench


def test_a_key_in_the_picture_is_down_for_as_long_as_the_pointer_is(panel):
    plant, mouse = panel.lab.session.plant, panel.page.mouse
    panel["machine"].locator('[data-key="keys 7"]').hover()
    mouse.down()
    panel.settle()
    assert plant.pressed == {"keys 7"}
    assert panel["machine"].locator('[data-key="keys 7"]').get_attribute("class") == "key on"
    mouse.move(5, 5)
    mouse.up()
    panel.settle()
    assert plant.pressed == set()


def test_a_click_turns_a_switch_over_and_a_wheel_on(panel):
    plant = panel.lab.session.plant
    for key in ("switches 1 3", "wheels 0 2 up", "wheels 0 2 up", "wheels 0 0 down"):
        panel["machine"].locator(f'[data-key="{key}"]').click()
        panel.settle()
    assert [place for place in range(24) if plant.switches[place]] == [8 + 3]
    assert plant.numbers[0] == 209
    assert panel["machine"].locator("svg [id$=wheel02]").text_content() == "2"


def test_the_keyboard_goes_over_the_keys_and_presses_them(panel):
    plant, keyboard = panel.lab.session.plant, panel.page.keyboard
    panel["machine"].locator('[data-key="keys 1"]').focus()
    keyboard.press("ArrowRight")
    keyboard.press("ArrowDown")
    keyboard.down("Space")
    keyboard.down("Space")  # the key repeats
    panel.settle()
    assert plant.pressed == {"keys 7"}
    keyboard.press("Tab")  # the focus leaves while it is down
    keyboard.up("Space")
    panel.settle()
    assert plant.pressed == set()


def test_parts_that_the_panel_does_not_have_are_not_seen(panel):
    assert panel["machine"].locator('[data-key="keypad A"]').is_hidden()
    assert panel["machine"].locator('[data-key="wheels 1 0 up"]').is_hidden()
    assert panel["machine"].locator('[data-key="arrows up"]').is_visible()
