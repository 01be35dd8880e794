"""The table on a screw and its servo amplifier, under the positioning instructions (manual 6.17)."""

import pytest
from ecsim_exercises.axis import Axis, ServoAmplifier

from ecsim import Plc
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
