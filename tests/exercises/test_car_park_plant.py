"""The car park's traffic, from lengths and speeds on paper, and its picture."""

import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.car_park import PICTURE, CarPark, Visit
from ecsim_exercises.plant import Moment

OPEN, FULL = {"Y0": 0, "Y1": 0}, {"Y0": 1, "Y1": 0}
TO_BARRIER = 1.0 + 5.0 / 2.0  # s of a car: the pause, and 5 m at 2 m/s
OUT = {"comes": "park", "goes": "street"}


def run(plant, seconds, outputs=OPEN, length=None):
    """Let time pass; gives what the barriers say then."""
    said, left = plant.step(0.0, outputs), seconds
    while left > 1e-9:
        said = plant.step(min(length or seconds, left), outputs)
        left -= length or seconds
    return said["X0"], said["X1"]


def edges(plant, seconds, outputs=OPEN):
    """When the barriers change: (second, X0, X1)."""
    found, last = [], (0, 0)
    for scan in range(1, round(seconds / 0.01) + 1):
        now = run(plant, 0.01, outputs)
        if now != last:
            found.append((scan / 100, *now))
        last = now
    return found


def test_a_car_that_comes_in_interrupts_the_outer_barrier_first():
    # the inner barrier is 0.4 m on, 0.2 s; a car of 4.5 m needs 2.25 s through each
    assert edges(CarPark(), 12) == [
        (pytest.approx(TO_BARRIER + 0.01), 1, 0), (pytest.approx(TO_BARRIER + 0.21), 1, 1),
        (pytest.approx(TO_BARRIER + 2.25, abs=0.011), 0, 1), (pytest.approx(TO_BARRIER + 2.45, abs=0.011), 0, 0),
    ]  # fmt: skip


def test_one_that_goes_out_interrupts_the_inner_barrier_first():
    plant = CarPark((Visit(**OUT),), inside=1)
    assert [now[1:] for now in edges(plant, 12)] == [(0, 1), (1, 1), (1, 0), (0, 0)]
    assert (plant.entered, plant.left, plant.inside) == (0, 1, 0)


def test_a_bus_takes_longer_and_is_one_vehicle():
    plant = CarPark((Visit("bus"),))
    seen = edges(plant, 20)
    assert seen[3][0] - seen[0][0] == pytest.approx(12.4 / 1.5, abs=0.02)
    assert (plant.entered, plant.inside) == (1, 1)


def test_somebody_on_foot_is_never_in_both_barriers():
    plant = CarPark((Visit("walker"),))
    assert [now[1:] for now in edges(plant, 12)] == [(1, 0), (0, 0), (0, 1), (0, 0)]
    assert (plant.entered, plant.inside) == (0, 0)


@pytest.mark.parametrize(
    ("turns", "situations"),
    [
        ((0.04,), [(1, 0), (0, 0)]),
        ((0.5,), [(1, 0), (1, 1), (1, 0), (0, 0)]),
        ((0.96,), [(1, 0), (1, 1), (0, 1), (1, 1), (1, 0), (0, 0)]),
    ],
)
def test_a_car_that_turns_back_goes_through_it_backwards(turns, situations):
    plant = CarPark((Visit(goes="street", turns=turns),))
    assert [now[1:] for now in edges(plant, 20)] == situations
    assert (plant.entered, plant.left, plant.inside) == (0, 0, 0)


def test_a_car_that_goes_on_after_all_comes_in_once():
    plant = CarPark((Visit(turns=(0.96, 0.5)),))
    assert [now[1:] for now in edges(plant, 20)] == [(1, 0), (1, 1), (0, 1), (1, 1), (0, 1), (0, 0)]
    assert plant.entered == 1


@pytest.mark.parametrize("length", [None, 0.1, 0.037])
def test_steps_of_any_length_come_to_the_same_place(length):
    plant = CarPark((Visit(turns=(0.5, 0.2)), Visit(**OUT, pause_s=0.5)))
    run(plant, 6.0, length=length)
    assert plant.place == pytest.approx(0.5 * 4.9 - 2 * (6.0 - TO_BARRIER - 0.5 * 4.9 / 2 - 1.0))  # on the way back since it stood for 1 s
    run(plant, 30.0, length=length)
    assert (plant.entered, plant.left, plant.done) == (1, 1, 2)


