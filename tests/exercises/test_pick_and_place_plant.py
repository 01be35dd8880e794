"""The arm's movements, from its times on paper, what becomes of the parts, and its picture."""

import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.pick_and_place import PICTURE, Arm
from ecsim_exercises.plant import Moment

OFF = dict.fromkeys(("Y0", "Y1", "Y2", "Y3"), 0)
RIGHT, LEFT, DOWN, GRIP = "Y0", "Y1", "Y2", "Y3"
FETCH = ((1.1, ""), (0.7, "Y2"), (0.3, "Y2 Y3"))  # a part comes after 1 s
BRING = (*FETCH, (0.6, "Y3"), (1.7, "Y0 Y3"))
PUT = (*BRING, (0.7, "Y2 Y3"), (0.2, "Y2"))


def run(plant, *phases, length=None):
    """Let the machine go through (seconds, outputs that are ON); gives what its switches say then."""
    said = {}
    for seconds, on in phases:
        outputs = OFF | dict.fromkeys(on.split(), 1)
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), outputs)
            left -= length or seconds
    return {device for device, value in said.items() if value}


def whats(plant):
    return [incident.what for incident in plant.incidents]


@pytest.mark.parametrize("length", [None, 0.1, 0.007])
def test_the_carriage_needs_1_6_s_from_end_to_end_and_stays_where_it_is_left(length):
    plant = Arm((99.0,))
    assert run(plant, (0.4, RIGHT), length=length) == {"X4", "X7"}
    assert plant.carriage == pytest.approx(0.25)
    run(plant, (5.0, ""), length=length)
    assert plant.carriage == pytest.approx(0.25)
    assert "X3" in run(plant, (1.21, RIGHT), length=length)
    assert "X2" in run(plant, (1.61, LEFT), length=length)
    assert plant.incidents == ()


@pytest.mark.parametrize("length", [None, 0.1, 0.007])
def test_the_cylinder_goes_down_in_0_6_s_and_comes_up_in_0_5(length):
    plant = Arm((99.0,))
    assert run(plant, (0.3, DOWN), length=length) & {"X4", "X5"} == set()
    assert plant.cylinder == pytest.approx(0.5)
    assert "X5" in run(plant, (0.31, DOWN), length=length)
    assert "X4" not in run(plant, (0.4, ""), length=length)
    assert "X4" in run(plant, (0.11, ""), length=length)


def test_an_end_switch_lets_go_at_once():
    plant = Arm((99.0,))
    assert run(plant, (0.01, "Y0 Y2")) & {"X2", "X4"} == set()


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_a_part_is_gripped_brought_and_set_down(length):
    plant = Arm((1.0,), 2.0)
    assert {"X1", "X5", "X6"} <= run(plant, *FETCH, length=length)  # 0.25 s to close
    said = run(plant, (0.6, "Y3"), length=length)
    assert "X6" in said
    assert "X1" not in said
    run(plant, (1.7, "Y0 Y3"), (0.7, "Y2 Y3"), length=length)
    assert run(plant, (0.2, "Y2"), length=length) & {"X6", "X7"} == set()
    assert (plant.placed, plant.lost, plant.incidents) == (1, 0, ())


def test_the_part_is_taken_away_when_the_arm_has_gone_up():
    plant = Arm((1.0, 99.0), 2.0)
    assert "X7" not in run(plant, *PUT, (5.0, "Y2"))
    assert "X7" not in run(plant, (1.9, ""))
    assert "X7" in run(plant, (0.2, ""))


def test_the_nest_fills_again_a_while_after_the_part_was_lifted():
    plant = Arm((1.0, 3.0))
    run(plant, *FETCH, (0.6, "Y3"))
    assert "X1" not in run(plant, (2.3, "Y3"))  # 2.9 s since it was lifted
    assert "X1" in run(plant, (0.2, "Y3"))


def test_opened_in_the_nest_the_part_lies_there_again():
    plant = Arm((1.0,))
    assert run(plant, *FETCH, (0.2, "Y2")) & {"X1", "X6"} == {"X1"}
    assert plant.lost == 0


@pytest.mark.parametrize(
    "phases", [((0.6, "Y3"), (0.1, "")), ((0.6, "Y3"), (0.8, "Y0 Y3"), (0.7, "Y2 Y3"), (0.1, "Y2"))], ids=["above", "beside"]
)
def test_opened_elsewhere_it_falls(phases):
    plant = Arm((1.0, 99.0))
    run(plant, *FETCH, *phases)
    assert (plant.lost, plant.holds, whats(plant)) == (1, False, ["a part falls"])


@pytest.mark.parametrize("length", [None, 0.01])
def test_travelling_below_hits_something_and_costs_the_part(length):
    plant = Arm((1.0,))
    run(plant, *FETCH, (0.3, "Y0 Y2 Y3"), length=length)
    assert (whats(plant), plant.lost, plant.holds, plant.nest) == (["the arm hits something on its way"], 1, False, False)


