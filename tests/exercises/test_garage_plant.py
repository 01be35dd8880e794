"""The garage door: how it moves, who is hit, and its picture."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.garage import PICTURE, Garage
from ecsim_exercises.plant import Moment

NAMES = ("up", "down", "lamp")


def outputs(names):
    return {f"Y{number}": int(name in names.split()) for number, name in enumerate(NAMES)}


def run(plant, *phases, length=None):
    """Let the door go through (seconds, outputs that are ON); gives what its switches say then."""
    said = {}
    for seconds, names in phases:
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), outputs(names))
            left -= length or seconds
    return said


def told(plant):
    return [(one.seconds, one.what) for one in plant.incidents]


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_it_takes_8_s_from_one_end_to_the_other(length):
    plant = Garage()
    assert run(plant, (0.1, ""), length=length) == {"X1": 0, "X2": 1, "X3": 1}
    assert run(plant, (2.0, "up"), length=length) == {"X1": 0, "X2": 0, "X3": 1}
    assert plant.place == pytest.approx(0.25)
    assert run(plant, (5.9, "up"), length=length)["X1"] == 0
    assert run(plant, (0.1, "up"), length=length) == {"X1": 1, "X2": 0, "X3": 1}
    assert run(plant, (7.9, "down"), length=length)["X2"] == 0
    assert run(plant, (0.1, "down"), length=length) == {"X1": 0, "X2": 1, "X3": 1}
    assert plant.incidents == ()


def test_an_end_switch_is_left_with_the_first_movement():
    plant = Garage()
    assert run(plant, (0.01, "up"))["X2"] == 0
    assert run(plant, (7.99, "up"))["X1"] == 1
    assert run(plant, (5.0, ""))["X1"] == 1
    assert run(plant, (0.01, "down"))["X1"] == 0


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_the_motor_must_not_push_against_an_end(length):
    plant = Garage()  # 0.02 of the way is what both ends give: 0.16 s
    run(plant, (0.15, "down"), (0.15, "up"), (8.15, "up"), length=length)
    assert plant.incidents == ()
    run(plant, (0.1, "up"), length=length)
    assert told(plant) == [(8.46, "the motor pushes the door against its end")]
    assert plant.place == pytest.approx(1.02)


def test_both_ways_together_are_told_and_move_nothing():
    plant = Garage()
    run(plant, (2.0, "up"), (1.0, "up down"))
    assert told(plant) == [(2.0, "the motor is driven both ways")]
    assert plant.place == pytest.approx(0.25)


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_a_car_waits_until_there_is_room_and_is_4_s_in_the_barrier(length):
    plant = Garage(cars=(3.0, 3.5))
    assert run(plant, (7.1, "up"), length=length)["X3"] == 1  # 0.9 of the way takes 7.2 s
    assert (plant.waiting, plant.through) == (2, 0)
    assert run(plant, (0.2, "up"), length=length)["X3"] == 0
    assert (plant.waiting, plant.through) == (1, 1)
    run(plant, (0.7, "up"), (3.1, ""), length=length)
    assert (plant.waiting, plant.through) == (1, 1)
    run(plant, (0.2, ""), length=length)  # the next one drives as the first has gone
    assert (plant.waiting, plant.through) == (0, 2)
    assert run(plant, (4.0, ""), length=length)["X3"] == 1


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_the_door_comes_down_on_who_stands_there(length):
    plant = Garage()
    run(plant, (8.0, "up"), length=length)
    plant.fail("child")
    assert run(plant, (2.5, "down"), length=length)["X3"] == 0
    assert plant.incidents == ()
    run(plant, (0.5, "down"), length=length)  # from 1 to 0.68 of the way: 2.56 s
    assert told(plant) == [(10.56, "the door hits what stands under it")]
    assert plant.place == pytest.approx(0.68)
    plant.fail("child", on=False)
    assert run(plant, (5.44, "down"), length=length) == {"X1": 0, "X2": 1, "X3": 1}


def test_a_jammed_door_stands():
    plant = Garage()
    run(plant, (2.0, "up"))
    plant.fail("jammed")
    run(plant, (3.0, "up"))
    assert plant.place == pytest.approx(0.25)
    plant.fail("jammed", on=False)
    run(plant, (2.0, "up"))
    assert plant.place == pytest.approx(0.5)


def test_the_way_back():
    plant = Garage(cars=(2.0, 30.0))
    run(plant, (5.0, "up"))
    before = plant.state()
    first = run(plant, (3.0, "up"), (2.0, "down")), plant.place, plant.through, plant.incidents
    plant.restore(before)
    assert plant.place == pytest.approx(0.625)
    assert (run(plant, (3.0, "up"), (2.0, "down")), plant.place, plant.through, plant.incidents) == first


@pytest.mark.parametrize("cars", [(3.0, 2.0), (-1.0,)])
def test_times_out_of_order_are_refused(cars):
    with pytest.raises(ValueError, match="cars: times from 0 s on in their order"):
        Garage(cars)


def shown(plant, *phases, **inputs):
    said = run(plant, *phases)
    return PICTURE.state(Moment(plant, {**said, **inputs}, outputs(phases[-1][1])))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    state = shown(Garage((1.0,)), (3.0, "up lamp"))
    assert [key for key in state if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_every_point_has_its_tag():
    tags = {element.get("data-device") for element in xml.fromstring(PICTURE.svg()).iter()} - {None}
    assert tags == set(Garage.wiring)


def moved(state, part):
    x, y = re.match(r"translate\(([-\d.]+)[ ,]([-\d.]+)\)", state[f"{part}:transform"]).groups()
    return float(x), float(y)


def test_the_door_rises_by_its_height():
    assert moved(shown(Garage(), (0.1, "")), "door") == (0, 0)
    assert moved(shown(Garage(), (4.0, "up")), "door") == (0, -90)
    assert moved(shown(Garage(), (8.0, "up")), "door") == (0, -180)


def test_the_car_drives_under_the_door_and_is_gone_then():
    plant = Garage(cars=(2.0,))
    assert shown(plant, (1.0, "up"))["car:class"] == "car away"
    state = shown(plant, (2.0, "up"))
    assert (state["car:class"], moved(state, "car")) == ("car", (0, 0))
    state = shown(plant, (5.0, "up"), (1.2, ""))  # 2 of its 4 s
    assert (state["car:class"], moved(state, "car")) == ("car", (210, 0))
    assert shown(plant, (2.1, ""))["car:class"] == "car away"


def test_the_beam_the_child_and_what_went_wrong_are_shown():
    def lit(state):
        return {key.rsplit(":", 1)[0] for key, value in state.items() if key.endswith(":class") and " on" in f"{value} "}

    plant = Garage()
    state = shown(plant, (8.0, "up lamp"))
    assert {"beam", "open-switch", "motor", "go-up", "Y2-lamp", "X1", "X3"} <= lit(state)
    assert lit(state) & {"child", "amiss", "closed-switch", "go-down"} == set()
    plant.fail("child")
    state = shown(plant, (3.0, "down"))
    assert {"child", "amiss", "motor", "go-down"} <= lit(state)
    assert lit(state) & {"beam", "open-switch", "go-up", "X3"} == set()
    assert state["amiss-text:text"] == "10.6 s: the door hits what stands under it"


def test_nothing_stands_outside_the_frame():
    for element in xml.fromstring(PICTURE.svg()).iter():
        for name, most in (("x", 700), ("cx", 700), ("y", 340), ("cy", 340)):
            assert 0 <= float(element.get(name, 0)) <= most
