"""The bottle machine's physics: times and places on paper, whatever the length of the steps."""

import pytest
from ecsim_exercises.bottles.plant import KINDS, BottleMachine

from ecsim import EcsimError

OFF = {f"Y{n}": 0 for n in range(4)}
REST = {"X0": 1, "X1": 0, "X2": 0, "X3": 0, "X5": 0, "X6": 0, "X7": 0, "X10": 1, "X11": 1, "X12": 1}
TURN = ((1.0, "Y0"),)
CAP, LABEL, REJECT = (((out, output), (back, "")) for output, out, back in (("Y1", 0.6, 0.6), ("Y2", 0.5, 0.5), ("Y3", 0.4, 0.4)))


def run(plant, *phases, length=None):
    """Let the machine go through (seconds, outputs that are ON); gives what it says then."""
    said = {}
    for seconds, on in phases:
        outputs = OFF | dict.fromkeys(on.split(), 1)
        left = seconds
        while left > 1e-9:
            said = plant.step(min(length or seconds, left), outputs)
            left -= length or seconds
    return said


def numbers(plant):
    """What stands at entry, the place behind it, capper, labeller, reject cylinder, the place behind it and exit: bottles by number."""
    return [bottle and bottle.number for bottle in plant.line[:7]]


def bottle(plant, number):
    return next(one for one in plant.line if one and one.number == number)


def test_at_rest_the_table_stands_at_a_station_and_all_cylinders_are_home():
    assert run(BottleMachine(), (10, "")) == REST


@pytest.mark.parametrize("length", [None, 0.1, 0.037, 0.01])
def test_the_table_takes_its_time_from_station_to_station(length):
    plant = BottleMachine(table_s=1.6)
    run(plant, (4.0, "Y0"), length=length)
    assert plant.turned + plant.table == pytest.approx(4.0 / 1.6)
    run(plant, (3.0, ""), length=length)
    assert plant.turned + plant.table == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("seconds", "seen"), [(0.03, 1), (0.05, 1), (0.07, 0), (0.5, 0), (0.95, 0), (0.97, 1), (1.0, 1), (1.05, 1), (1.07, 0)]
)
def test_the_proximity_switch_sees_a_tenth_of_the_way(seconds, seen):
    assert run(BottleMachine(), (seconds, "Y0"))["X0"] == seen


def test_bottles_go_one_place_a_turn_and_a_gap_is_a_place_without_one():
    plant = BottleMachine(first=("good", "gap", "good", "good", "gap", "gap", "gap"))
    found = [numbers(plant)]
    for _ in range(6):
        run(plant, *TURN)
        found.append(numbers(plant))
    assert found[2] == [3, None, 1, None, None, None, None]
    assert found[6] == [None, None, None, 4, 3, None, 1]
    assert plant.passed == 1


def test_the_eye_sees_a_bottle_at_the_capper():
    plant = BottleMachine(first=("good", "gap", "good"))
    seen = [run(plant, *TURN)["X1"] for _ in range(4)]
    assert seen == [0, 1, 0, 1]
    assert run(plant, (0.2, "Y0"))["X1"] == 0


@pytest.mark.parametrize(
    ("output", "travel", "out", "home"), [("Y1", 0.9, "X7", "X10"), ("Y2", 0.7, "X6", "X11"), ("Y3", 0.5, "X5", "X12")]
)
@pytest.mark.parametrize("length", [None, 0.1, 0.043])
def test_a_cylinder_tells_its_two_ends(output, travel, out, home, length):
    plant = BottleMachine(stroke_s=(0.9, 0.7, 0.5))
    phases = ((travel - 0.01, output), (0.02, output), (0.005, ""), (travel - 0.02, ""), (0.02, ""))
    said = [run(plant, phase, length=length) for phase in phases]
    assert [(one[out], one[home]) for one in said] == [(0, 0), (1, 0), (0, 0), (0, 0), (0, 1)]


