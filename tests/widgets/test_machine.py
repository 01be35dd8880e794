"""The machine's panel: which sensors and faults it offers, what it tells of them, and what it does."""

import pytest
from ecsim_widgets.machine import Machine

from ecsim.errors import EcsimError


@pytest.fixture
def machine(make_rig, shuttle, picture):
    """The panel of a shuttle that can jam."""
    shuttle.FAULTS = {"jams": "the part does not move"}
    shuttle.faults = frozenset()
    shuttle.fail = lambda fault, on=True: setattr(shuttle, "faults", frozenset({fault}) if on else frozenset())
    return Machine(make_rig(shuttle, picture=picture))


def test_it_offers_the_sensors_and_faults_that_the_machine_has(machine):
    layout = machine.layout()
    assert layout["sensors"] == [{"device": "X0", "name": "There", "what": "the part is there"}]
    assert layout["faults"] == [{"name": "jams", "what": "the part does not move"}]
    assert layout["times"] == [{"kind": "delayed", "unit": "s", "usual": 0.5}, {"kind": "bounces", "unit": "ms", "usual": 30}]


def test_it_tells_what_the_sensor_says_and_what_comes_of_it(machine):
    assert machine.frame()["sensor.X0"] == {"says": 0, "comes": 0, "wrong": None}
    assert machine.receive("fail", {"fault": "X0 inverted"}) == ""
    assert machine.frame()["sensor.X0"] == {"says": 0, "comes": 1, "wrong": {"kind": "inverted", "amount": 0.0, "words": "inverted"}}
    machine.receive("fail", {"fault": "X0 delayed 0.25"})
    assert machine.frame()["sensor.X0"]["wrong"]["words"] == "delayed by 0.25 s"
    machine.receive("mend", {"fault": "X0"})
    assert machine.frame()["sensor.X0"] == {"says": 0, "comes": 0, "wrong": None}


def test_the_machines_own_faults_go_in_and_out(machine):
    machine.receive("fail", {"fault": "jams"})
    machine.receive("fail", {"fault": "X0 stuck 1"})
    assert machine.frame()["faults"] == ["jams"]
    machine.receive("mend", {"fault": "jams"})
    assert machine.frame()["faults"] == []
    machine.receive("fail", {"fault": "jams"})
    machine.receive("mend", {"fault": "all"})
    assert (machine.frame()["faults"], machine.frame()["sensor.X0"]["wrong"]) == ([], None)


def test_what_is_refused_is_told_on_the_plate(machine):
    assert "0.001 to 600" in machine.receive("fail", {"fault": "X0 delayed 0"})
    assert "level" in machine.receive("fail", {"fault": "X0 stuck x"})
    assert machine.frame()["sensor.X0"]["wrong"] is None


def test_a_control_that_takes_an_input_over_shows_as_a_stuck_sensor(machine):
    machine.rig.put("X0", 1)
    assert machine.frame()["sensor.X0"] == {"says": 0, "comes": 1, "wrong": {"kind": "stuck", "amount": 1.0, "words": "stuck at 1"}}
    assert machine.rig.by("X0") == "stuck"
    machine.rig.free("X0")
    assert machine.rig.by("X0") == "machine"


def test_a_key_of_the_drawing_is_a_finger_on_the_machine(machine, shuttle):
    held = []
    shuttle.hold, shuttle.release = held.append, held.remove
    assert machine.receive("press", {"key": "start"}) == ""
    assert held == ["start"]
    assert machine.receive("release", {"key": "start"}) == ""
    assert held == []


def test_a_key_that_is_not_there_is_told(machine, shuttle):
    assert machine.receive("press", {"key": "start"}) == "this machine has no keys"

    def hold(key):
        raise EcsimError(f"no key {key}")

    shuttle.hold = hold
    assert machine.receive("press", {"key": "horn"}) == "no key horn"
