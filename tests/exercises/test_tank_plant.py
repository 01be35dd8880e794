"""The tank's physics, from litres a second on paper, and its picture."""

import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.plant import Moment
from ecsim_exercises.tank import PICTURE, Tank

OFF, A, B, AB = ({"Y0": a, "Y1": b} for a, b in ((0, 0), (1, 0), (0, 1), (1, 1)))
STILL = ((1000.0, 0.0),)


def run(plant, *phases, length=None):
    """Let the machine go through (seconds, outputs); gives what its switches say then."""
    said = {}
    for seconds, outputs in phases:
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), outputs)
            left -= length or seconds
    return said


@pytest.mark.parametrize("length", [None, 0.1, 0.037])
@pytest.mark.parametrize(("outputs", "pumps"), [(A, 1), (B, 1), (AB, 2)])
def test_a_pump_brings_12_litres_a_second_from_when_it_is_at_its_speed(outputs, pumps, length):
    plant = Tank(100.0, STILL)
    run(plant, (10.0, outputs), length=length)
    assert plant.water == pytest.approx(100 + pumps * 12 * 9.5)  # 1 s to run up, at half the flow on the mean
    run(plant, (5.0, OFF), length=length)
    assert plant.water == pytest.approx(100 + pumps * 12 * 10)
    assert plant.pumped == pytest.approx(pumps * 120)


@pytest.mark.parametrize("length", [None, 0.1, 0.023])
def test_consumers_draw_by_their_pattern_over_and_over(length):
    plant = Tank(400.0, ((3.0, 2.0), (2.0, 10.0)))
    run(plant, (12.0, OFF), length=length)
    assert plant.water == pytest.approx(400 - 2 * (3 * 2 + 2 * 10) - 2 * 2)
    assert plant.drawn == 2.0


def test_the_switches_tell_from_their_marks_on():
    said = []
    for water in (49.9, 50.0, 149.9, 150.0, 399.9, 400.0):
        now = Tank(water, STILL).step(0.01, OFF)
        said.append((now["X1"], now["X2"], now["X3"]))
    assert said == [(0, 0, 0), (1, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 0), (1, 1, 1)]


@pytest.mark.parametrize("length", [None, 0.1, 0.041])
def test_it_runs_over_at_500_litres(length):
    plant = Tank(440.0, STILL)
    run(plant, (10.0, A), length=length)
    assert plant.water == 500
    assert plant.spilt == pytest.approx(12 * 9.5 - 60)
    ((seconds, what),) = plant.incidents
    assert (seconds, what) == (pytest.approx(0.5 + 60 / 12), "the tank runs over")


@pytest.mark.parametrize("length", [None, 0.1, 0.041])
def test_an_empty_tank_leaves_its_consumers_short(length):
    plant = Tank(20.0, ((1000.0, 4.0),))
    run(plant, (8.0, OFF), length=length)
    assert plant.water == 0
    assert plant.short == pytest.approx(3 * 4)
    assert [what for _, what in plant.incidents] == ["the tank is empty"]
    run(plant, (3.0, A), length=length)
    # it rises from the moment at which the pump brings more than 4 l/s: a third of its speed
    assert plant.water == pytest.approx((12 - 4) / 2 * (2 / 3) + 2 * 8)


@pytest.mark.parametrize("length", [None, 0.1, 0.041])
def test_it_turns_from_falling_to_rising_on_the_way(length):
    plant = Tank(0.5, ((1000.0, 6.0),))
    run(plant, (0.5, A), length=length)  # the pump brings 6 l/s after half a second: 1.5 l less until then
    assert (plant.water, [what for _, what in plant.incidents]) == (pytest.approx(0, abs=1e-9), ["the tank is empty"])
    plant = Tank(5.0, ((1000.0, 6.0),))
    run(plant, (1.0, A), length=length)
    assert plant.water == pytest.approx(5.0)
    assert plant.incidents == ()


