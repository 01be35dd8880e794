"""The conveyor's picture: everything the table names is drawn, and what moves on the machine moves in the picture."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.conveyor import PICTURE, Conveyor
from ecsim_exercises.conveyor.picture import SLOTS
from ecsim_exercises.plant import Moment

BITS = {f"X{n}": 0 for n in range(7)} | {f"Y{n}": 0 for n in range(6)}
SVG = "{http://www.w3.org/2000/svg}"


def moment(seconds=0.0, distances=(0.5, 3.0), **outputs):
    """The machine after so long under these outputs."""
    plant = Conveyor(distances=distances)
    terminals = BITS | outputs
    inputs = plant.step(seconds, terminals)
    return Moment(plant, inputs, terminals)


def drawn(prefix=""):
    """The picture at rest as elements by id."""
    root = xml.fromstring(PICTURE.svg(prefix))
    return root, {element.get("id"): element for element in root.iter() if element.get("id")}


def changed(one, other):
    """The entries in which two states differ."""
    assert one.keys() == other.keys()
    return {key: other[key] for key in one if one[key] != other[key]}


def x_of(state, slot):
    return float(re.match(r"translate\(([-\d.]+) ", state[f"pallet-{slot}:transform"])[1])


@pytest.mark.parametrize("prefix", ["", "lab1-"])
def test_every_entry_of_the_state_has_its_element(prefix):
    _, elements = drawn(prefix)
    state = PICTURE.state(moment(8.0, Y0=1, Y4=1))
    for key in state:
        part, attribute = key.rsplit(":", 1)
        assert prefix + part in elements, key
        assert attribute in {"transform", "class", "text"}
        if attribute == "text":
            assert elements[prefix + part].tag == f"{SVG}text"


def test_every_part_and_tag_of_the_drawing_is_moved_or_lit():
    root, _ = drawn()
    state = PICTURE.state(moment())
    parts = [element.get("data-part") for element in root.iter() if element.get("data-part")]
    assert len(parts) == len(set(parts)) == 2 + 2 + 1 + 12 + 4 + SLOTS
    assert [part for part in parts if f"{part}:transform" not in state] == []
    tags = {element.get("data-device") for element in root.iter() if element.get("data-device")}
    assert tags == set(Conveyor.wiring) - {"X5", "X6"}
    assert [device for device in tags if f"{device}:class" not in state] == []


def test_the_names_in_the_drawing_are_those_of_the_wiring():
    root, _ = drawn()
    written = {tag.get("data-device"): [text.text for text in tag.iter(f"{SVG}text")] for tag in root.iter() if tag.get("data-device")}
    assert written == {device: [device, Conveyor.wiring[device].name] for device in written}


def test_ids_are_unique_and_references_follow_the_prefix():
    text = PICTURE.svg("p7-")
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(ids) == len(set(ids))
    assert all(name.startswith("p7-") for name in ids)
    references = re.findall(r'url\(#([^)]+)\)|href="#([^"]+)"', text)
    assert references
    assert {first or second for first, second in references} <= set(ids)


def test_the_picture_keeps_its_shape_at_another_width():
    root = xml.fromstring(PICTURE.svg(width=418))
    natural = xml.fromstring(PICTURE.svg())
    assert float(root.get("width")) == 418
    assert float(root.get("height")) == pytest.approx(float(natural.get("height")) / 2)
    assert root.get("viewBox") == natural.get("viewBox")


def test_colours_come_from_tokens_with_a_literal_beside_them():
    text = PICTURE.svg()
    colours = re.findall(r"#[0-9a-fA-F]{6}\b|#[0-9a-fA-F]{3}\b|rgba?\([^)]*\)", text)
    with_token = re.findall(r"var\(--ec-[\w-]+, (#[0-9a-f]{6})\)", text)
    assert colours == with_token != []
    assert not re.search(r"\b(fill|stroke)=", text), "colours stand in the style alone"


def test_the_literals_are_those_of_the_light_theme(root):
    tokens = (root / "ecsim" / "views" / "look" / "tokens.css").read_text(encoding="utf-8")
    light = {}
    for name, value in re.findall(r"(--ec-[\w-]+):\s*([^;]+);", tokens):
        light.setdefault(name, re.sub(r"var\(--jp-[\w-]+, (.+)\)", r"\1", value))
    used = set(re.findall(r"var\((--ec-[\w-]+), (#[0-9a-f]{6}|\d+px)\)", PICTURE.svg()))
    assert len(used) > 10
    assert {name: light[name] for name, _ in used} == dict(used)


def test_at_rest_nothing_is_lit():
    assert [key for key, value in PICTURE.state(moment()).items() if value.split()[-1:] == ["on"]] == []


@pytest.mark.parametrize(
    ("output", "lit"),
    [
        ("Y0", {"Y0", "gate-cylinder"}),
        ("Y1", {"Y1", "lift-left-cylinder"}),
        ("Y2", {"Y2", "lift-right-cylinder"}),
        ("Y3", {"Y3", "roller-motor"}),
        ("Y4", {"Y4", "belt-left-motor", "go-left"}),
        ("Y5", {"Y5", "belt-right-motor", "go-right"}),
    ],
)
def test_an_output_lights_its_tag_and_what_it_acts_on(output, lit):
    change = changed(PICTURE.state(moment()), PICTURE.state(moment(**{output: 1})))
    assert {key for key in change if key.endswith(":class")} == {f"{part}:class" for part in lit}
    assert all(change[f"{part}:class"].split()[-1] == "on" for part in lit)


def test_a_tag_shows_the_terminal_and_the_switch_the_machine():
    at_gate = moment(10.0, Y4=1)
    state = PICTURE.state(at_gate)
    assert state["X0:class"] == "mtag in on"
    assert state["X0-switch:class"] == "sensor on"
    stuck = PICTURE.state(at_gate._replace(inputs={**at_gate.inputs, "X0": 0}))
    assert changed(state, stuck) == {"X0:class": "mtag in"}


def test_the_moving_parts_travel_their_way():
    up = PICTURE.state(moment(3.0, Y0=1, Y1=1, Y2=1))
    half = PICTURE.state(moment(0.6, Y1=1))
    _, elements = drawn()
    for part in ("gate", "lift-left", "lift-right", "lift-left-tag"):
        dx, dy = map(float, elements[part].get("data-move").split())
        assert up[f"{part}:transform"] == f"translate({dx:.1f} {dy:.1f})"
    assert half["lift-left:transform"] == f"translate(0.0 {dy / 2:.1f})"
    assert half["lift-right:transform"] == PICTURE.state(moment())["lift-right:transform"]


def test_only_running_drives_turn():
    rest = PICTURE.state(moment())
    assert {key for key in changed(rest, PICTURE.state(moment(0.1, Y3=1))) if "rotate" in rest[key]} == {
        f"roller-{side}-{n}:transform" for side in ("left", "right") for n in range(6)
    }
    assert {key for key in changed(rest, PICTURE.state(moment(0.1, Y5=1))) if "rotate" in rest[key]} == {
        "drum-right-0:transform",
        "drum-right-1:transform",
    }


def test_a_pallet_keeps_its_slot_and_moves_with_the_belt():
    before, after = PICTURE.state(moment(1.0, Y4=1)), PICTURE.state(moment(2.0, Y4=1))
    assert x_of(after, 1) - x_of(before, 1) == pytest.approx(30)  # 0.3 m/s at 100 pixels a metre
    assert before["pallet-1-number:text"] == "1"


def test_a_pallet_at_the_gate_touches_the_plate_and_lies_on_the_belt():
    state = PICTURE.state(moment(10.0, Y4=1))
    _, elements = drawn()
    plate = next(rect for rect in elements["gate"].iter(f"{SVG}rect") if rect.get("class") == "p4")
    assert x_of(state, 1) + 120 == float(plate.get("x"))
    assert state["pallet-1:transform"].endswith(" 212.0)")


def test_a_pallet_that_lies_askew_is_drawn_askew_and_the_incident_in_words():
    plant = Conveyor()
    plant.step(6.0, BITS | {"Y0": 1, "Y4": 1})
    inputs = plant.step(1.2, BITS | {"Y0": 1, "Y1": 1})
    state = PICTURE.state(Moment(plant, inputs, BITS))
    assert "rotate(-" in state["pallet-1:transform"]
    assert state["amiss:class"] == "amiss on"
    assert state["amiss-text:text"] == "6.00 s: pallet 1 tips"
    assert PICTURE.state(moment())["amiss-text:text"] == ""


def test_there_are_slots_for_all_pallets_the_machine_can_hold():
    plant = Conveyor(distances=(0.0,))
    for _ in range(3000):  # as full as it gets: everything runs in, nothing can leave
        plant.step(0.1, BITS | {"Y0": 1, "Y4": 1, "Y5": 0})
        assert len(plant.fronts) <= SLOTS
    assert len({number % SLOTS for number, _ in enumerate(plant.fronts, plant.delivered + 1)}) == len(plant.fronts)
