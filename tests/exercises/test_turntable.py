"""The turntable and the cam shaft: how they move and what their switches say, and an H2U that leads them (FNC 62, 63, 68)."""

import re
import xml.etree.ElementTree as xml

import pytest
from ecsim_exercises.plant import Moment
from ecsim_exercises.turntable import PICTURE, SHAFT_PICTURE, CamShaft, Turntable

from ecsim import EcsimError, Plc
from ecsim.session import Session

OUTPUTS = ("FwdFast", "FwdSlow", "Brake", "BackSlow", "BackFast")


def outputs(names):
    return {f"Y{place}": int(name in names.split()) for place, name in enumerate(OUTPUTS)}


def run(machine, *phases, length=None):
    """Let a table go through (seconds, outputs that are ON); gives what its switches say then."""
    said = {}
    for seconds, names in phases:
        left = seconds
        while left > 1e-9:
            said = machine.step(min(length or seconds, left), outputs(names))
            left -= length or seconds
    return said


def turning(program, machine):
    """An H2U with a program and a machine, in RUN."""
    plc = Plc("H2U")
    plc.load(program)
    session = Session(plc, machine, speed=None, name="turning")
    plc.run()
    return plc, session


def wait(session, seconds):
    """Scan for so many seconds of simulated time."""
    end = session.plc.clock[0] + seconds * 1e6
    while session.plc.clock[0] < end:
        session.scan(10)


# -- the table by itself --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_it_gains_and_loses_speed_evenly(length):
    table = Turntable()
    run(table, (0.25, "FwdFast"), length=length)
    assert (table.speed, table.turned) == (pytest.approx(0.5), pytest.approx(0.0625))  # 2 places a second, each second
    run(table, (0.25, "FwdFast"), (1.0, "FwdFast"), length=length)
    assert (table.speed, table.turned) == (pytest.approx(1.0), pytest.approx(1.25))
    run(table, (1.0, ""), length=length)  # it runs out over 1 / (2 * 2) of a place
    assert (table.speed, table.turned) == (0.0, pytest.approx(1.5))
    run(table, (0.5, "BackFast"), (0.1, "Brake"), length=length)  # and is stopped within 1 / (2 * 10)
    assert (table.speed, table.turned) == (0.0, pytest.approx(1.5 - 0.25 - 0.05))


def test_it_goes_through_standstill_to_the_other_way_and_round_its_zero():
    table = Turntable()
    run(table, (0.5, "FwdFast"), (0.5, "BackFast"))
    assert (table.speed, table.turned) == (0.0, pytest.approx(0.5))
    run(table, (0.5, "BackFast"), (1.0, "BackFast"))
    assert table.turned == pytest.approx(9.25)
    assert table.travelled == pytest.approx(-0.75)


@pytest.mark.parametrize(("way", "seen"), [("FwdSlow", ([1] * 20, [0] * 19)), ("BackSlow", ([0] * 19, [1] * 20))])
def test_b_rises_while_a_is_on_forward_and_falls_so_backward(way, seen):
    table = Turntable()
    before = run(table, (0.1, way))
    rises, falls = [], []
    for _ in range(1980):
        now = run(table, (0.005, way))
        if now["X1"] != before["X1"]:
            (rises if now["X1"] else falls).append(now["X0"])
        before = now
    assert (rises, falls) == seen  # 10 s at 0.2 places a second, less 0.01 for the start, are 19.9 pulses


@pytest.mark.parametrize("pulses", [1, 10])
def test_the_zero_switch_is_on_for_half_a_pulse(pulses):
    table = Turntable(pulses=pulses)
    assert table.step(0.0, outputs(""))["X2"] == 1
    turned = [table.turned for _ in range(3000) if run(table, (0.02, "BackSlow"))["X2"]]
    assert all(place * pulses <= 0.25 or place * pulses >= 10 * pulses - 0.25 for place in turned)
    assert min(turned) < 0.25 / pulses
    assert max(turned) > 10 - 0.25 / pulses


