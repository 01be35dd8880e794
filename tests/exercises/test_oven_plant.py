"""The oven: its heat balance against a plain integration, what its faults do, and its picture."""

import re
import xml.etree.ElementTree as xml
from math import exp

import pytest
from ecsim_exercises.oven import PICTURE, Oven
from ecsim_exercises.plant import Moment

from ecsim import EcsimError, Plc
from ecsim.session import Session

OFF, ON, RELAY, CONTACTOR = {"Y0": 0, "Y1": 0}, {"Y0": 1, "Y1": 1}, {"Y0": 1, "Y1": 0}, {"Y0": 0, "Y1": 1}


def run(oven, seconds, outputs, length=0.1):
    """Let it go on in steps of a length; returns what its sensors say."""
    said = oven.step(0.0, outputs)
    for _ in range(round(seconds / length)):
        said = oven.step(length, outputs)
    return said


def integrated(start, seconds, power, loss, room=20.0):
    """Element (360 J/K, 30 W/K to the chamber), chamber (3000 J/K) and sensor (6 s) by many small steps of the midpoint rule."""

    def slopes(element, chamber, sensor):
        given = 30 * (element - chamber)
        return (power - given) / 360, (given - loss * (chamber - room)) / 3000, (chamber - sensor) / 6

    state, steps = start, round(seconds / 0.02)
    for _ in range(steps):
        half = [value + 0.01 * slope for value, slope in zip(state, slopes(*state), strict=True)]
        state = [value + 0.02 * slope for value, slope in zip(state, slopes(*half), strict=True)]
    return state


def temperatures(oven):
    return [oven.element, oven.chamber, oven.sensor]


@pytest.mark.parametrize(
    ("fault", "outputs", "power", "loss"),
    [(None, ON, 3000, 10), (None, OFF, 0, 10), ("door open", ON, 3000, 40), ("door open", OFF, 0, 40)],
)
def test_it_keeps_to_its_heat_balance(fault, outputs, power, loss):
    oven = Oven(warm=150.0)
    run(oven, 20, ON)
    before = temperatures(oven)
    assert before == pytest.approx(integrated([150.0] * 3, 20, 3000, 10), abs=1e-3)
    if fault:
        oven.fail(fault)
    run(oven, 60, outputs)
    assert temperatures(oven) == pytest.approx(integrated(before, 60, power, loss), abs=1e-3)


def test_it_ends_where_the_losses_take_all_power():
    oven = Oven(room=10.0)
    run(oven, 20_000, ON, 10)
    assert temperatures(oven) == pytest.approx([410, 310, 310])  # 3000 W / 10 W/K over the room, the element 3000 / 30 K above it
    oven.fail("door open")
    run(oven, 20_000, ON, 10)
    assert temperatures(oven) == pytest.approx([185, 85, 85])


def test_no_heat_gets_lost():
    """What was given is in element and chamber, but for what went out through the walls: 10 W/K over the mean temperature."""
    oven, went_out = Oven(), 0.0
    for _ in range(1200):
        before = oven.chamber
        oven.step(0.1, ON)
        went_out += 10 * ((before + oven.chamber) / 2 - 20) * 0.1
    stored = 360 * (oven.element - 20) + 3000 * (oven.chamber - 20)
    assert stored + went_out == pytest.approx(3000 * 120, rel=1e-5)


@pytest.mark.parametrize("length", [0.01, 0.05, 0.37, 1.85])
def test_the_length_of_a_step_does_not_matter(length):
    whole, parts = Oven(warm=80.0), Oven(warm=80.0)
    for outputs in (ON, OFF, ON):
        run(whole, 18.5, outputs, 18.5)
        run(parts, 18.5, outputs, length)
    assert temperatures(parts) == pytest.approx(temperatures(whole), abs=1e-8)


def test_the_sensor_comes_behind():
    oven = Oven(warm=100.0, room=100.0)
    oven.chamber = oven.element = 130.0
    oven.step(6.0, OFF)
    gone = (oven.sensor - 100) / (oven.chamber - 100)
    assert gone == pytest.approx(1 - exp(-1), abs=0.02)  # the chamber loses 2 % in the meantime
    assert oven.inputs["D0"] == round(10 * oven.sensor)


@pytest.mark.parametrize(("outputs", "heats"), [(OFF, False), (RELAY, False), (CONTACTOR, False), (ON, True)])
def test_relay_and_contactor_have_to_be_closed_both(outputs, heats):
    oven = Oven()
    run(oven, 10, outputs)
    assert oven.heating is heats
    assert (oven.element > 21) is heats


def test_a_welded_relay_heats_until_the_contactor_opens():
    oven = Oven()
    oven.fail("relay welded")
    assert run(oven, 1, OFF)["D0"] == 200
    run(oven, 60, CONTACTOR)
    assert oven.heating
    run(oven, 1, RELAY)
    assert not oven.heating
    oven.fail("relay welded", on=False)
    run(oven, 1, CONTACTOR)
    assert not oven.heating