def test_a_leak_takes_18_litres_a_second():
    plant = Tank(400.0, STILL)
    plant.fail("leak")
    run(plant, (10.0, OFF))
    assert plant.water == pytest.approx(400 - 180)
    plant.fail("leak", on=False)
    run(plant, (10.0, OFF))
    assert plant.water == pytest.approx(220)


@pytest.mark.parametrize(("fault", "outputs", "relay"), [("A trips", A, "X4"), ("B trips", B, "X5")])
def test_a_tripped_pump_stands_still_and_its_relay_is_open(fault, outputs, relay):
    plant = Tank(100.0, STILL)
    plant.fail(fault)
    assert run(plant, (5.0, outputs))[relay] == 0
    assert (plant.water, plant.turns) == (100.0, (0.0, 0.0))
    plant.fail(fault, on=False)
    assert run(plant, (5.0, outputs))[relay] == 1
    assert plant.water == pytest.approx(100 + 12 * 4.5)


@pytest.mark.parametrize(("fault", "outputs", "place"), [("A blocked", A, 0), ("B blocked", B, 1)])
def test_a_blocked_pump_turns_and_brings_nothing(fault, outputs, place):
    plant = Tank(100.0, STILL)
    plant.fail(fault)
    run(plant, (5.0, outputs))
    assert plant.water == 100
    assert plant.turns[place] == pytest.approx(4.5 / 0.6)


def test_a_float_that_hangs_does_not_tell():
    plant = Tank(450.0, STILL)
    plant.fail("float hangs")
    assert plant.step(0.1, OFF)["X3"] == 0


def test_the_way_back():
    plant = Tank()
    run(plant, (10.0, A))
    before = plant.state()
    first = run(plant, (30.0, AB), (50.0, OFF)), plant.water, plant.turns
    plant.restore(before)
    assert (run(plant, (30.0, AB), (50.0, OFF)), plant.water, plant.turns) == first


@pytest.mark.parametrize(
    ("wrong", "says"), [({"water": 501.0}, "0 to 500 l"), ({"demand": ()}, "seconds above 0"), ({"demand": ((0, 1),)}, "above 0")]
)
def test_what_makes_no_tank_is_refused(wrong, says):
    with pytest.raises(ValueError, match=says):
        Tank(**wrong)


def shown(plant, *phases, **inputs):
    said = run(plant, *phases)
    return PICTURE.state(Moment(plant, {**said, **inputs}, phases[-1][1]))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown(Tank(), (1.0, A)) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_the_picture_names_every_point():
    root = xml.fromstring(PICTURE.svg())
    tags = {tag.get("data-device"): "".join(tag.itertext()) for tag in root.iter() if tag.get("data-device")}
    assert tags == {device: device + point.name for device, point in Tank.wiring.items()}


def test_the_level_stands_between_the_floats_that_tell_of_it():
    state = shown(Tank(250.0, STILL), (1.0, OFF))
    assert state["level:transform"] == "translate(0.0 -150.0)"  # half of 300 px
    assert {key for key, value in state.items() if value.endswith(" on")} == {
        "X1:class", "X2:class", "X4:class", "X5:class", "float-X1:class", "float-X2:class",
    }  # fmt: skip


def test_what_runs_is_lit_and_turns():
    state = shown(Tank(250.0), (1.15, A))
    assert {key for key, value in state.items() if value.endswith(" on")} > {
        "Y0:class",
        "pump-A:class",
        "pipe-A:class",
        "stream-A:class",
        "pipe-out:class",
    }
    assert state["wheel-A:transform"] == "rotate(30 72 330)"  # (0.5 + 0.15) / 0.6 turns
    assert state["drawn:text"] == "3.0 l/s"


def test_what_went_wrong_is_told():
    assert shown(Tank(440.0, STILL), (10.0, A))["amiss-text:text"] == "5.5 s: the tank runs over"
