"""The pallet-lift conveyor as a machine: driven by a few lines of Python in place of a PLC."""

import copy

import pytest
from ecsim_exercises.conveyor import Conveyor
from ecsim_exercises.conveyor import plant as conveyor

OFF = dict.fromkeys(("Y0", "Y1", "Y2", "Y3", "Y4", "Y5"), 0)
BELTS = OFF | {"Y4": 1, "Y5": 1}


def sequence():
    """The sequence of 7.5.1 as a coroutine: send it the switches, it answers with the outputs."""
    inputs = yield OFF
    while True:
        while not inputs["X0"]:
            inputs = yield BELTS
        while not inputs["X1"]:
            inputs = yield BELTS | {"Y0": 1}
        while not inputs["X2"]:
            inputs = yield BELTS | {"Y1": 1, "Y2": 1}
        while not inputs["X3"]:
            inputs = yield BELTS | {"Y1": 1, "Y2": 1, "Y3": 1}
        while not inputs["X4"]:
            inputs = yield BELTS
        while inputs["X4"]:
            inputs = yield BELTS


def play(plant, seconds, step=0.01, controller=None):
    """Let the sequence drive the plant; yield (inputs, outputs) of every step."""
    controller = controller or sequence()
    outputs = next(controller)
    for _ in range(round(seconds / step)):
        inputs = plant.step(step, outputs)
        yield inputs, outputs
        outputs = controller.send(inputs)


def hold(plant, seconds, step=0.01, **outputs):
    """Keep the outputs named here ON and the others OFF for so long; return the switches."""
    for _ in range(round(seconds / step)):
        inputs = plant.step(step, OFF | outputs)
    return inputs


def edges(plant, steps):
    """Yield (time, switch, value) for every change of a switch in a run of (inputs, outputs)."""
    before = dict(plant.inputs)
    for inputs, _ in steps:
        for device in inputs:
            if inputs[device] != before[device]:
                yield plant.seconds, device, inputs[device]
        before = inputs


def what(plant):
    """The incidents in words."""
    return [(incident.pallet, incident.what) for incident in plant.incidents]


# ---- the way of a pallet -----------------------------------------------------------------------------------------------


def test_one_pallet_operates_the_switches_in_the_order_of_the_manual():
    plant = Conveyor(distances=(20.0,))
    story = [(device, value) for _, device, value in edges(plant, play(plant, 25))]
    assert story == [
        ("X0", 1),
        ("X0", 0),
        ("X1", 1),
        ("X2", 1),
        ("X1", 0),
        ("X3", 1),
        ("X2", 0),
        ("X4", 1),
        ("X3", 0),
        ("X4", 0),
    ]


def test_the_times_are_those_of_the_speeds_and_the_ways():
    plant = Conveyor(distances=(20.0,))
    times = {(device, value): seconds for seconds, device, value in edges(plant, play(plant, 25, step=0.001))}
    # The left belt runs at 0.3 m/s: from 1.8 m to the switch at 2.64 m.
    assert times["X0", 1] == pytest.approx(0.84 / 0.3, abs=0.003)
    # The gate (0.5 s) is open before the pallet is there (1.2 s); the belt carries it until its centre is over the lift at
    # 3.12 m, the strands at 0.6 m/s the rest of the way to 4.40 m.
    assert times["X1", 1] == pytest.approx((3.12 + 0.6 - 1.8) / 0.3 + (4.40 - 3.72) / 0.6, abs=0.005)
    assert times["X2", 1] - times["X1", 1] == pytest.approx(1.2, abs=0.003)
    assert times["X3", 1] - times["X2", 1] == pytest.approx((5.90 - 4.40) / 0.6, abs=0.006)
    # Lowered in 1.2 s, then on to 6.75 m; the switch stays pressed for the pallet's length of 1.2 m.
    assert times["X4", 1] - times["X3", 1] == pytest.approx(1.2 + (6.75 - 5.90) / 0.6, abs=0.006)
    assert times["X4", 0] - times["X4", 1] == pytest.approx(1.2 / 0.6, abs=0.003)


def test_two_pallets_go_through_and_nothing_goes_wrong():
    plant = Conveyor()
    for _ in play(plant, 60):
        if plant.delivered == 2:
            break
    assert plant.delivered == 2
    assert plant.incidents == ()


def test_a_pallet_that_waits_touches_the_one_before_it_and_still_lets_the_gate_close():
    plant = Conveyor(distances=(0.0,))
    gates = {(outputs["Y0"], plant.gate) for _, outputs in play(plant, 120)}
    assert plant.delivered >= 8
    assert plant.incidents == ()
    assert (0, 0.0) in gates
    assert (1, 1.0) in gates


