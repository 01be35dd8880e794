"""The table on a screw and its servo amplifier, under the positioning instructions (manual 6.17)."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.axis import PICTURE, Axis, ServoAmplifier
from ecsim_exercises.plant import Moment

from ecsim import EcsimError, Plc
from ecsim.session import Session

# The functions of 6.17.12: read the position at the start, jog both ways, return to the origin, go to two places, stop.
# X0 stop, X1 origin, X2 jog forward, X4 jog back, X5 to 200 mm, X13 to 50 mm
PROGRAM = """
LD SM1
SET SM85
DMOV 20000 SD85
MOV 500 SD84
MOV 100 SD87
LD SM0
ABS X10 Y10 D100
LD X12
ANI Y11
LDI M20
ANB
DMOV D100 SD80
SET M20
LD X0
OUT SM80
LD X2
ANI X0
AND X6
PLSV 2000 Y0 Y4
LD X4
ANI X0
AND X7
PLSV -2000 Y0 Y4
LD X1
ANI X0
RST Y4
ZRN 5000 500 X3 Y0
LD X5
ANI X0
DRVA 20000 10000 Y0 Y4
LD X13
ANI X0
DRVA 5000 10000 Y0 Y4
"""


class Bench:
    """A machine with both plants on it, run scan by scan."""

    def __init__(self, **axis):
        self.axis = Axis(**axis)
        self.servo = ServoAmplifier(round(self.axis.position * self.axis.pulses_per_mm))
        self.plc = Plc("EC10", scan_ms=1, input_filter_ms=0)
        self.plc.load(PROGRAM)
        self.plc.run()
        self.sent = 0

    def run(self, scans):
        for _ in range(scans):
            plc = self.plc
            sent = plc["SD50:DINT"]
            plc.set(self.axis.step(0.001, {"Y0": sent - self.sent, "Y4": plc["Y4"]}))
            plc.set(self.servo.step(0.001, {name: plc[name] for name in ("Y10", "Y11", "Y12")}))
            self.sent = sent
            plc.scan()

    def press(self, name, scans):
        self.plc[name] = 1
        self.run(scans)
        self.plc[name] = 0
        self.run(150)


@pytest.fixture
def bench():
    bench = Bench()
    bench.run(60)
    return bench


def test_the_position_is_read_from_the_amplifier(bench):
    assert bench.plc["SD80:DINT"] == 12_000
    assert bench.plc["Y10"] == 1
    assert bench.plc["Y11"] == 0


def test_it_goes_to_places_and_the_registers_follow(bench):
    for button, place in (("X5", 200.0), ("X13", 50.0)):
        bench.press(button, 3000)
        assert bench.axis.position == pytest.approx(place)
        assert bench.plc["SD80:DINT"] == place * 100
        assert bench.plc["SM82"] == 0


def test_it_jogs_while_the_button_is_held(bench):
    bench.press("X2", 500)  # 2000 Hz for half a second: 10 mm
    assert bench.axis.position == pytest.approx(130.0, abs=0.05)
    bench.press("X4", 1000)
    assert bench.axis.position == pytest.approx(110.0, abs=0.1)


def test_a_limit_switch_ends_the_jog(bench):
    bench.press("X2", 20_000)
    assert bench.axis.position == pytest.approx(400.0, abs=0.1)
    assert bench.axis.missed == 0


def test_the_return_ends_at_the_near_point_switch(bench):
    bench.press("X1", 8000)
    assert bench.axis.position == pytest.approx(0.0, abs=0.05)
    assert bench.plc["SD80:DINT"] == 0
    assert bench.plc["SM82"] == 0


def test_the_stop_button_ends_every_movement(bench):
    bench.plc["X5"] = 1
    bench.run(300)
    bench.plc["X0"] = 1
    bench.run(2)
    place = bench.axis.position
    assert 120 < place < 200
    bench.run(500)
    assert bench.axis.position == place


def test_backlash_is_lost_at_each_turn():
    bench = Bench(backlash=0.5)
    bench.run(60)
    bench.press("X5", 3000)
    assert bench.axis.position == pytest.approx(199.5)
    bench.press("X13", 3000)
    assert bench.axis.position == pytest.approx(50.0)


@pytest.mark.parametrize(("fault", "code"), [("silent", 79), ("garbled", 80)])
def test_an_amplifier_at_fault_is_reported(fault, code):
    bench = Bench()
    setattr(bench.servo, fault, True)
    bench.run(6000)
    assert bench.plc["SD20"] == code
    assert bench.plc["SD80:DINT"] == 0


def test_pulses_against_the_stop_are_missed():
    axis = Axis(position=395.0)
    assert axis.step(1, {"Y0": 1000, "Y4": 1}) == {"X3": 0, "X6": 0, "X7": 1}
    axis.step(1, {"Y0": 1000, "Y4": 1})
    assert axis.position == 410.0
    assert axis.missed == 500


def test_in_a_session_the_plant_gets_the_pulses_and_a_step_back_takes_them_back():
    plc = Plc("EC10", scan_ms=1, input_filter_ms=0)
    plc.load("LD SM0\nPLSV 2000 Y0 Y4")
    plc.run()
    session = Session(plc, Axis(), name="axis")
    session.scan(250)
    assert session.plant.position == pytest.approx(125.0)
    place = session.plant.position
    session.scan(40)
    for _ in range(40):
        session.back()
    assert session.plant.position == pytest.approx(place)
    session.scan(50)
    assert session.plant.position == pytest.approx(126.0)


def test_the_stop_is_told_once_for_each_time_it_is_reached():
    axis = Axis(position=405.0)
    for forward in (1, 1, 0, 1):  # 10 mm each: 5 are free
        axis.step(0.1, {"Y0": 1000, "Y4": forward})
    assert [(one.seconds, one.what) for one in axis.incidents] == [(0.1, "the table runs against its stop")]
    assert axis.missed == 500 + 1000
    axis.step(0.1, {"Y0": 100, "Y4": 1})
    assert axis.missed == 1600
    assert [one.seconds for one in axis.incidents] == [0.1, 0.5]


def test_a_slipping_coupling_loses_a_quarter_of_the_way():
    axis = Axis(position=100.0)
    axis.fail("coupling slips")
    axis.step(0.1, {"Y0": 1000, "Y4": 1})
    assert axis.position == 107.5
    assert axis.speed == 100.0  # of the motor
    axis.fail("coupling slips", on=False)
    axis.step(0.1, {"Y0": 1000, "Y4": 1})
    assert axis.position == 117.5


@pytest.mark.parametrize(("wire", "switch"), [("front wire", "X6"), ("rear wire", "X7")])
def test_a_broken_wire_is_a_limit_switch_that_acts(wire, switch):
    axis = Axis()
    right = {"X3": 0, "X6": 1, "X7": 1}
    assert axis.step(0.01, {"Y0": 0, "Y4": 0}) == right
    axis.fail(wire)
    assert axis.step(0.01, {"Y0": 0, "Y4": 0}) == right | {switch: 0}
    axis.fail(wire, on=False)
    assert axis.step(0.01, {"Y0": 0, "Y4": 0}) == right


def test_a_fault_that_it_does_not_have_is_refused():
    with pytest.raises(EcsimError, match="no fault 'rust'; it has coupling slips, front wire, rear wire"):
        Axis().fail("rust")


def test_a_hand_can_turn_the_screw():
    axis = Axis(position=-25.0)
    assert axis.step(0.01, {"Y0": 0, "Y4": 0})["X7"] == 0
    axis.stand_at(7.0)
    assert axis.step(0.01, {"Y0": 0, "Y4": 0}) == {"X3": 1, "X6": 1, "X7": 1}


def test_the_way_back_takes_faults_and_place_along():
    axis = Axis()
    before = axis.state()
    axis.fail("front wire")
    axis.step(0.1, {"Y0": 1000, "Y4": 1})
    assert axis.position == 130.0
    axis.restore(before)
    assert (axis.position, axis.faults, axis.speed) == (120.0, frozenset(), 0.0)
    assert axis.step(0.1, {"Y0": 0, "Y4": 0}) == {"X3": 0, "X6": 1, "X7": 1}


def shown(axis, pulses=0, forward=0, **lamps):
    outputs = {"Y0": pulses, "Y4": forward, "Y5": 0, "Y6": 0, **lamps}
    return PICTURE.state(Moment(axis, {"X0": 1, "X1": 0, "X2": 0, "X4": 0, **axis.step(0.1, outputs)}, outputs))


def lit(state):
    return {key.rsplit(":", 1)[0] for key, value in state.items() if key.endswith(":class") and value.split()[-1:] == ["on"]}


def moved(state, part):
    return tuple(map(float, re.match(r"translate\(([-\d.]+)[ ,]([-\d.]+)\)", state[f"{part}:transform"]).groups()))


def test_every_entry_of_the_picture_has_its_element():
    ids = {element.get("id") for element in xml.fromstring(PICTURE.svg("p-")).iter()}
    assert [key for key in shown(Axis()) if "p-" + key.rsplit(":", 1)[0] not in ids] == []


def test_every_point_has_its_tag():
    tags = {element.get("data-device") for element in xml.fromstring(PICTURE.svg()).iter()} - {None}
    assert tags == set(Axis.wiring)


def test_the_table_travels_and_the_coupling_turns_with_it():
    state = shown(Axis(position=100.0), 250, 1)  # 2.5 mm further: a quarter of a turn of 10 mm
    assert moved(state, "table") == (123.0, 0.0)  # 1.2 px a millimetre
    assert state["coupling:transform"].startswith("rotate(90 ")
    assert state["words:text"] == "102.5 mm, 25 mm/s"


def test_movement_lamps_and_switches_are_lit():
    assert lit(shown(Axis(position=100.0), 1000, 1, Y5=1)) == {"X0", "X6", "X6-switch", "X7", "X7-switch", "Y0", "motor", "go-forward",
                                                              "Y4", "Y5", "Y5-lamp"}  # fmt: skip
    state = lit(shown(Axis(position=12.0), 50))
    assert {"go-back", "motor", "X3", "X3-switch"} <= state
    assert state & {"go-forward", "Y4", "Y5", "amiss"} == set()
    assert lit(shown(Axis(position=50.0), Y5=1, Y6=1)) & {"Y0", "motor", "go-back", "Y6", "Y6-lamp"} == {"Y6", "Y6-lamp"}


def test_what_went_wrong_is_told():
    state = shown(Axis(position=-29.5), 80)  # 0.8 mm, of which 0.5 are free
    assert "amiss" in lit(state)
    assert state["amiss-text:text"] == "30 pulses against the stop"


def test_nothing_stands_outside_the_frame():
    for element in xml.fromstring(PICTURE.svg()).iter():
        for name, most in (("x", 720), ("cx", 720), ("y", 330), ("cy", 330)):
            assert 0 <= float(element.get(name, 0)) <= most
    for position in (-30, 410):  # the table, 72 px wide round 150 at 0 mm
        assert 0 <= 150 + 1.2 * position - 36 <= 150 + 1.2 * position + 36 <= 720
