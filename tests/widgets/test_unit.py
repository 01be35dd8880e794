"""The unit's face: what the hand does reaches the terminal, what the program sees reaches the lamp."""

import pytest
from ecsim_widgets.rig import Rig
from ecsim_widgets.unit import Unit

from ecsim.plc import Plc
from ecsim.session import Session

from .conftest import Point


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


# -- analog terminals ----------------------------------------------------------------------------------------------


class Tank:
    """A plant that tells a level in volts and is given a valve's voltage."""

    def __init__(self):
        self.wiring = {"AI0.2:V": Point("Level", "level of the tank"), "AO1.0:V": Point("Valve", "inlet valve")}

    def step(self, seconds, outputs):
        return {"AI0.2:V": 3.25 + outputs["AO1.0:V"]}


@pytest.fixture
def analog():
    """The unit of an EC20 with a 4AD, a 4DA and a 4PT; the program gives 2500 to the first output."""

    def make(plant=None, program="LD SM0\nMOV 2500 D0\nTO 1 0 D0 1"):
        plc = Plc("EC20", scan_ms=10, io=[(24, 16), "4AD", "4DA", "4PT"])
        plc.load(program)
        session = Session(plc, plant=plant, name="test")
        plc.run()
        return Unit(Rig(plc, session))

    return make


def test_each_analog_channel_has_its_terminal_its_module_and_its_range(analog):
    unit = analog(Tank())
    rows = {row["device"]: row for row in unit.layout()["analog"]}
    assert list(rows) == [f"A{sense}{place}.{number}" for sense, place in (("I", 0), ("O", 1), ("I", 2)) for number in range(4)]
    assert rows["AI0.2"] == {"device": "AI0.2", "name": "Level", "what": "level of the tank", "module": "4AD 0"}
    frame = unit.frame()
    assert frame["AI0.0"] == [None, "V", [-10, 10], "hand"]  # docs/modules.md: mode 0 of a 4AD is -10 to 10 V
    assert frame["AI2.3"] == [None, "C", [-150, 600], "hand"]  # and of a 4PT a Pt100


def test_a_signal_reaches_the_terminal_and_none_takes_it_off(analog):
    unit = analog()
    assert unit.receive("signal", {"name": "AI0.1:V", "text": "-2.5"}) == ""
    unit.rig.session.scan(2)
    assert (unit.frame()["AI0.1"][0], unit.rig.plc["AI0.1:V"]) == (-2.5, -2.5)
    assert unit.receive("signal", {"name": "AI0.1:V", "text": ""}) == ""
    unit.rig.session.scan()
    assert unit.frame()["AI0.1"][0] is None


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("AI0.1:V", "two", "'two' is no number"),
        ("AO1.0:V", "1", "AO1.0:V is an output"),
        ("AI0.9:V", "1", "no channel 9"),
        ("AI2.0:V", "1", "a 4PT has no input for volts"),
    ],
)
def test_a_signal_that_cannot_be_is_refused_in_words(analog, name, text, words):
    unit = analog()
    assert words in unit.receive("signal", {"name": name, "text": text})
    unit.rig.session.scan()
    assert unit.frame()["AI0.1"][0] is None


def test_an_output_shows_what_it_gives(analog):
    unit = analog()
    unit.rig.session.scan(2)
    assert unit.frame()["AO1.0"][:2] == [2.5, "V"]  # 2500 of 10000 is a quarter of 10 V


def test_a_signal_of_the_machine_is_taken_over_and_given_back(analog):
    unit = analog(Tank())
    unit.rig.session.scan(3)
    assert unit.frame()["AI0.2"] == [5.75, "V", [-10, 10], "machine"]
    assert "driven by the machine" in unit.receive("signal", {"name": "AI0.2:V", "text": ""})
    assert unit.receive("signal", {"name": "AI0.2:V", "text": "-1.5"}) == ""
    unit.rig.session.scan(2)
    assert unit.frame()["AI0.2"] == [-1.5, "V", [-10, 10], "stuck"]
    unit.receive("free_signal", {"name": "AI0.2:V"})
    unit.rig.session.scan()
    assert unit.frame()["AI0.2"] == [5.75, "V", [-10, 10], "machine"]


def test_the_unit_and_the_range_follow_the_mode_and_a_module_may_go(analog):
    unit = analog(program="LD SM0\nMOV 2 D0\nMOV -1 D1\nTO 0 12 D0 2")  # buffers 12 to 15 are the modes: 2 is -20 to 20 mA, -1 off
    unit.rig.session.scan(2)
    assert unit.frame()["AI0.0"][1:3] == ["mA", [-20, 20]]
    assert unit.frame()["AI0.1"][1:3] == ["V", None]
    unit.rig.plc.modules[2].remove()
    assert unit.frame()["AI2.0"] is None


@pytest.mark.parametrize(
    ("program", "io", "there"),
    [
        ("LD X0\nOUT Y0", None, []),
        ("LD SM0\nOUT SM172", None, ["AI0", "AI1", "AO0"]),
        ("LD SM0\nMOV D0 SD178", None, ["AI0", "AI1", "AO0"]),
        ("LD X0\nOUT Y0", (16, 14), ["AI0", "AI1", "AO0"]),
        ("LD X0\nOUT Y0", (24, 16), []),
    ],
)
def test_an_ec10_shows_its_own_channels_where_they_are_used_or_the_base_unit_has_them(program, io, there):
    plc = Plc("EC10", io=io)
    plc.load(program)
    assert [row["device"] for row in Unit(Rig(plc, Session(plc))).layout()["analog"]] == there


def test_a_channel_of_the_ec10_measures_what_its_relays_choose():
    plc = Plc("EC10", scan_ms=10)
    plc.load("LD SM0\nOUT SM172\nLD SM0\nOUT SM174\nLD SM0\nOUT SM178")
    unit = Unit(Rig(plc, Session(plc)))
    assert unit.frame()["AI0"][2] is None  # not enabled yet
    plc.run()
    plc.scan(2)
    assert unit.frame()["AI0"][1:3] == ["mA", [-20, 20]]
    assert unit.frame()["AI1"][1:3] == ["V", None]
    assert unit.frame()["AO0"] == [0.0, "V", [-10, 10], "hand"]