def test_two_ways_at_once_are_told_and_turn_nothing():
    table = Turntable()
    run(table, (1.0, "FwdFast BackFast"), (1.0, "Brake FwdSlow"))
    assert [(one.seconds, one.what) for one in table.incidents] == [
        (0.0, "the motor is driven in two ways at once"),
        (1.0, "the motor is driven against the brake"),
    ]
    assert table.turned == 0


def test_a_jammed_table_stands():
    table = Turntable()
    run(table, (1.0, "FwdFast"))
    table.fail("jammed")
    run(table, (1.0, "FwdFast"))
    assert (table.speed, table.turned) == (0.0, pytest.approx(0.75 + 0.05))


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda: Turntable(pulses=0), "1 to 100"),
        (lambda: Turntable(start=100), "0 to 99"),
        (lambda: CamShaft(pulses=2), "4 to 3600"),
        (lambda: CamShaft(turn_s=0), "more than 0"),
    ],
)
def test_what_cannot_be_built_is_refused(act, words):
    with pytest.raises(EcsimError, match=re.escape(words)):
        act()


# -- ROTC -----------------------------------------------------------------------------------------------------------

ROTC = """LD X0
OUT M0
LD X1
OUT M1
LD X2
OUT M2
LD M100
ROTC D200 K100 K10 M0
LD M3
OUT Y0
LD M4
OUT Y1
LD M5
OUT Y2
LD M6
OUT Y3
LD M7
OUT Y4"""


@pytest.mark.parametrize(
    ("window", "item", "travels"),
    [(0, 3, 3), (0, 8, -2), (4, 4, 0), (4, 9, 5), (7, 2, -5 + 10), (2, 1, -1), (9, 2, 3), (1, 5, 4)],
)
def test_the_table_takes_an_item_to_a_window_the_shorter_way(window, item, travels):
    table = Turntable()
    plc, session = turning(ROTC, table)
    wait(session, 0.1)
    session.set("D201", 10 * window)
    session.set("D202", 10 * item)
    session.set("M100", 1)
    wait(session, 9.0)
    there, off = table.item_at(window)
    assert (there, table.speed, plc["M5"]) == (item, 0.0, 1)
    assert abs(off) < 0.1
    assert table.travelled == pytest.approx(travels, abs=0.1)
    assert table.incidents == ()


def test_orders_follow_one_another_and_the_table_is_slow_near_the_window():
    table = Turntable()
    plc, session = turning(ROTC, table)
    wait(session, 0.1)
    session.set("M100", 1)
    speeds = {}
    for window, item in ((0, 4), (0, 9), (5, 0), (3, 3), (8, 1), (0, 0)):
        session.set("D201", 10 * window)
        session.set("D202", 10 * item)
        for _ in range(900):
            wait(session, 0.01)
            ahead = round(abs((10 * item - 10 * window - 10 * table.turned + 50) % 100 - 50))
            speeds[ahead] = max(speeds.get(ahead, 0.0), abs(table.speed))
        assert table.item_at(window)[0] == item
        assert plc["D200"] == (10 * item - 10 * window) % 100
    assert max(speeds[ahead] for ahead in range(7)) <= 0.2 + 1e-9
    assert speeds[30] == pytest.approx(1.0)


def test_a_table_that_stands_anywhere_finds_its_zero():
    table = Turntable(start=37)
    _, session = turning(ROTC, table)
    wait(session, 0.1)
    session.set("D202", 50)
    session.set("M100", 1)
    wait(session, 9.0)
    assert table.item_at(0)[0] == 9  # 3.7 further than it thinks
    session.set("D202", 0)
    wait(session, 9.0)
    session.set("D202", 90)
    wait(session, 9.0)
    session.set("D202", 0)
    wait(session, 9.0)
    session.set("D202", 40)
    wait(session, 9.0)
    assert table.item_at(0)[0] == 4


