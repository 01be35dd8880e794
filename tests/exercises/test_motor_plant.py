"""The reversing drive's physics, and its picture."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.motor import PICTURE, Motor
from ecsim_exercises.plant import Moment

F, R, OFF = {"Y0": 1, "Y1": 0}, {"Y0": 0, "Y1": 1}, {"Y0": 0, "Y1": 0}


def run(plant, *phases, length=None):
    """Let the machine go through (seconds, outputs); gives what its relay says then."""
    said = {}
    for seconds, outputs in phases:
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), outputs)
            left -= length or seconds
    return said


@pytest.mark.parametrize("length", [None, 0.1, 0.007])
@pytest.mark.parametrize(("outputs", "sign"), [(F, 1), (R, -1)])
def test_it_runs_up_and_coasts_down(outputs, sign, length):
    plant = Motor()
    run(plant, (0.015 + 0.75, outputs), length=length)  # the contactor's 15 ms, then half of 1.5 s
    assert plant.speed == pytest.approx(sign * 0.5, abs=1e-6)
    run(plant, (2.0, outputs), (0.015 + 1.0, OFF), length=length)
    assert plant.speed == pytest.approx(sign * 0.75, abs=0.006)  # 4 s from full speed, the contactor still closed for 25 ms
    run(plant, (4.0, OFF), length=length)
    assert plant.speed == 0


def test_the_shaft_turns_once_in_0_8_s_at_full_speed():
    plant = Motor()
    run(plant, (3.0, F))
    before = plant.turns
    run(plant, (4.0, F), length=0.01)
    assert plant.turns - before == pytest.approx(5)


def test_against_the_other_direction_it_stops_sooner():
    plant = Motor()
    run(plant, (3.0, F), (0.1, OFF))
    speed = plant.speed
    run(plant, (0.015 + 0.35, R))
    assert plant.speed == pytest.approx(speed - 0.015 / 4 - 0.5, abs=1e-3)  # 0.7 s from full speed
    assert plant.incidents == ()


@pytest.mark.parametrize("phases", [((1.0, F), (0.01, R)), ((1.0, R), (0.01, F)), ((0.1, {"Y0": 1, "Y1": 1}),)])
def test_both_contactors_closed_are_a_short_circuit_that_ends_it(phases):
    plant = Motor()
    run(plant, *phases)
    run(plant, (0.03, {"Y0": 1, "Y1": 1}))
    assert [incident.what for incident in plant.incidents] == ["a short circuit between the phases"]
    run(plant, (10.0, F))
    assert plant.speed == 0


def test_a_change_over_that_waits_for_the_contactor_is_none():
    plant = Motor()
    run(plant, (1.0, F), (0.011, OFF), (1.0, R))
    assert plant.incidents == ()


@pytest.mark.parametrize("length", [None, 0.05])
def test_a_jammed_motor_trips_its_relay_after_5_s_and_cools_in_30(length):
    plant = Motor()
    plant.fail("jammed")
    assert run(plant, (0.015 + 4.9, F), length=length) == {"X3": 1}
    assert run(plant, (0.2, F), length=length) == {"X3": 0}
    plant.fail("jammed", on=False)
    assert run(plant, (29.8, OFF), length=length) == {"X3": 0}
    assert run(plant, (0.4, OFF), length=length) == {"X3": 1}


def test_a_welded_contactor_stays_closed():
    plant = Motor()
    run(plant, (3.0, F))
    plant.fail("F welded")
    run(plant, (5.0, OFF))
    assert plant.speed == 1


def test_the_way_back():
    plant = Motor()
    run(plant, (1.0, F))
    before = plant.state()
    first = run(plant, (1.0, OFF), (0.5, R)), plant.speed, plant.turns
    plant.restore(before)
    assert (run(plant, (1.0, OFF), (0.5, R)), plant.speed, plant.turns) == first


def shown(*phases, **inputs):
    plant = Motor()
    said = run(plant, *phases)
    return PICTURE.state(Moment(plant, {**said, **inputs}, phases[-1][1]))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown((1.0, F)) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_closed_contacts_stand_upright_and_what_runs_is_lit():
    state = shown((1.0, F), X0=1)
    forward = [float(part) for part in re.findall(r"-?[\d.]+", state["contact-forward:transform"])]
    assert forward[2] * 112 + forward[4] == pytest.approx(10, abs=0.02)  # the head of the blade moves by 10 px
    assert forward[2] * 148 + forward[4] == pytest.approx(0, abs=0.02)  # its foot stays
    assert state["contact-reverse:transform"].startswith("matrix(1 0 -0.0000 1 0.00")
    assert {key for key, value in state.items() if value.endswith(" on")} == {
        "X0:class", "X3:class", "Y0:class", "coil-forward:class", "motor:class", "go-forward:class",
    }  # fmt: skip
    assert state["speed:text"] == "forward, 66% of its speed"
