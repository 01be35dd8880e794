"""The unit's face in a bare page, on a real PLC that stands still."""

import pytest
from ecsim_widgets import Lab

from ecsim.plc import Plc

pytestmark = pytest.mark.browser

PROGRAM = """
VAR_GLOBAL
  Start AT X5 // start button
END_VAR
PROGRAM MAIN
LD Start
OUT Y0
LD SM0
VRRD 1 D5
END_PROGRAM
"""


class Shuttle:
    """A plant that drives X0."""

    wiring = {"X0": type("Point", (), {"name": "There", "what": "the part is there"})}

    def step(self, seconds, outputs):
        return {"X0": 0}


@pytest.fixture
def unit(bench, make_lab):
    """The unit of a lab with one control of each kind."""
    bench.lab = make_lab(PROGRAM, plant=Shuttle(), controls={"X5": "push", "X6": "stop", "X7": "latch"})
    bench.connect(bench.lab.panel("unit"))
    return bench


def scan(bench, count=1):
    bench.lab.session.scan(count)
    bench.settle()


@pytest.mark.parametrize("device", ["X1", "X6", "X7"])
def test_a_switch_a_stop_and_a_latching_button_stay(unit, device):
    for level in (1, 0):
        unit[device].click()
        unit.settle()
        assert unit[device].get_attribute("aria-checked") == ("true" if level else "false")
        assert unit[f"lamp-{device}"].get_attribute("data-on") != ("" if level else None)  # the program has not looked
        scan(unit)
        assert unit[f"lamp-{device}"].get_attribute("data-on") == ("" if level else None)


def test_a_push_button_is_on_while_it_is_held_by_mouse(unit):
    unit["X5"].hover()
    unit.page.mouse.down()
    unit.settle()
    scan(unit)
    assert (unit["X5"].get_attribute("aria-pressed"), unit["lamp-Y0"].get_attribute("data-on")) == ("true", "")
    unit.page.mouse.up()
    unit.settle()
    scan(unit)
    assert (unit["X5"].get_attribute("aria-pressed"), unit["lamp-Y0"].get_attribute("data-on")) == ("false", None)


@pytest.mark.parametrize("key", ["Space", "Enter"])
def test_a_push_button_is_on_while_it_is_held_by_key(unit, key):
    unit["X5"].focus()
    unit.page.keyboard.down(key)
    unit.settle()
    scan(unit)
    assert unit.lab.plc["Y0"] == 1
    unit.page.keyboard.up(key)
    unit.settle()
    scan(unit)
    assert unit.lab.plc["Y0"] == 0


def test_a_push_button_is_on_while_it_is_held_by_touch(unit):
    touch = "([type]) => { const button = document.querySelector('[data-testid=X5]'); button.setPointerCapture = () => {}; button.dispatchEvent(new PointerEvent(type, { pointerId: 7, pointerType: 'touch', bubbles: true })); }"
    unit.js(touch, ["pointerdown"])
    unit.settle()
    scan(unit)
    assert unit.lab.plc["Y0"] == 1
    unit.js(touch, ["pointercancel"])
    unit.settle()
    scan(unit)
    assert unit.lab.plc["Y0"] == 0


def test_an_input_of_the_machine_is_taken_over_and_given_back(unit):
    assert unit["X0"].get_attribute("data-kind") == "machine"
    unit["X0"].click()
    unit.settle()
    scan(unit)
    assert (unit["X0"].get_attribute("data-kind"), unit.lab.plc["X0"]) == ("stuck", 1)
    unit["X0"].click()
    unit.settle()
    scan(unit)
    assert (unit["X0"].get_attribute("data-kind"), unit.lab.plc["X0"]) == ("machine", 0)


def test_arrows_go_from_control_to_control_and_down_to_the_lamp(unit):
    unit["X1"].focus()
    for key, name in (("ArrowRight", "X2"), ("ArrowLeft", "X1"), ("ArrowDown", "lamp-X1"), ("ArrowDown", "lamp-Y1"), ("Home", "lamp-Y0")):
        unit.page.keyboard.press(key)
        assert unit.js("() => document.activeElement.dataset.testid") == name