# -- cams -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("length", [None, 0.1, 0.013])
def test_the_nth_pulse_of_the_shaft_comes_at_its_nth_part_of_a_turn(length):
    shaft = CamShaft(pulses=36, turn_s=3.6)  # a pulse each tenth of a second
    driven = dict.fromkeys(CamShaft.DRIVES, 0) | {"Y0": 1}
    said = [shaft.step(0.0, driven)]
    rises = []
    for number in range(1, 801):
        said.append(shaft.step(0.01, driven))
        if said[-1]["X0"] > said[-2]["X0"]:
            rises.append(number)
    assert rises == [10 * number for number in range(1, 81)]
    assert [number for number in range(801) if said[number]["X1"]] == [*range(5), *range(360, 365), *range(720, 725)]
    assert shaft.angle == pytest.approx(80)
    shaft.fail("jammed")
    shaft.step(length or 1.0, driven)
    assert shaft.angle == pytest.approx(80)


ABSD = """LD M8000
OUT Y0
LD X0
OUT C0 K72
LD C0
RST C0
LD M8000
ABSD D300 C0 Y10 K4"""


def test_the_cams_of_absd_follow_the_angle():
    shaft = CamShaft()  # 5 degrees a pulse
    plc, session = turning(ABSD, shaft)
    table = (8, 28, 12, 36, 18, 32, 60, 4)  # the last one goes over the zero
    for place, value in enumerate(table):
        plc[f"D{300 + place}"] = value
    wait(session, 13.0)
    degrees = [angle for cam in shaft.cams[:4] for angle in cam]
    # A turn is 6 s, 60 degrees a second: the filter and two scans of 10 ms are 1.8 degrees at most.
    assert degrees == [pytest.approx(5 * value + 0.9, abs=0.9) for value in table]
    assert shaft.cams[4:] == ((None, None),) * 4
    assert shaft.half > 2 * 2 * 72


INCD = """LD M8000
OUT Y0
LD X0
OUT C0 K9999
LD M100
INCD D300 C0 Y10 K4
LD M8029
INC D0"""


def test_the_drum_of_incd_goes_from_step_to_step():
    shaft = CamShaft()
    plc, session = turning(INCD, shaft)
    for place, value in enumerate((20, 30, 10, 12)):  # 72 pulses: one round of the drum is one turn
        plc[f"D{300 + place}"] = value
    session.set("M100", 1)
    wait(session, 12.8)
    degrees = [angle for cam in shaft.cams[:4] for angle in cam]
    expected = [0, 100, 100, 250, 250, 300, 300, 0]
    assert [round(angle - wanted, 3) % 360 for angle, wanted in zip(degrees, expected, strict=True)] == [pytest.approx(0.9, abs=0.9)] * 8
    assert (plc["D0"], plc["C1"]) == (2, 0)


# -- the pictures ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("picture", "machine"), [(PICTURE, Turntable), (SHAFT_PICTURE, CamShaft)])
def test_each_entry_of_a_picture_has_its_place_in_the_drawing(picture, machine):
    ids = {part.get("id") for part in xml.fromstring(picture.svg()).iter()}
    state = picture.state(Moment(machine(), {}, {}))
    assert {entry.rpartition(":")[0] for entry in state} <= ids
    assert set(machine.wiring) <= ids


def test_the_table_is_drawn_turned_with_the_item_at_its_window():
    table = Turntable(start=30)  # item 3 stands at window 0, which is drawn at the top: the drawing is turned back by 3 places
    state = PICTURE.state(Moment(table, {}, {}))
    assert state["table:transform"] == f"rotate({360 - 108} 260 222)"
    assert state["stands:text"] == "item 3 at window 0"


def test_the_shaft_tells_where_its_cams_were_on():
    shaft = CamShaft()
    still = dict.fromkeys(CamShaft.DRIVES, 0)
    shaft.step(1.0, still | {"Y0": 1})
    shaft.step(1.0, still | {"Y0": 1, "Y10": 1})
    shaft.step(1.0, still | {"Y0": 1})
    state = SHAFT_PICTURE.state(Moment(shaft, {}, {"Y0": 1}))
    assert (state["range0:text"], state["range1:text"], state["angle:text"]) == ("60° to 120°", "", "180°")