def test_a_pallet_waits_at_the_shut_gate_while_the_belt_runs():
    plant = Conveyor()
    assert hold(plant, 30, Y4=1)["X0"] == 1
    assert plant.fronts[0] == conveyor.GATE
    assert plant.fronts[1] == pytest.approx(conveyor.GATE - conveyor.PALLET)
    assert plant.incidents == ()


def test_nothing_moves_without_outputs():
    plant = Conveyor()
    at_rest = plant.fronts
    assert hold(plant, 30) == {"X0": 0, "X1": 0, "X2": 0, "X3": 0, "X4": 0}
    assert plant.fronts == at_rest
    assert (plant.gate, plant.left, plant.right) == (0, 0, 0)


def test_gate_and_lifts_return_without_current():
    plant = Conveyor()
    assert hold(plant, 2, Y0=1, Y1=1, Y2=1)["X2"] == 1
    assert (plant.gate, plant.left, plant.right) == (1, 1, 1)
    assert hold(plant, 2)["X2"] == 0
    assert (plant.gate, plant.left, plant.right) == (0, 0, 0)


@pytest.mark.parametrize("valve", ["Y1", "Y2"])
def test_one_lift_alone_does_not_operate_the_switch_of_both(valve):
    assert hold(Conveyor(), 5, **{valve: 1})["X2"] == 0


def test_the_operators_switches_are_not_the_machines():
    assert set(Conveyor().step(0.01, OFF)) == {"X0", "X1", "X2", "X3", "X4"}


def test_names_fit_a_symbol_and_are_different():
    names = [point.name for point in Conveyor.wiring.values()]
    assert list(Conveyor.wiring) == [f"X{n}" for n in range(7)] + [f"Y{n}" for n in range(6)]
    assert len(set(names)) == len(names)
    assert all(len(name.encode()) <= 8 and name.isidentifier() for name in names)


# ---- what goes wrong is a fact of the machine ---------------------------------------------------------------------------


def until(plant, device, value, controller):
    """Play until a switch has this value."""
    for inputs, _ in play(plant, 100, controller=controller):
        if inputs[device] == value:
            return
    raise AssertionError(f"{device} never became {value}")


def test_a_pallet_on_gate_and_lift_tips_when_the_lift_rises():
    plant = Conveyor()
    hold(plant, 6.0, Y0=1, Y4=1)  # its front is at 3.6 m, its rear still on the belt
    hold(plant, 1.0, Y0=1, Y1=1, Y2=1, Y4=1)
    assert what(plant) == [(1, "tips")]
    assert plant.fronts[0] == pytest.approx(3.6), "a pallet that lies askew is not carried on"


def test_a_pallet_tips_between_a_raised_and_a_lowered_lift():
    plant, controller = Conveyor(), sequence()
    until(plant, "X1", 1, controller)
    hold(plant, 1.5, Y1=1)
    hold(plant, 3.0, Y1=1, Y3=1)
    assert what(plant) == [(1, "tips")]
    assert hold(plant, 10, Y1=1, Y3=1)["X3"] == 0


def test_the_rollers_move_nothing_while_the_lift_is_down():
    plant, controller = Conveyor(), sequence()
    until(plant, "X1", 1, controller)
    hold(plant, 5, Y3=1)
    place = plant.fronts[0]
    assert place < conveyor.MIDDLE
    hold(plant, 5, Y3=1, Y4=1)
    assert plant.fronts[0] == conveyor.LOW_STOP, "the stop holds it"
    assert plant.incidents == ()


def test_a_pallet_between_the_lifts_is_lowered_level_when_both_go_down_together():
    plant = Conveyor()
    next(1 for _ in play(plant, 20) if plant.fronts[0] > 5.0)
    hold(plant, 2)
    assert (plant.left, plant.right) == (0, 0)
    assert plant.fronts[0] - conveyor.PALLET < conveyor.MIDDLE < plant.fronts[0]
    assert hold(plant, 4, Y4=1, Y5=1)["X4"] == 1, "the belts take it away"
    assert plant.incidents == ()


def test_a_second_pallet_runs_into_the_first_when_the_gate_stays_open():
    plant = Conveyor(distances=(0.5,))
    hold(plant, 20, Y0=1, Y4=1)
    assert what(plant) == [(2, "runs into pallet 1")]


def test_a_pallet_runs_against_the_raised_lift():
    plant = Conveyor()
    hold(plant, 20, Y0=1, Y1=1, Y2=1, Y4=1)
    assert what(plant) == [(1, "runs against the raised left lift")]
    assert plant.fronts[0] == conveyor.LEFT_BED