def test_the_plate_of_a_point_shows_its_way_and_forces_it(unit):
    unit["lamp-X5"].focus()
    unit.page.keyboard.press("Enter")
    unit.settle()
    assert unit["plate"].inner_text().split("\n")[0].split() == ["X5", "Start", "start", "button"]
    assert unit["release"].is_disabled()
    unit["force-on"].click()
    unit.settle()
    scan(unit)
    rows = unit["plate"].locator(".rowline").inner_text().split()
    assert rows == "at the terminal 0 after the filter 0 seen by the program F 1".split()
    assert unit["lamp-X5"].get_attribute("data-forced") == ""
    assert unit["lamp-X5"].get_attribute("aria-label") == "X5 Start on, forced"
    assert unit.lab.plc["Y0"] == 1
    unit["release"].click()
    unit.settle()
    scan(unit)
    assert unit.lab.plc.forced == {}
    unit.page.keyboard.press("Escape")
    unit.settle()
    assert unit["plate"].count() == 0


def test_another_point_takes_the_plate_over(unit):
    for name, device in (("lamp-X5", "X5"), ("lamp-X12", "X12")):
        unit[name].click()
        unit.settle()
        assert unit["plate"].get_attribute("aria-label").split()[0] == device
        assert unit.page.locator(".point[data-selected]").get_attribute("data-point") == device
    unit["lamp-X12"].click()
    unit.settle()
    assert unit["plate"].count() == 0
    assert unit.page.locator(".point[data-selected]").count() == 0


def test_the_mode_switch_has_three_positions(unit):
    for position, run in (("OFF", None), ("ON", ""), ("TM", "")):
        unit[f"mode-{position}"].click()
        unit.settle()
        assert unit[f"mode-{position}"].get_attribute("aria-checked") == "true"
        assert unit.lab.plc.switch == position
        assert unit["lamp-RUN"].get_attribute("data-on") == run


def test_lamps_shine_flash_and_say_so(unit):
    assert unit["lamp-ERR"].get_attribute("aria-label") == "ERR lamp off"
    unit.lab.plc.battery = "failing"
    scan(unit)
    assert (unit["lamp-BAT"].get_attribute("data-on"), unit["lamp-BAT"].get_attribute("aria-label")) == ("fault", "BAT lamp on")
    flashing = dict(unit.js("() => model.get('last').unit"), ERR="flashing")
    unit.tell(n=999, state={"unit": {"ERR": flashing["ERR"]}})
    assert (unit["lamp-ERR"].get_attribute("data-flashing"), unit["lamp-ERR"].get_attribute("aria-label")) == ("", "ERR lamp flashing")
    assert unit.js("() => getComputedStyle(document.querySelector('[data-testid=lamp-ERR] circle')).animationDuration") == "1s"


def test_a_potentiometer_is_turned_by_keys_and_the_program_reads_it(unit):
    unit["pot-1"].focus()
    for key, value in (("PageUp", 16), ("ArrowUp", 17), ("ArrowLeft", 16), ("End", 255), ("ArrowRight", 255), ("Home", 0), ("PageUp", 16)):
        unit.page.keyboard.press(key)
        unit.settle()
        assert unit["pot-1"].get_attribute("aria-valuenow") == str(value)
    scan(unit)
    assert unit.lab.plc["D5"] == 16


def test_a_potentiometer_follows_the_pointer(unit):
    box = unit["pot-0"].locator(".body").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    unit.page.mouse.move(x, y - 12)
    unit.page.mouse.down()
    unit.settle()
    assert abs(unit.lab.plc.pots[0] - 128) <= 2  # straight up is the middle
    unit.page.mouse.move(x + 40, y)
    unit.page.mouse.up()
    unit.settle()
    assert abs(unit.lab.plc.pots[0] - 255 * (90 + 135) / 270) <= 2


@pytest.mark.parametrize(("width", "columns"), [(1280, 16), (900, 16), (620, 8)])
def test_nothing_of_the_unit_is_cut_off(unit, width, columns):
    unit.page.set_viewport_size({"width": width, "height": 900})
    unit.frame()
    unit.frame()
    assert unit.js("() => document.querySelector('.unit').style.getPropertyValue('--ec-columns')") == str(columns)
    outside = """() => [...document.querySelectorAll('.unit :is(.control, .lampcell, .knobcell, .addr)')].filter((node) => {
      const [box, unit] = [node.getBoundingClientRect(), document.querySelector('.unit').getBoundingClientRect()];
      return box.left < unit.left || box.right > unit.right || box.bottom > unit.bottom;
    }).length"""
    assert unit.js(outside) == 0


def test_without_a_kernel_nothing_can_be_switched(unit):
    unit["lamp-X5"].click()
    unit.settle()
    unit.js("() => { model.gone = true; model.handlers['comm_live_update'](); }")
    unit.frame()
    assert unit["plate"].count() == 0
    assert unit["X1"].get_attribute("aria-disabled") == "true"