def test_a_broken_element_and_a_broken_sensor():
    oven = Oven()
    oven.fail("element broken")
    assert run(oven, 30, ON) == {"X1": 1, "D0": 200}
    oven.fail("sensor broken")
    assert run(oven, 1, ON) == {"X1": 1, "D0": 32767}
    for fault in ("element broken", "sensor broken"):
        oven.fail(fault, on=False)
    assert run(oven, 30, ON)["D0"] > 210


def test_the_door_has_a_switch():
    oven = Oven()
    oven.fail("door open")
    assert run(oven, 0.1, OFF)["X1"] == 0
    oven.fail("door open", on=False)
    assert run(oven, 0.1, OFF)["X1"] == 1


def test_what_burns_is_told_once():
    oven = Oven(warm=250.0)
    run(oven, 30, ON)
    assert oven.incidents == ()
    run(oven, 200, ON)
    assert [one.what for one in oven.incidents] == ["what is in the oven burns"]
    told = oven.incidents[0].seconds
    assert integrated([250.0] * 3, told - 0.1, 3000, 10)[1] < 265 <= integrated([250.0] * 3, told, 3000, 10)[1]


def test_a_fault_that_it_does_not_have_is_refused():
    with pytest.raises(EcsimError, match="no fault 'cake'; it has door open, relay welded"):
        Oven().fail("cake")


def test_the_way_back():
    oven = Oven(warm=120.0)
    run(oven, 12, ON)
    before = oven.state()
    oven.fail("door open")
    run(oven, 20, OFF)
    after = temperatures(oven)
    oven.restore(before)
    assert oven.faults == frozenset()
    oven.fail("door open")
    run(oven, 20, OFF)
    assert temperatures(oven) == after


def test_in_a_session_the_registers_are_the_transmitter_and_the_screen():
    plc = Plc("EC20", scan_ms=100)
    plc.load("LD X0\nOUT Y1\nAND< D0 D2\nOUT Y0")
    plc.run()
    session = Session(plc, Oven(), name="oven")
    plc["D2"], plc["X0"] = 500, 1
    session.scan(10)
    assert (plc["D0"], plc["Y0"], plc["X1"]) == (200, 1, 1)
    session.scan(900)
    assert plc["D0"] > 500
    assert plc["Y0"] == 0


def shown(oven, seconds=0.1, outputs=OFF, **inputs):
    driven = {"Y2": 0, "Y3": 0, **outputs}
    return PICTURE.state(Moment(oven, {"X0": 0, "X2": 0, **oven.step(seconds, driven), **inputs}, driven))


def lit(state):
    return {key.rsplit(":", 1)[0] for key, value in state.items() if key.endswith(":class") and value.split()[-1:] == ["on"]}


def turned(state, part):
    return float(re.match(r"rotate\(([-\d.]+) ", state[f"{part}:transform"])[1])


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown(Oven()) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_every_point_has_its_tag():
    tags = {element.get("data-device") for element in xml.fromstring(PICTURE.svg()).iter()} - {None}
    assert tags == set(Oven.wiring)


def test_the_thermometer_shows_the_chamber_and_the_number_the_sensor():
    state = shown(Oven(warm=160.0, room=160.0))
    assert state["heat:transform"] == "translate(0.0 -96.0)"  # half of 320 degrees, half of 192 px
    assert state["reading:text"] == "160.0"
    oven = Oven(warm=160.0)
    oven.fail("sensor broken")
    assert shown(oven)["reading:text"] == "---"


def test_contacts_close_and_the_element_is_lit():
    state = shown(Oven(), outputs=ON)
    assert (turned(state, "contact-Y0"), turned(state, "contact-Y1")) == (24, 24)
    assert {"element", "rises", "Y0", "Y1", "door-switch", "X1"} <= lit(state)
    state = shown(Oven(), outputs=CONTACTOR)
    assert (turned(state, "contact-Y0"), turned(state, "contact-Y1")) == (0, 24)
    assert lit(state) & {"element", "rises", "Y0"} == set()


def test_a_welded_contact_and_an_open_door_are_seen():
    oven = Oven()
    oven.fail("relay welded")
    oven.fail("door open")
    state = shown(oven, outputs=OFF)
    assert (turned(state, "contact-Y0"), turned(state, "contact-Y1"), turned(state, "door")) == (24, 0, 90)
    assert lit(state) & {"door-switch", "X1", "element"} == set()


def test_what_went_wrong_is_told():
    state = shown(Oven(warm=266.0), seconds=0.5)
    assert "amiss" in lit(state)
    assert state["amiss-text:text"] == "0.0 s: what is in the oven burns"


def test_nothing_stands_outside_the_frame():
    for element in xml.fromstring(PICTURE.svg()).iter():
        for name, most in (("x", 680), ("cx", 680), ("cy", 400)):
            assert 0 <= float(element.get(name, 0)) <= most
        if element.get("class") != "liquid":  # it stands below its tube and is cut off there
            assert 0 <= float(element.get("y", 0)) + float(element.get("height", 0)) <= 400
    assert 352 + (262 - 56) < 680  # the door, fallen to the right
