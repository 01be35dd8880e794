"""The bottle machine's picture: everything the table names is drawn, and it shows what the machine is."""

import re
import xml.etree.ElementTree as xml
from math import cos, radians, sin

import pytest
from ecsim_exercises.bottles import PICTURE, BottleMachine
from ecsim_exercises.plant import Moment

SVG = "{http://www.w3.org/2000/svg}"
OFF = {f"Y{n}": 0 for n in range(4)}
FIRST = ("good", "bad cap", "bad label", "gap", "good")


def moment(*phases):
    """The machine after (seconds, outputs that are ON)."""
    plant, outputs, said = BottleMachine(first=FIRST), OFF, {}
    for seconds, on in phases:
        outputs = OFF | dict.fromkeys(on.split(), 1)
        said = plant.step(seconds, outputs)
    return Moment(plant, said, outputs)


def drawn(prefix=""):
    root = xml.fromstring(PICTURE.svg(prefix))
    return root, {element.get("id"): element for element in root.iter() if element.get("id")}


def at(state, number):
    """Where a bottle is drawn."""
    return tuple(map(float, re.match(r"translate\(([-\d.]+) ([-\d.]+)\)", state[f"bottle-{number}:transform"]).groups()))


@pytest.mark.parametrize("prefix", ["", "lab1-"])
def test_every_entry_of_the_state_has_its_element(prefix):
    _, elements = drawn(prefix)
    for key in PICTURE.state(moment((1, "Y0"))):
        part, attribute = key.rsplit(":", 1)
        assert prefix + part in elements, key
        assert attribute in {"transform", "class", "text"}


def test_the_names_in_the_drawing_are_those_of_the_wiring():
    root, _ = drawn()
    tags = {tag.get("data-device"): [text.text for text in tag.iter(f"{SVG}text")] for tag in root.iter() if tag.get("data-device")}
    assert set(tags) == set(BottleMachine.wiring)
    assert {device: words[1:] for device, words in tags.items() if words[1:] not in ([], [BottleMachine.wiring[device].name])} == {}


@pytest.mark.parametrize("turned", [0, 1, 2.25, 3, 4, 5.5])
def test_a_bottle_rides_in_its_place_of_the_table(turned):
    state = PICTURE.state(moment((turned, "Y0"))) if turned else PICTURE.state(moment((1, "")))
    angle = radians(45 * turned)
    assert at(state, 1) == pytest.approx((290 - 112 * cos(angle), 268 - 112 * sin(angle)), abs=0.06)
    assert state["table:transform"] == f"rotate({45 * turned:.0f} 290 268)" or turned % 1


def test_on_the_belts_bottles_stand_in_a_row():
    state = PICTURE.state(moment((1, "")))
    assert [at(state, number) for number in (2, 3)] == [(128, 268), (78, 268)]
    assert at(state, 4) == (-80, 268)  # the gap
    state = PICTURE.state(moment((7.5, "Y0")))
    assert at(state, 1) == (290, 268 + 112 + 75)


def test_a_bottle_goes_with_the_reject_cylinder():
    phases = ((4, "Y0"), (0.2, "Y3"))
    assert at(PICTURE.state(moment(*phases)), 1) == (290 + 112 + 38, 268)  # half of 76
    state = PICTURE.state(moment(*phases, (0.3, "Y3")))
    assert at(state, 1) == (-80, 268)
    assert state["rejected:text"] == "1 rejected"


def test_cap_and_label_are_seen():
    work = ((1.0, "Y0"), (0.6, "Y1 Y2"), (0.6, ""))
    state = PICTURE.state(moment((1.0, "Y0"), *work, *work, *work, *work))
    assert [state[f"bottle-{number}:class"] for number in (1, 2, 3, 5)] == [
        "bottle capped labelled",
        "bottle askew labelled",  # the labeller was driven at each station
        "bottle capped torn",
        "bottle",
    ]


def test_cylinders_travel_and_light_up():
    state = PICTURE.state(moment((0.3, "Y1"), (0.25, "Y1 Y2")))
    assert state["capper-rod:transform"] == "translate(0.0 33.0)"  # 0.55 s of 0.6 s, 36 px
    assert state["labeller-rod:transform"] == f"translate({-0.5 * 12.7:.1f} {0.5 * 12.7:.1f})"
    lit = {key for key, value in state.items() if value.endswith(" on")}
    assert {"Y1:class", "Y2:class", "capper-cylinder:class", "labeller-cylinder:class", "X0:class", "X0-switch:class", "X12:class"} <= lit
    assert not {"reject-cylinder:class", "table-motor:class", "X10:class", "amiss:class"} & lit


def test_nothing_rests_outside_the_frame():
    """All fixed shapes; free bottle slots wait outside, and the belts' clip hides what has gone."""
    root, _ = drawn()
    width, height = (float(root.get(name)) for name in ("width", "height"))
    assert (width, height) == (592, 512)
    for element in root.iter():
        for x, y in (("x", "y"), ("cx", "cy")):
            if element.get(x) and element.tag != f"{SVG}ellipse":
                assert 0 <= float(element.get(x)) <= width
                assert 0 <= float(element.get(y)) <= height


def test_what_went_wrong_is_told():
    state = PICTURE.state(moment((1.0, "Y1"), (0.5, "Y0 Y1")))
    assert state["amiss:class"] == "amiss on"
    assert state["amiss-text:text"] == "1.0 s: table hits capper"