# -- analog terminals ----------------------------------------------------------------------------------------------


class Tank:
    """A plant that tells a level in volts."""

    wiring = {"AI0.2:V": type("Point", (), {"name": "Level", "what": "level of the tank"})}

    def step(self, seconds, outputs):
        return {"AI0.2:V": 3.25}


@pytest.fixture
def analog(bench):
    """The unit of an EC20 with a 4AD and a 4DA that gives 2.5 V on its first output."""
    plc = Plc("EC20", scan_ms=10, io=[(24, 16), "4AD", "4DA"])
    bench.lab = Lab(plc, "LD SM0\nMOV 2500 D0\nTO 1 0 D0 1", plant=Tank(), name="analog", autostart=False, devices=["AI0.0:V", "AI0.0:mA"])
    plc.run()
    bench.connect(bench.lab.panel("unit"))
    yield bench
    bench.lab.close()


def test_a_typed_signal_is_put_on_the_terminal(analog):
    field = analog["signal-AI0.0"]
    field.fill("-4.5")
    field.press("Enter")
    scan(analog)
    assert analog.lab.plc["AI0.0:V"] == -4.5
    assert (field.input_value(), analog["slider-AI0.0"].input_value()) == ("-4.5", "-4.5")
    field.fill("")
    analog["signal-AI0.1"].focus()  # leaving the field is enough
    scan(analog)
    assert analog.lab.plc["AI0.0:V"] is None
    assert field.get_attribute("placeholder") == "none"


def test_what_is_no_signal_is_refused_in_words_and_stays_in_the_field(analog):
    field = analog["signal-AI0.0"]
    field.fill("much")
    field.press("Enter")
    scan(analog)
    scan(analog)
    assert (field.input_value(), field.get_attribute("aria-invalid")) == ("much", "true")
    assert "'much' is no number" in analog["unit"].locator('[data-signal="AI0.0"] [role=alert]').inner_text()
    field.press("Escape")
    assert (field.input_value(), field.get_attribute("aria-invalid")) == ("", None)


def test_a_slider_moves_by_keys_within_the_range_of_the_mode(analog):
    slider = analog["slider-AI0.0"]
    assert (slider.get_attribute("min"), slider.get_attribute("max")) == ("-10", "10")
    slider.focus()
    for key in ("Home", "ArrowRight", "ArrowRight"):
        analog.page.keyboard.press(key)
        scan(analog)
    assert analog.lab.plc["AI0.0:V"] == -9.98  # a hundredth of a volt for each key
    assert slider.get_attribute("aria-valuetext") == "-9.98 V"


def test_an_output_shows_what_it_gives_with_its_unit(analog):
    scan(analog, 2)
    assert analog["signal-AO1.0"].inner_text() == "2.500"
    assert analog["unit"].locator('[data-signal="AO1.0"] .kind').inner_text() == "V"


def test_a_signal_of_the_machine_is_taken_over_and_freed(analog):
    scan(analog, 2)
    field = analog["signal-AI0.2"]
    assert field.input_value() == "3.25"
    field.fill("7.5")
    field.press("Enter")
    scan(analog, 2)
    assert (field.input_value(), analog.lab.plc["AI0.2:V"]) == ("7.5", 7.5)
    analog["free-AI0.2"].click()
    scan(analog, 2)
    assert field.input_value() == "3.25"
    assert analog["free-AI0.2"].is_hidden()


def test_without_a_kernel_the_signals_rest(analog):
    analog.js("() => { model.gone = true; model.handlers['comm_live_update'](); }")
    analog.frame()
    assert analog["signal-AI0.0"].is_disabled()
    assert analog["slider-AI0.0"].is_disabled()


def test_the_device_table_takes_terminals_by_typing_and_writes_them(analog):
    analog.connect(analog.lab.panel("devices"))
    analog["add"].press_sequentially("ai0.3")
    analog.settle()
    assert analog["offers"].locator("li").all_inner_texts()[0].split("\n")[0] == "AI0.3:V"
    analog.page.keyboard.press("ArrowDown")
    analog.page.keyboard.press("Enter")
    analog.settle()
    row = analog["device-AI0.3:V"]
    assert row.locator(".value").inner_text() == "none"
    assert analog["device-AI0.0:mA"].locator("select").input_value() == "mA"
    row.dblclick()
    analog.settle()
    analog["plate-value"].fill("1.25")
    analog["plate-value"].press("Enter")
    scan(analog)
    assert (analog.lab.plc["AI0.3:V"], row.locator(".value").inner_text()) == (1.25, "1.25")