def test_the_gate_cannot_close_under_a_pallet():
    plant = Conveyor()
    hold(plant, 6.0, Y0=1, Y4=1)
    hold(plant, 1.0)
    assert what(plant) == [(1, "has the gate close under it")]
    assert plant.gate == 1
    hold(plant, 5.0, Y4=1)
    assert plant.gate == 0, "the pallet has passed, the gate is free"
    assert plant.incidents[0].seconds == pytest.approx(6.0, abs=0.011)


# ---- one story at every step size -----------------------------------------------------------------------------------------

SCHEDULE = (  # (until second, outputs ON): by the clock, without looking at the switches
    (7.0, ("Y0", "Y4", "Y5")),
    (9.0, ("Y0", "Y4", "Y5")),
    (10.5, ("Y1", "Y2", "Y4", "Y5")),
    (13.5, ("Y1", "Y2", "Y3", "Y4", "Y5")),
    (14.0, ("Y4", "Y5")),
    (16.0, ("Y5",)),
    (22.0, ("Y4", "Y5")),
    (26.3, ("Y0", "Y4", "Y5")),
    (28.0, ("Y1", "Y2", "Y4", "Y5")),
    (31.0, ("Y1", "Y2", "Y3", "Y4", "Y5")),
    (42.0, ("Y4", "Y5")),
)


def by_the_clock(plant, step):
    """Run the schedule; yield (inputs, outputs)."""
    done = 0
    for end, on in SCHEDULE:
        outputs = OFF | dict.fromkeys(on, 1)
        for _ in range(round(end / step) - done):
            yield plant.step(step, outputs), outputs
        done = round(end / step)


def test_the_schedule_takes_two_pallets_through():
    plant = Conveyor()
    for _ in by_the_clock(plant, 0.01):
        pass
    assert plant.delivered == 2
    assert plant.incidents == ()


@pytest.mark.parametrize("step", [0.002, 0.01, 0.05, 0.1])
def test_a_longer_step_sees_the_same_edges_within_one_step(step):
    fine, coarse = Conveyor(), Conveyor()
    expected = sorted(edges(fine, by_the_clock(fine, 0.001)), key=lambda edge: (edge[1], edge[0]))
    found = sorted(edges(coarse, by_the_clock(coarse, step)), key=lambda edge: (edge[1], edge[0]))
    assert [edge[1:] for edge in found] == [edge[1:] for edge in expected]
    assert [edge[0] for edge in found] == pytest.approx([edge[0] for edge in expected], abs=step + 1e-5)


@pytest.mark.parametrize("step", [0.002, 0.01, 0.05, 0.1])
def test_all_step_sizes_end_in_the_same_place(step):
    fine, coarse = Conveyor(), Conveyor()
    for plant, length in ((fine, 0.001), (coarse, step)):
        for _ in by_the_clock(plant, length):
            pass
    assert coarse.fronts == pytest.approx(fine.fronts, abs=1e-5)
    assert (coarse.delivered, coarse.inputs) == (fine.delivered, fine.inputs)
    assert coarse.rollers_m == pytest.approx(fine.rollers_m, abs=1e-5)


@pytest.mark.parametrize("step", [0.001, 0.01, 0.05])
def test_the_controlled_machine_tells_the_same_story_at_every_step_size(step):
    plant = Conveyor()
    steps = [(device, value) for _, device, value in edges(plant, play(plant, 30, step)) if device != "X0"]
    cycle = [("X1", 1), ("X2", 1), ("X1", 0), ("X3", 1), ("X2", 0), ("X4", 1), ("X3", 0), ("X4", 0)]
    assert steps[:16] == cycle + cycle


# ---- a value like any other -------------------------------------------------------------------------------------------------


def test_the_same_outputs_give_the_same_run_bit_for_bit():
    one, other = Conveyor(), Conveyor()
    assert list(play(one, 40)) == list(play(other, 40))
    assert one == other


@pytest.mark.parametrize("after_s", [0.0, 3.0, 8.5, 10.0, 15.7])
def test_a_restored_machine_goes_on_as_the_first_did(after_s):
    plant, other, controller = Conveyor(), Conveyor(), sequence()
    for _ in play(plant, after_s, controller=controller):
        pass
    state = plant.state()
    first = [plant.step(0.01, BELTS | {"Y0": 1}) for _ in range(2000)]
    end = plant.state()
    other.restore(state)
    plant.restore(state)
    assert [plant.step(0.01, BELTS | {"Y0": 1}) for _ in range(2000)] == first
    assert [other.step(0.01, BELTS | {"Y0": 1}) for _ in range(2000)] == first
    assert plant.state() == other.state() == end


def test_a_copy_goes_its_own_way():
    plant = Conveyor()
    hold(plant, 5, Y4=1)
    twins = copy.copy(plant), copy.deepcopy(plant)
    before = plant.state()
    for twin in twins:
        assert twin == plant
        hold(twin, 5, Y0=1, Y4=1)
        assert twin != plant
    assert plant.state() == before


