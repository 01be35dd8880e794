"""The unit's face: what the hand does reaches the terminal, what the program sees reaches the lamp."""

import pytest
from ecsim_widgets.unit import Unit


def test_the_points_have_the_programs_names_and_the_controls_they_are_given(make_rig):
    layout = Unit(make_rig(controls={"X5": "push"})).layout()
    x5 = layout["inputs"][5]
    assert x5 == {"device": "X5", "name": "Start", "what": "start button", "control": "push"}
    assert layout["outputs"][0]["name"] == "Lamp"
    assert [point["device"] for point in layout["inputs"]][7:10] == ["X7", "X10", "X11"]  # octal
    assert (len(layout["inputs"]), len(layout["outputs"])) == (16, 12)


def test_a_program_with_more_points_gets_a_larger_unit(make_rig):
    layout = Unit(make_rig(program="LD X23\nOUT Y15")).layout()
    assert layout["inputs"][-1]["device"] == "X27"
    assert layout["outputs"][-1]["device"] == "Y17"


def test_a_switch_puts_its_level_on_the_terminal(rig):
    unit = Unit(rig)
    unit.receive("set", {"device": "X0", "on": 1})
    assert (unit.frame()["X0"], unit.frame()["X0.seen"]) == (1, 0)  # the program has not looked yet
    rig.session.scan()
    assert unit.frame()["X0.seen"] == 1


def test_a_lamp_follows_its_output(rig):
    unit = Unit(rig)
    unit.receive("press", {"device": "X5"})
    rig.session.scan()
    assert unit.frame()["Y0"] == 1


def test_a_short_press_is_seen_by_one_scan_at_least(rig):
    unit = Unit(rig)
    unit.receive("press", {"device": "X5"})
    unit.receive("release", {"device": "X5"})
    rig.session.scan()
    assert unit.frame()["X5.seen"] == 1
    rig.session.scan(2)
    assert (unit.frame()["X5"], unit.frame()["X5.seen"]) == (0, 0)


def test_an_output_that_was_on_for_one_scan_has_pulsed(rig):
    unit = Unit(rig)
    unit.pulsed()
    unit.receive("set", {"device": "X5", "on": 1})
    rig.session.scan(3)  # Y1 is on in the first of them
    assert unit.frame()["Y1"] == 0
    assert unit.pulsed() == ["Y1"]
    assert unit.pulsed() == []


def test_the_machine_drives_its_sensors_and_the_hand_the_rest(make_rig, shuttle):
    frame = Unit(make_rig(shuttle)).frame()
    assert (frame["X0.by"], frame["X5.by"]) == ("machine", "hand")


def test_a_driven_input_can_be_taken_over_and_given_back(make_rig, shuttle):
    rig = make_rig(shuttle)
    unit = Unit(rig)
    unit.receive("set", {"device": "X0", "on": 1})
    rig.session.scan(2)
    assert (unit.frame()["X0"], unit.frame()["X0.by"]) == (1, "stuck")
    unit.receive("free", {"device": "X0"})
    assert (unit.frame()["X0"], unit.frame()["X0.by"]) == (0, "machine")


def test_without_the_machine_all_inputs_are_the_hands(make_rig, shuttle):
    rig = make_rig(shuttle)
    unit = Unit(rig)
    rig.connect(False)
    unit.receive("set", {"device": "X0", "on": 1})
    rig.session.scan(5)
    assert (unit.frame()["X0"], unit.frame()["X0.by"]) == (1, "hand")


def test_forcing_a_point_and_releasing_it(rig):
    unit = Unit(rig)
    unit.receive("look", {"plate": "p", "device": "Y3"})
    unit.receive("force", {"plate": "p", "n": 1, "text": "1"})
    rig.session.scan()
    assert (unit.frame()["Y3"], unit.frame()["Y3.forced"], unit.frame()["plate.p"]["forced"]) == (1, 1, "1")
    unit.receive("unforce", {"plate": "p", "n": 2})
    rig.session.scan()
    assert "Y3.forced" not in unit.frame()


def test_the_mode_switch_stops_and_runs_the_unit(rig):
    unit = Unit(rig)
    assert (unit.frame()["RUN"], unit.frame()["switch"]) == ("on", "ON")
    unit.receive("mode", {"mode": "TM"})
    assert (unit.frame()["RUN"], unit.frame()["switch"]) == ("on", "TM")  # TM changes nothing by itself (2.3.2)
    unit.receive("mode", {"mode": "OFF"})
    assert (unit.frame()["RUN"], unit.frame()["switch"]) == ("off", "OFF")
    unit.receive("mode", {"mode": "ON"})
    assert unit.frame()["RUN"] == "on"


def test_the_lamps_are_those_of_the_machine(rig):
    unit = Unit(rig)
    assert (unit.frame()["ERR"], unit.frame()["BAT"]) == ("off", "off")
    rig.plc.battery = "failing"
    assert unit.frame()["BAT"] == "on"
    rig.plc.power_off()
    assert {unit.frame()[lamp] for lamp in ("RUN", "ERR", "BAT")} == {"off"}


def test_the_potentiometers_are_turned(rig):
    unit = Unit(rig)
    assert unit.layout()["pots"] == 2  # 2.1.1
    unit.receive("pot", {"number": 1, "value": 40})
    assert (rig.plc.pots[1], unit.frame()["pot0"], unit.frame()["pot1"]) == (40, 0, 40)
    unit.receive("pot", {"number": 1, "value": 256})
    assert "256" in rig.run()["refused"]
    assert unit.frame()["pot1"] == 40


@pytest.mark.parametrize(
    ("verb", "values"),
    [("set", {"device": "Y0", "on": 1}), ("set", {"device": "X400", "on": 1}), ("explode", {})],
)
def test_what_the_unit_has_not_is_refused(rig, verb, values):
    with pytest.raises(ValueError, match=r"no|knows"):
        Unit(rig).receive(verb, values)


def test_what_the_plc_refuses_is_told_and_ends_nothing(rig):
    rig.post(lambda plc: plc.force("D9999", 1))
    assert "D9999" in rig.run()["refused"]
    rig.post(lambda plc: plc.force("D0", 1))
    assert rig.run()["refused"] == ""
