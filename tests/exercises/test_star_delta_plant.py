"""The star-delta drive's physics, and its picture."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.plant import Moment
from ecsim_exercises.star_delta import PICTURE, StarDelta


def outputs(names):
    return {device: int(name in names.split()) for device, name in (("Y0", "line"), ("Y1", "star"), ("Y2", "delta"))}


def run(plant, *phases, length=None):
    """Let the machine go through (seconds, contactors that are ON); gives what its relay says then."""
    said = {}
    for seconds, names in phases:
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), outputs(names))
            left -= length or seconds
    return said


@pytest.mark.parametrize("length", [None, 0.1, 0.007])
def test_in_star_it_comes_to_85_percent_and_in_delta_to_full_speed(length):
    plant = StarDelta()
    run(plant, (0.015 + 2.0, "line star"), length=length)
    assert plant.speed == pytest.approx(0.5, abs=1e-6)  # 4 s for the full speed
    run(plant, (5.0, "line star"), length=length)
    assert plant.speed == pytest.approx(0.85, abs=1e-6)
    run(plant, (0.1, "line"), (0.015 + 0.2, "line delta"), length=length)
    assert plant.speed == pytest.approx(0.85 - 0.1 / 10 + 0.2 / 2, abs=0.01)
    run(plant, (3.0, "line delta"), length=length)
    assert plant.speed == 1
    assert plant.incidents == ()


def test_without_line_or_without_star_and_delta_nothing_turns():
    for names in ("line", "star", "delta"):
        plant = StarDelta()
        run(plant, (3.0, names))
        assert plant.speed == 0


def test_it_coasts_down_in_10_s():
    plant = StarDelta()
    run(plant, (6.0, "line star"), (0.1, "line"), (4.0, "line delta"), (0.025 + 5.0, ""))
    assert plant.speed == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize(
    ("phases", "what"),
    [
        (((1.0, "line star"), (0.1, "line star delta")), "star and delta short the mains"),
        (((6.0, "line star"), (0.03, "line delta")), "star and delta short the mains"),
        (((2.02, "line star"), (0.15, "line"), (0.1, "line delta")), "delta at 49% of the speed blows the fuses"),
        (((1.0, "line delta"),), "delta at 0% of the speed blows the fuses"),
    ],
    ids=["together", "without a pause", "too slow", "at once"],
)
def test_what_must_not_happen_blows_the_fuses(phases, what):
    plant = StarDelta()
    run(plant, *phases)
    assert plant.incidents[0].what == what
    run(plant, (5.0, ""), (5.0, "line star"))
    assert plant.speed == 0


def test_a_pause_of_10_ms_is_enough_for_the_contactors():
    plant = StarDelta()
    run(plant, (6.0, "line star"), (0.011, "line"), (1.0, "line delta"))
    assert plant.incidents == ()


def test_a_jammed_motor_trips_its_relay_after_6_s_and_cools_in_30():
    plant = StarDelta()
    plant.fail("jammed")
    assert run(plant, (0.015 + 5.9, "line star")) == {"X2": 1}
    assert run(plant, (0.2, "line star")) == {"X2": 0}
    plant.fail("jammed", on=False)
    assert run(plant, (29.8, "")) == {"X2": 0}
    assert run(plant, (0.4, "")) == {"X2": 1}


def test_the_way_back():
    plant = StarDelta()
    run(plant, (3.0, "line star"))
    before = plant.state()
    first = run(plant, (3.0, "line star"), (1.0, "")), plant.speed, plant.turns
    plant.restore(before)
    assert (run(plant, (3.0, "line star"), (1.0, "")), plant.speed, plant.turns) == first


def shown(*phases, **inputs):
    plant = StarDelta()
    said = run(plant, *phases)
    return PICTURE.state(Moment(plant, {**said, **inputs}, outputs(phases[-1][1])))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown((1.0, "line star")) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_the_picture_tells_speed_contacts_and_what_is_on():
    state = shown((0.015 + 2.0, "line star"), X0=1)
    assert state["speed:text"] == "50%"
    assert state["bar:transform"] == "translate(73.0 0.0)"  # half of 146 px
    upright = [float(part) for part in re.findall(r"-?[\d.]+", state["contact-star:transform"])]
    assert upright[2] * 112 + upright[4] == pytest.approx(10, abs=0.02)
    assert {key for key, value in state.items() if value.endswith(" on")} == {
        "X0:class", "X2:class", "Y0:class", "Y1:class", "coil-line:class", "coil-star:class", "motor:class",
    }  # fmt: skip
