"""The sample solution on the machine, and on the test trace of 7.5.1 with the switches flipped by hand."""

import pytest
from ecsim_exercises.conveyor import SOLUTION, Conveyor

import ecsim

OUTPUTS = tuple(f"Y{n}" for n in range(6))
STEPS = ("S0", "S20", "S21", "S22", "S23")


@pytest.fixture
def plc():
    plc = ecsim.Plc("EC20")
    plc.load(SOLUTION.read_text(encoding="utf-8"))
    plc.run()
    return plc


def active(plc):
    return [step for step in STEPS if plc[step]]


def press(plc, switch):
    """Press and release, long enough for the input filter."""
    plc[switch] = 1
    plc.scan(5)
    plc[switch] = 0
    plc.scan(5)


def play(plc, plant, seconds):
    """Let PLC and machine run; yield after every scan."""
    for _ in range(round(seconds * 100)):
        for switch, value in plant.step(0.01, {output: plc[output] for output in OUTPUTS}).items():
            plc[switch] = value
        plc.scan()
        yield


def started(plc):
    plant = Conveyor()
    press(plc, "X5")
    return plant


def test_it_fits_and_keeps_the_names_of_the_wiring():
    program = ecsim.compile(SOLUTION.read_text(encoding="utf-8"), "EC20")
    assert program.steps < 200
    declared = {str(variable.device): variable.name for variable in program.variables.values()}
    assert {device: declared[device] for device in Conveyor.wiring} == {device: point.name for device, point in Conveyor.wiring.items()}


def test_each_network_says_what_it_is_for():
    program = ecsim.compile(SOLUTION.read_text(encoding="utf-8"), "EC20")
    assert [network.number for unit in program.units for network in unit.networks if not network.title] == []


@pytest.mark.parametrize("model", ["EC10", "EC20"])
def test_eight_pallets_fill_two_lorries(model):
    plc = ecsim.Plc(model)
    plc.load(SOLUTION.read_text(encoding="utf-8"))
    plc.run()
    plant = started(plc)
    for _ in play(plc, plant, 150):
        if plant.delivered == 8:
            break
    assert plant.delivered == 8
    assert plant.incidents == ()
    assert (plc["C0"], plc["D0"]) == (0, 2)
    assert plc.errors == []


def test_what_must_never_happen_does_not(plc):
    plant = started(plc)
    under_way = over = False
    rollers_without_lift = 0
    for _ in play(plc, plant, 60):
        assert len(active(plc)) <= 1
        under_way, over = (under_way or bool(plc["X1"])) and not (over and not plc["X4"]), bool(plc["X4"])
        assert not (under_way and plc["Y0"] and not plc["S21"]), "the gate opens while a pallet is under way"
        rollers_without_lift = rollers_without_lift + 1 if plc["Y3"] and not plc["X2"] else 0
        assert rollers_without_lift <= 2, "rollers turn while the lifts are not up"
    assert plant.delivered >= 3


def test_nothing_moves_before_the_start(plc):
    plant = Conveyor()
    for _ in play(plc, plant, 10):
        assert not any(plc[output] for output in OUTPUTS)
    assert active(plc) == []
    assert plant.fronts == Conveyor().fronts


def test_the_trace_by_hand(plc):
    def outputs():
        plc.scan(5)
        return "".join(str(plc[output]) for output in OUTPUTS)

    press(plc, "X5")
    assert outputs() == "000011"
    plc["X0"] = 1
    assert outputs() == "100011"
    plc["X1"], plc["X0"] = 1, 0
    assert outputs() == "011011"
    plc["X2"] = 1
    assert outputs() == "011111"
    plc["X3"] = 1
    assert outputs() == "000011"
    plc["X0"], plc["X1"], plc["X2"], plc["X3"] = 1, 0, 0, 0
    assert outputs() == "000011"
    plc["X4"] = 1
    assert outputs() == "000011"
    plc["X4"] = 0
    assert outputs() == "100011"
    assert plc["C0"] == 1


@pytest.mark.parametrize("second", range(1, 17, 3))
def test_the_emergency_switch_stops_everything_until_start_is_pressed_again(plc, second):
    plant = started(plc)
    for _ in play(plc, plant, second):
        pass
    plc["X5"] = 1  # a start switch that stays on does not start again by itself
    plc["X6"] = 1
    plc.scan(5)
    assert not any(plc[output] for output in OUTPUTS)
    assert active(plc) == []
    plc["X6"] = 0
    plc.scan(5)
    assert not any(plc[output] for output in OUTPUTS)
    plc["X5"] = 0
    plc.scan(5)
    press(plc, "X5")
    assert active(plc) == ["S0"] or plc["X0"]
    assert (plc["Y4"], plc["Y5"]) == (1, 1)


def test_an_emergency_over_the_last_switch_does_not_cut_the_next_cycle_short(plc):
    press(plc, "X5")
    for switch in ("X0", "X1", "X2", "X3", "X4"):
        plc[switch] = 1
        plc.scan(5)
        plc[switch] = int(switch == "X4")
    press(plc, "X6")
    plc["X4"] = 0
    plc.scan(5)
    press(plc, "X5")
    for switch in ("X0", "X1", "X2", "X3"):
        press(plc, switch)
    assert active(plc) == ["S23"]


def test_a_lift_that_needs_longer_than_three_seconds_is_reported(plc):
    press(plc, "X5")
    press(plc, "X0")
    press(plc, "X1")
    plc.advance(ms=2800)
    assert (active(plc), plc["M2"]) == (["S21"], 0)
    plc.advance(ms=400)
    assert plc["M2"] == 1
    press(plc, "X2")
    assert (active(plc), plc["M2"], plc["T0"]) == (["S22"], 0, 0)