def test_what_a_step_has_returned_stays_as_it_was():
    plant = Conveyor(distances=(20.0,))
    before = plant.step(0.01, OFF)
    assert hold(plant, 5, Y4=1)["X0"] == 1
    assert before["X0"] == 0


@pytest.mark.parametrize("wrong", [{"distances": ()}, {"distances": (1.0, -0.1)}, {"first": 3.5}])
def test_pallets_that_cannot_stand_there_are_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        Conveyor(**wrong)


def test_an_output_that_the_program_does_not_have_is_named():
    with pytest.raises(KeyError, match="Y5"):
        Conveyor().step(0.01, {"Y0": 0, "Y1": 0, "Y2": 0, "Y3": 0, "Y4": 0})


# ---- faults of the machine ---------------------------------------------------------------------------------------------


UP = {"Y1": 1, "Y2": 1, "Y4": 1}


@pytest.mark.parametrize(
    ("fault", "left", "right", "up"),
    [
        ("left lift stops", 0.5, 1.0, 0),
        ("right lift stops", 1.0, 0.5, 0),
        ("right lift slow", 1.0, 0.5 + 1.2 / 4.8, 0),  # 1.2 s more at a quarter of the speed
        ("gate jams", 1.0, 1.0, 1),
    ],
)
def test_a_lift_that_fails_keeps_the_switches_from_closing(fault, left, right, up):
    plant = Conveyor()
    hold(plant, 0.6, **UP)  # halfway
    plant.fail(fault)
    switches = hold(plant, 1.2, **UP)
    assert (plant.left, plant.right, switches["X2"]) == (pytest.approx(left, abs=1e-5), pytest.approx(right, abs=1e-5), up)
    plant.fail(fault, on=False)
    assert hold(plant, 0.6, **UP)["X2"] == 1
    assert plant.incidents == ()


def test_a_jammed_gate_lets_no_pallet_in():
    plant = Conveyor(distances=(20.0,))
    plant.fail("gate jams")
    hold(plant, 10, Y0=1, Y4=1)
    assert (plant.gate, plant.fronts[0]) == (0.0, conveyor.GATE)


def test_rollers_without_drive_leave_the_pallet_on_the_left_lift():
    plant = Conveyor(distances=(20.0,))
    for inputs, _ in play(plant, 20):
        if inputs["X2"]:
            break
    plant.fail("no rollers")
    standing = plant.fronts[0], plant.rollers_m
    hold(plant, 5, Y3=1, **UP)
    assert (plant.fronts[0], plant.rollers_m) == standing
    plant.fail("no rollers", on=False)
    hold(plant, 1, Y3=1, **UP)
    assert plant.fronts[0] == pytest.approx(standing[0] + conveyor.FAST)


def test_a_pallet_that_sticks_holds_up_the_next_one():
    plant = Conveyor(distances=(0.5,), first=1.8)
    plant.fail("pallet sticks")
    hold(plant, 10, Y0=1, Y4=1)
    assert plant.fronts[:2] == (1.8, pytest.approx(1.8 - conveyor.PALLET))
    plant.fail("pallet sticks", on=False)
    hold(plant, 2, Y4=1)
    assert plant.fronts[:2] == (pytest.approx(1.8 + 2 * conveyor.SLOW), pytest.approx(1.8 + 2 * conveyor.SLOW - conveyor.PALLET))


def test_without_pallets_the_line_runs_empty():
    plant = Conveyor()
    plant.fail("no pallets")
    for _ in play(plant, 60):
        pass
    assert plant.seconds == pytest.approx(60)
    assert plant.fronts[0] - conveyor.PALLET > conveyor.DEPARTURE
    assert len(plant.fronts) == 1


@pytest.mark.parametrize("fault", Conveyor.FAULTS)
def test_the_length_of_the_steps_changes_nothing_in_a_fault(fault):
    stories = []
    for step in (0.01, 0.37):
        plant, outputs = Conveyor(), BELTS | {"Y0": 1, "Y1": 1, "Y3": 1}
        for _ in range(round(3.7 / step)):
            plant.step(step, outputs)
        plant.fail(fault)
        for _ in range(round(7.4 / step)):
            plant.step(step, outputs)
        plant.fail(fault, on=False)
        for _ in range(round(7.4 / step)):
            plant.step(step, outputs)
        stories.append((plant.fronts, plant.left, plant.gate, plant.delivered, plant.inputs, plant.incidents))
    assert stories[0][2:5] == stories[1][2:5]
    assert stories[0][0] == pytest.approx(stories[1][0])
    assert stories[0][1] == pytest.approx(stories[1][1])
    assert [incident.what for incident in stories[0][5]] == [incident.what for incident in stories[1][5]]
