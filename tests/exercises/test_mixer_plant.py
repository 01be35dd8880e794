"""The mixer's physics: weights from the rates on paper, whatever the length of the steps."""

import pytest
from ecsim_exercises.mixer.plant import Mixer

from ecsim import EcsimError

OFF = {f"Y{n}": 0 for n in range(6)}
SHUT = {"X0": 0, "X1": 1, "X2": 0, "X3": 1, "X4": 0, "X5": 1, "X6": 0, "X7": 1, "X10": 0, "X11": 0, "X12": 1, "D0": 0}


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


def test_at_rest_all_valves_are_shut_and_the_vessel_is_empty():
    assert run(Mixer(), (10, "")) == SHUT


def test_a_valve_tells_open_and_closed_at_its_ends_only():
    plant = Mixer()
    ends = [run(plant, phase) for phase in ((0.75, "Y1"), (0.75, "Y1"), (1.0, ""), (0.5, ""))]
    assert [(said["X2"], said["X3"]) for said in ends] == [(0, 0), (1, 0), (0, 0), (0, 1)]


@pytest.mark.parametrize(
    ("output", "rate", "travel"), [("Y0", 8, 1.5), ("Y1", 8, 1.5), ("Y2", 5, 1.0), ("Y3", 4, 1.0)], ids=["water", "main", "A", "B"]
)
@pytest.mark.parametrize("length", [None, 0.1, 0.037])
def test_what_flows_is_the_rate_times_the_open_time(output, rate, travel, length):
    plant = Mixer()
    assert run(plant, (40, output), length=length)["D0"] == int(rate * (40 - travel / 2))  # half open for its way, on the mean
    run(plant, (10, ""), length=length)
    assert plant.weight == pytest.approx(rate * 40, abs=1e-6)  # closing lets as much in as opening kept out


@pytest.mark.parametrize("length", [None, 0.1, 0.043])
def test_the_drain_empties_the_vessel_and_not_more(length):
    plant = Mixer()
    run(plant, (30, "Y1"), (10, ""), (10, "Y4"), length=length)
    assert plant.weight == pytest.approx(240 - 12 * (10 - 1), abs=1e-6)
    run(plant, (20, "Y4"), length=length)
    assert plant.weight == 0


def test_in_the_wash_the_drain_takes_more_than_the_water_brings():
    plant = Mixer()
    said = run(plant, (300, "Y0 Y4"), (5, ""), length=0.1)
    assert said["D0"] <= 1
    assert plant.washed_s == pytest.approx(300 + 1.5, abs=0.2)  # until the water valve is shut


def test_a_batch_is_noted_with_all_that_went_in_and_how_long_it_was_stirred():
    plant = Mixer()
    run(plant, (300, "Y0 Y4"), (5, ""), (250, "Y1"), (5, ""), (100, "Y2"), (3, ""), (60, "Y5"), (4, ""), (300, "Y4"), length=0.1)
    (batch,) = plant.batches
    assert plant.finished == 1
    assert (batch.main, batch.a, batch.b) == pytest.approx((2000, 500, 0), abs=0.01)
    assert batch.stirred_s == pytest.approx(62, abs=0.2)  # 60 s driven, 2 s to stand still
    assert batch.washed_s == pytest.approx(301.5, abs=0.2)


def test_the_stirrer_needs_time_to_run_up():
    plant = Mixer()
    assert run(plant, (1.7, "Y5"))["X10"] == 0
    assert run(plant, (0.3, "Y5"))["X10"] == 1
    turned = plant.turns
    run(plant, (7, "Y5"))
    assert plant.turns - turned == pytest.approx(10)  # 0.7 s a turn


def test_the_vessel_runs_over_at_3000_kg():
    plant = Mixer()
    said = run(plant, (400, "Y1"), length=0.1)
    assert said["D0"] == 3000
    assert plant.spilt == pytest.approx(8 * (400 - 0.75) - 3000, abs=0.01)
    assert [(one.batch, one.what) for one in plant.incidents] == [(1, "runs over")]
    assert plant.incidents[0].seconds == pytest.approx(3000 / 8 + 0.75, abs=0.1)


@pytest.mark.parametrize(
    ("fault", "on", "sensor", "value"),
    [
        ("water sticks", "Y0", "X1", 1),
        ("main sticks", "Y1", "X3", 1),
        ("A sticks", "Y2", "X5", 1),
        ("B sticks", "Y3", "X7", 1),
        ("drain sticks", "Y4", "X12", 1),
        ("stirrer trips", "Y5", "X10", 0),
        ("scale hangs", "Y1", "D0", 0),
    ],
)
def test_a_fault_holds_what_it_names_and_lets_go_of_it(fault, on, sensor, value):
    plant = Mixer()
    plant.fail(fault)
    assert run(plant, (10, on), length=0.1)[sensor] == value
    plant.fail(fault, on=False)
    assert run(plant, (10, on), length=0.1)[sensor] != value


def test_a_valve_that_sticks_half_open_stays_so():
    plant = Mixer()
    run(plant, (0.75, "Y1"))
    plant.fail("main sticks")
    run(plant, (10, ""), length=0.1)
    assert plant.places[1] == 0.5
    assert plant.weight == pytest.approx(8 * 0.75 / 4 + 8 * 0.5 * 10)


def test_a_fault_that_it_does_not_have_is_refused():
    with pytest.raises(EcsimError, match="no fault 'rust'; it has water sticks"):
        Mixer().fail("rust")


def test_the_way_back():
    plant = Mixer()
    run(plant, (100, "Y1"), length=0.1)
    before = plant.state()
    first = run(plant, (50, "Y1 Y5"), (20, "Y4"), length=0.1), plant.weight, plant.turns
    plant.restore(before)
    assert (run(plant, (50, "Y1 Y5"), (20, "Y4"), length=0.1), plant.weight, plant.turns) == first


def test_times_that_make_no_machine_are_refused():
    with pytest.raises(ValueError, match="five times above 0 s"):
        Mixer(valve_s=(1.5, 1.5, 0.0, 1.0, 2.0))
