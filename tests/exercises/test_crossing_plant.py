"""The crossing: who goes when, and its picture."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.crossing import PICTURE, Crossing
from ecsim_exercises.plant import Moment

NAMES = ("red", "yellow", "green", "walk_red", "walk_green", "wait")
GO, STOP, WALK = "green walk_red", "red walk_red", "red walk_green"


def lamps(names):
    return {f"Y{number}": int(name in names.split()) for number, name in enumerate(NAMES)}


def run(plant, *phases, length=None):
    """Let the crossing go through (seconds, lamps that are ON); gives what the button says then."""
    said = {}
    for seconds, names in phases:
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), lamps(names))
            left -= length or seconds
    return said


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_cars_pass_at_green_and_queue_at_red(length):
    plant = Crossing(cars=(1.0, 2.0, 6.0, 7.5))
    run(plant, (3.0, GO), (5.0, STOP), length=length)
    assert (plant.passed, plant.queue) == (2, 2)
    run(plant, (0.1, GO), length=length)
    assert (plant.passed, plant.queue) == (4, 0)


@pytest.mark.parametrize(("arrives", "passed"), [(5.5, 1), (6.9, 1), (7.2, 0)])
def test_a_car_within_2_s_of_yellow_drives_on(arrives, passed):
    plant = Crossing(cars=(arrives,))
    run(plant, (5.0, GO), (3.0, "yellow walk_red"), length=0.01)
    assert plant.passed == passed


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_who_comes_presses_until_the_light_is_green_and_needs_6_s(length):
    plant = Crossing(walkers=(2.0, 3.0))
    assert run(plant, (1.9, GO), length=length) == {"X0": 0}
    assert run(plant, (0.2, GO), length=length) == {"X0": 1}
    assert run(plant, (5.0, STOP), (0.1, WALK), length=length) == {"X0": 0}
    assert len(plant.walking) == 2
    run(plant, (5.8, STOP), length=length)
    assert plant.crossed == 0
    run(plant, (0.2, STOP), length=length)
    assert (plant.crossed, plant.walking) == (2, ())


def test_a_car_in_front_of_a_walker_is_told():
    plant = Crossing(cars=(12.0,), walkers=(1.0,))
    run(plant, (10.0, WALK), (5.0, GO))
    assert plant.incidents == ()
    plant = Crossing(cars=(4.0,), walkers=(1.0,))
    run(plant, (2.0, WALK), (3.0, GO))
    assert [(one.seconds, one.what) for one in plant.incidents] == [(4.0, "a car drives while somebody is on the road")]


def test_two_greens_together_are_told_at_once():
    plant = Crossing()
    run(plant, (1.0, GO), (1.0, "green walk_green"))
    assert [(one.seconds, one.what) for one in plant.incidents] == [(1.0, "cars and walkers have green together")]


def test_after_a_minute_somebody_walks_without_green():
    plant = Crossing(walkers=(5.0,))
    run(plant, (64.9, GO), length=0.1)
    assert plant.incidents == ()
    run(plant, (0.2, GO), length=0.1)
    assert [one.what for one in plant.incidents] == ["somebody loses patience and walks without green"]


def test_the_button_s_faults():
    plant = Crossing(walkers=(1.0,))
    plant.fail("button sticks")
    assert run(plant, (0.5, GO)) == {"X0": 1}
    plant.fail("button sticks", on=False)
    plant.fail("button dead")
    assert run(plant, (2.0, GO)) == {"X0": 0}


def test_the_way_back():
    plant = Crossing(cars=(1.0, 2.5, 9.0), walkers=(2.0,))
    run(plant, (3.0, STOP))
    before = plant.state()
    first = run(plant, (2.0, WALK), (8.0, GO)), plant.passed, plant.crossed
    plant.restore(before)
    assert (run(plant, (2.0, WALK), (8.0, GO)), plant.passed, plant.crossed) == first


def test_times_out_of_order_are_refused():
    with pytest.raises(ValueError, match="walkers: times from 0 s on in their order"):
        Crossing(walkers=(3.0, 2.0))


def shown(plant, *phases, **inputs):
    said = run(plant, *phases)
    return PICTURE.state(Moment(plant, {**said, **inputs}, lamps(phases[-1][1])))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    state = shown(Crossing((1.0, 2.0), (1.0,)), (3.0, GO))
    assert [key for key in state if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_cars_wait_one_behind_the_other_and_drive_off_from_there():
    def x(state, car):
        return float(re.match(r"translate\(([-\d.]+) ", state[f"car-{car}:transform"])[1])

    plant = Crossing(cars=(1.0, 2.0))
    state = shown(plant, (3.0, STOP))
    assert (x(state, 0), x(state, 1)) == (300, 226)
    state = shown(plant, (1.0, GO))
    assert (x(state, 0), x(state, 1)) == (370, 296)


def test_a_walker_goes_over_the_road():
    plant = Crossing(walkers=(0.0,))
    assert shown(plant, (1.0, STOP))["walker-0:transform"] == "translate(420 250.0)"
    assert shown(plant, (3.0, WALK))["walker-0:transform"] == "translate(420 165.0)"  # half of the way