def test_it_counts_as_inside_when_both_barriers_are_behind_it():
    plant = CarPark()
    run(plant, TO_BARRIER + 2.44)
    assert plant.inside == 0
    run(plant, 0.02)
    assert plant.inside == 1


def test_the_sign_turns_away_who_obeys():
    plant = CarPark((Visit(), Visit(obeys=False)), inside=4)
    run(plant, 30.0, FULL)
    assert (plant.turned_away, plant.entered, plant.incidents) == (1, 1, ())


def test_without_the_sign_a_fifth_car_finds_no_place():
    plant = CarPark(inside=4)
    run(plant, 30.0)
    assert plant.incidents == ((pytest.approx(TO_BARRIER + 2.45), "a car finds no place"),)


def test_nobody_comes_out_of_an_empty_park():
    plant = CarPark((Visit(**OUT), Visit()))
    run(plant, 30.0)
    assert (plant.entered, plant.left) == (1, 0)


@pytest.mark.parametrize(("fault", "place"), [("outer knocked", 0), ("inner knocked", 1)])
def test_a_knocked_barrier_sees_buses_only(fault, place):
    plant = CarPark((Visit(), Visit("bus")))
    plant.fail(fault)
    assert run(plant, TO_BARRIER + 1.0)[place] == 0
    assert run(plant, 15.0)[place] == 1
    plant.fail(fault, on=False)
    assert plant.faults == frozenset()


def test_the_way_back():
    plant = CarPark((Visit(), Visit("bus", **OUT)), inside=1)
    run(plant, 4.0)
    before = plant.state()
    first = run(plant, 15.0), plant.place, plant.inside
    plant.restore(before)
    assert (run(plant, 15.0), plant.place, plant.inside) == first


@pytest.mark.parametrize(
    "wrong",
    [{"visits": (Visit("tram"),)}, {"visits": (Visit(turns=(0.5,)),)}, {"visits": (Visit(goes="street"),)}, {"inside": -1}],
    ids=["who", "turn too many", "turn too few", "inside"],
)
def test_what_cannot_be_is_refused(wrong):
    with pytest.raises(ValueError, match=r"needed|lead from"):
        CarPark(**wrong)


def shown(plant, seconds, outputs=OPEN):
    outer, inner = run(plant, seconds, outputs)
    return PICTURE.state(Moment(plant, {"X0": outer, "X1": inner, "X2": 0}, outputs))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown(CarPark(), 1.0) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_the_picture_names_every_terminal():
    root = xml.fromstring(PICTURE.svg())
    tags = {tag.get("data-device"): "".join(tag.itertext()) for tag in root.iter() if tag.get("data-device")}
    assert tags == {device: device + point.name for device, point in CarPark.wiring.items() if device != "D0"}


def test_a_car_is_drawn_where_it_is_and_with_its_nose_ahead():
    # a second behind the barrier: its front is 2 m past it, at 36 px a metre from 204 px
    coming = shown(CarPark(), TO_BARRIER + 1.0)
    assert coming["car:transform"] == f"translate({204 + 36 * (2 - 4.5):.1f} 150)"
    assert coming["bus:transform"] == "translate(-2000 0)"
    assert {key for key, value in coming.items() if value.endswith(" on")} == {"X0:class", "X1:class", "outer:class", "inner:class"}
    going = shown(CarPark((Visit(**OUT),), inside=1), TO_BARRIER + 1.0)  # its front comes from 4.9 m, 5 m behind that at first
    assert going["car:transform"] == f"translate({204 + 36 * (4.9 - 2):.1f} 150) scale(-1 1)"


def test_as_many_cars_are_parked_as_there_are_inside():
    state = shown(CarPark((), inside=3), 1.0, FULL)
    assert [state[f"parked-{number}:transform"] for number in range(6)] == ["translate(0 0)"] * 3 + ["translate(-2000 0)"] * 3
    assert (state["inside:text"], state["sign:class"]) == ("3", "mtag out on")
