"""The mixer's picture: everything the table names is drawn, and it shows what the machine is."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.mixer import PICTURE, Mixer
from ecsim_exercises.plant import Moment

SVG = "{http://www.w3.org/2000/svg}"
OFF = {f"Y{n}": 0 for n in range(6)}


def moment(*phases, **inputs):
    """The machine after (seconds, outputs that are ON)."""
    plant, outputs, said = Mixer(), OFF, {}
    for seconds, on in phases:
        outputs = OFF | dict.fromkeys(on.split(), 1)
        said = plant.step(seconds, outputs)
    return Moment(plant, {**said, **inputs}, outputs)


def drawn(prefix=""):
    root = xml.fromstring(PICTURE.svg(prefix))
    return root, {element.get("id"): element for element in root.iter() if element.get("id")}


@pytest.mark.parametrize("prefix", ["", "lab1-"])
def test_every_entry_of_the_state_has_its_element(prefix):
    _, elements = drawn(prefix)
    for key in PICTURE.state(moment((1, "Y1"))):
        part, attribute = key.rsplit(":", 1)
        assert prefix + part in elements, key
        assert attribute in {"transform", "class", "text"}


def test_the_names_in_the_drawing_are_those_of_the_wiring():
    root, _ = drawn()
    tags = {tag.get("data-device"): [text.text for text in tag.iter(f"{SVG}text")] for tag in root.iter() if tag.get("data-device")}
    assert set(tags) == set(Mixer.wiring) - {"D0", "D2"}
    assert {device: words[1:] for device, words in tags.items() if words[1:] not in ([], [Mixer.wiring[device].name])} == {}


@pytest.mark.parametrize(("kg", "y"), [(0, 425), (1000, 336), (2000, 256), (2500, 216)])
def test_the_level_stands_at_the_scale_s_marks(kg, y):
    there = moment()
    there.plant.weight = float(kg)
    down = float(re.match(r"translate\([-\d.]+ ([-\d.]+)\)", PICTURE.state(there)["level:transform"])[1])
    assert 425 + down == pytest.approx(y, abs=0.1)


def test_what_runs_is_lit():
    lit = {key for key, value in PICTURE.state(moment((10, "Y1"))).items() if value.endswith(" on")}
    assert {"Y1:class", "Y1-valve:class", "Y1-pipe:class", "Y1-stream:class", "X2:class"} <= lit
    assert not {"Y2:class", "Y2-pipe:class", "stirrer-motor:class", "X3:class", "amiss:class"} & lit


def test_the_screen_tells_product_weight_and_batches():
    state = PICTURE.state(moment((200, "Y1"), D2=2, M2=1))
    assert (state["product:text"], state["weight:text"], state["finished:text"]) == ("B", "1,594", "0")
    assert state["M2:class"].endswith(" on")


def test_the_blades_are_widest_and_narrowest_a_quarter_turn_apart():
    there = moment()
    widths = []
    for turns in (0.0, 0.125, 0.25):
        there.plant.turns = turns
        widths.append(float(re.search(r"scale\(([\d.]+)", PICTURE.state(there)["blades:transform"])[1]))
    assert widths == pytest.approx([1.0, 0.7071, 0.12], abs=1e-3)


def test_what_went_wrong_is_told():
    state = PICTURE.state(moment((400, "Y1")))
    assert state["amiss:class"] == "amiss on"
    assert state["amiss-text:text"].endswith("batch 1 runs over")