@pytest.mark.parametrize("length", [None, 0.1, 0.01])
def test_a_good_bottle_gets_cap_and_label_and_leaves(length):
    plant = BottleMachine(first=("good",))
    said = run(plant, *TURN, *TURN, *CAP, length=length)
    assert (said["X1"], said["X2"], said["X3"]) == (1, 1, 0)
    said = run(plant, *TURN, *LABEL, length=length)
    assert (said["X3"], plant.straight) == (1, True)
    assert bottle(plant, 1).sound
    run(plant, *TURN, length=length)
    assert (plant.sound, plant.faulty) == (True, False)
    run(plant, *TURN, *TURN, length=length)
    assert (plant.passed, plant.escaped, plant.lost, plant.rejected) == (1, 0, 0, 0)


def test_the_cap_is_on_from_nine_tenths_of_the_stroke():
    plant = BottleMachine(first=("good",))
    run(plant, *TURN, *TURN)
    assert run(plant, (0.53, "Y1"))["X2"] == 0
    assert run(plant, (0.02, "Y1"))["X2"] == 1


@pytest.mark.parametrize(("kind", "cap_ok", "label_ok"), [("good", 1, 1), ("bad cap", 0, 1), ("bad label", 1, 0)])
def test_what_becomes_of_a_bottle_is_what_the_belt_brought(kind, cap_ok, label_ok):
    plant = BottleMachine(first=(kind,))
    assert run(plant, *TURN, *TURN, *CAP)["X2"] == cap_ok
    assert run(plant, *TURN, *LABEL)["X3"] == label_ok
    assert bottle(plant, 1).sound is (kind == "good")


def test_a_faulty_bottle_is_rejected_by_a_whole_stroke_only():
    plant = BottleMachine(first=("bad cap", "gap", "gap"))
    run(plant, *TURN, *TURN, *CAP, *TURN, *TURN)
    assert plant.faulty
    run(plant, (0.35, "Y3"), (0.4, ""))
    assert (plant.rejected, plant.faulty) == (0, True)
    run(plant, *REJECT)
    assert (plant.rejected, plant.lost, plant.faulty) == (1, 0, False)
    run(plant, *TURN)
    assert plant.escaped == 0


def test_what_goes_wrong_with_bottles_is_counted():
    plant = BottleMachine(first=("good", "good", "good", "gap", "gap", "gap"))
    run(plant, *TURN, *TURN, *CAP, *TURN)  # bottle 1 is capped
    assert plant.uncapped == 0
    run(plant, *CAP, *TURN)  # bottle 2 as well, 1 goes on without a label
    assert (plant.uncapped, plant.unlabelled) == (0, 1)
    run(plant, *LABEL, *TURN)  # 2 gets its label, 3 no cap, and 1 gets past
    assert (plant.uncapped, plant.escaped) == (1, 1)
    run(plant, *REJECT)  # the good one
    assert (plant.rejected, plant.lost) == (1, 1)


def test_a_second_cap_spoils_the_bottle():
    plant = BottleMachine(first=("good",))
    assert run(plant, *TURN, *TURN, *CAP, *CAP)["X2"] == 0


def test_one_long_stroke_is_one_cap():
    plant = BottleMachine(first=("good",))
    assert run(plant, *TURN, *TURN, (5, "Y1"), (0.03, ""), (5, "Y1"), (1, ""))["X2"] == 1  # it never left the bottle


@pytest.mark.parametrize(("output", "name"), [("Y1", "capper"), ("Y2", "labeller"), ("Y3", "reject cylinder")])
@pytest.mark.parametrize("length", [None, 0.01])
def test_the_table_does_not_turn_against_a_cylinder(output, name, length):
    plant = BottleMachine()
    run(plant, (1.0, output), (2.0, f"Y0 {output}"), (0.1, output), length=length)
    assert (plant.turned, plant.table) == (0, 0)
    assert [(round(one.seconds, 2), one.what) for one in plant.incidents] == [(1.0, f"table hits {name}")]


@pytest.mark.parametrize(("output", "number", "name"), [("Y1", 0, "capper"), ("Y2", 1, "labeller"), ("Y3", 2, "reject cylinder")])
def test_a_cylinder_that_meets_the_table_between_two_stations_stops(output, number, name):
    plant = BottleMachine()
    run(plant, (0.5, "Y0"), (3.0, output))
    assert plant.strokes[number] == pytest.approx(0.1)
    assert [one.what for one in plant.incidents] == [f"{name} hits table"]