@pytest.mark.parametrize(("seconds", "hit"), [(0.02, False), (0.05, True)])
def test_a_hand_over_between_lowering_and_travelling_is_forgiven(seconds, hit):
    plant = Arm((99.0,))  # 5 % of the way down take 0.03 s
    run(plant, (0.5, RIGHT), (seconds, "Y0 Y2"))
    assert bool(plant.incidents) == hit


def test_driving_against_an_end_does_harm_after_half_a_second():
    plant = Arm((99.0,))
    run(plant, (0.49, LEFT))
    assert plant.incidents == ()
    run(plant, (3.0, LEFT))
    assert [(pytest.approx(seconds), what) for seconds, what in plant.incidents] == [(0.5, "the carriage drives against its end")]
    run(plant, (0.1, ""), (0.6, LEFT))
    assert len(plant.incidents) == 2


def test_both_ways_at_once_are_noted():
    plant = Arm((99.0,), carriage=0.5)
    run(plant, (0.3, "Y0 Y1"))
    assert (plant.carriage, whats(plant)) == (0.5, ["the carriage is driven both ways"])


def test_a_part_on_another_one_is_noted():
    plant = Arm((1.0,), 99.0)
    run(plant, *PUT, (0.6, ""), (1.61, "Y1"), *FETCH, (0.6, "Y3"), (1.61, "Y0 Y3"), (0.7, "Y2 Y3"))
    assert whats(plant) == ["a part is set on another one"]


def test_what_slipped_is_caught_by_closing_again_only():
    plant = Arm((1.0,))
    plant.fail("slips")
    assert "X6" not in run(plant, *FETCH)
    plant.fail("slips", on=False)
    assert "X6" not in run(plant, (2.0, "Y2 Y3"))
    assert "X6" in run(plant, (0.2, "Y2"), (0.3, "Y2 Y3"))


@pytest.mark.parametrize(
    ("fault", "phases", "switch"),
    [("no air", ((0.7, "Y2"),), "X5"), ("carriage jams", ((1.7, "Y0"),), "X3"), ("place blocked", (*PUT, (4.0, "")), "X7")],
)
def test_a_fault_holds_what_it_names_and_lets_go_of_it(fault, phases, switch):
    plant = Arm((1.0,))
    plant.fail(fault)
    assert switch not in run(plant, *phases)
    plant.fail(fault, on=False)
    assert switch in run(plant, (2.5, phases[-1][1]))


def test_the_way_back():
    plant = Arm()
    run(plant, *FETCH)
    before = plant.state()
    first = run(plant, (0.6, "Y3"), (1.0, "Y0 Y3")), plant.carriage, plant.seconds
    plant.restore(before)
    assert (run(plant, (0.6, "Y3"), (1.0, "Y0 Y3")), plant.carriage, plant.seconds) == first


@pytest.mark.parametrize("wrong", [{"pauses": ()}, {"pauses": (-1.0,)}, {"clears_s": -1.0}, {"carriage": 1.5}])
def test_what_makes_no_arm_is_refused(wrong):
    with pytest.raises(ValueError, match="from 0 s and a carriage between 0 and 1"):
        Arm(**wrong)


def shown(plant, *phases):
    said = run(plant, *phases)
    outputs = OFF | dict.fromkeys(phases[-1][1].split(), 1)
    return PICTURE.state(Moment(plant, dict.fromkeys(said, 1), outputs))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown(Arm(), (1.0, "")) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_the_picture_names_every_point():
    root = xml.fromstring(PICTURE.svg())
    tags = {tag.get("data-device"): "".join(tag.itertext()) for tag in root.iter() if tag.get("data-device")}
    assert tags == {device: device + point.name for device, point in Arm.wiring.items()}


def test_what_moves_is_drawn_where_it_is():
    state = shown(Arm((1.0, 99.0)), *FETCH, (0.6, "Y3"), (0.8, "Y0 Y3"))
    assert state["carriage:transform"] == "translate(170.0 0.0)"  # half of 340 px
    assert (state["rod:transform"], state["jaw-left:transform"], state["jaw-right:transform"]) == (
        "translate(0.0 0.0)", "translate(9.0 0.0)", "translate(-9.0 0.0)",
    )  # fmt: skip
    assert state["part-held:transform"] == "translate(0 0)"
    assert state["part-nest:transform"] == state["part-place:transform"] == "translate(-2000 0)"
    assert {key for key, value in state.items() if value.endswith(" on")} == {
        "X4:class", "X6:class", "X7:class", "Y0:class", "Y3:class", "switch-X4:class", "switch-X7:class", "go-right:class", "motor:class",
        "gripper:class",
    }  # fmt: skip


def test_what_went_wrong_is_told():
    state = shown(Arm((1.0, 99.0)), *FETCH, (0.6, "Y3"), (0.1, ""))
    assert (state["lost:text"], state["amiss-text:text"]) == ("1", "2.70 s: a part falls")