def test_a_hand_over_of_one_scan_hits_nothing():
    plant = BottleMachine(stroke_s=(0.3, 0.3, 0.3))
    run(plant, (0.97, "Y0"), (0.01, "Y0 Y1 Y2 Y3"), (0.5, "Y1 Y2 Y3"), (0.5, ""))
    assert plant.incidents == ()


def test_the_stream_is_the_same_for_a_seed_and_has_all_kinds():
    kinds = [BottleMachine(first=(), seed=4).kind(number) for number in range(1, 2001)]
    assert kinds == [BottleMachine(first=(), seed=4).kind(number) for number in range(1, 2001)]
    assert kinds != [BottleMachine(first=(), seed=5).kind(number) for number in range(1, 2001)]
    shares = {kind: kinds.count(kind) / len(kinds) for kind in KINDS}
    assert shares == pytest.approx({"good": 0.7, "bad cap": 0.1, "bad label": 0.1, "gap": 0.1}, abs=0.03)


@pytest.mark.parametrize(
    ("fault", "output", "switch"),
    [("table jams", "Y0", "X0"), ("capper jams", "Y1", "X10"), ("labeller jams", "Y2", "X11"), ("reject jams", "Y3", "X12")],
)
def test_a_jam_holds_what_it_names_and_lets_go_of_it(fault, output, switch):
    plant = BottleMachine()
    plant.fail(fault)
    assert run(plant, (0.3, output), length=0.01)[switch] == 1
    plant.fail(fault, on=False)
    assert run(plant, (0.3, output), length=0.01)[switch] == 0


def test_a_cylinder_that_jams_outside_does_not_return():
    plant = BottleMachine()
    run(plant, (1, "Y1"))
    plant.fail("capper jams")
    said = run(plant, (9, ""))
    assert (said["X7"], said["X10"], plant.strokes[0]) == (1, 0, 1.0)


@pytest.mark.parametrize(("fault", "switch"), [("no caps", "X2"), ("no labels", "X3")])
def test_an_empty_magazine_leaves_the_bottle_as_it_is(fault, switch):
    plant = BottleMachine(first=("good",))
    plant.fail(fault)
    said = [run(plant, *TURN, *TURN, *CAP), run(plant, *TURN, *LABEL)][switch == "X3"]
    assert said[switch] == 0
    run(plant, *TURN)
    assert (plant.faulty, plant.uncapped, plant.unlabelled) == (True, 0, 0)


def test_a_fault_that_it_does_not_have_is_refused():
    with pytest.raises(EcsimError, match="no fault 'rust'; it has table jams"):
        BottleMachine().fail("rust")


def test_the_way_back():
    plant = BottleMachine()
    run(plant, (3.4, "Y0"), length=0.1)
    before = plant.state()
    story = ((0.6, "Y0"), *CAP, *LABEL, *TURN, *REJECT)
    first = run(plant, *story, length=0.1), plant.line, plant.rejected, plant.seconds
    plant.restore(before)
    assert (run(plant, *story, length=0.1), plant.line, plant.rejected, plant.seconds) == first


@pytest.mark.parametrize("length", [0.1, 0.037, 0.01])
def test_the_same_outputs_give_the_same_run(length):
    def story(length):
        plant = BottleMachine()
        for _ in range(9):
            run(plant, (1.0, "Y0"), (0.7, "Y1 Y2 Y3"), (0.7, ""), length=length)
        return plant.line, plant.passed, plant.rejected, plant.lost, plant.uncapped, plant.unlabelled, plant.incidents

    assert story(length) == story(None)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"first": ("best",)}, "'best' is no kind of bottle"),
        ({"stroke_s": (1.0, 0.0, 1.0)}, "three above 0 s"),
        ({"table_s": 0}, "one time"),
    ],
)
def test_what_makes_no_machine_is_refused(given, says):
    with pytest.raises(ValueError, match=says):
        BottleMachine(**given)
