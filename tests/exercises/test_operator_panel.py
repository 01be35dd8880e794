"""The operator's panel: its parts by themselves, and an H2U whose instructions read and lead them (FNC 52, 70 to 72, 74, 75, 77)."""

import re
import xml.etree.ElementTree as xml
from dataclasses import dataclass

import pytest
from ecsim_exercises.operator_panel import PICTURE, OperatorPanel
from ecsim_exercises.plant import Moment

from ecsim import EcsimError, Plc
from ecsim.session import Session


def operate(program, *parts, **choices):
    """An H2U with scans of 1 ms, a program and a panel of these parts at its terminals, in RUN."""
    plc = Plc("H2U", scan_ms=1)
    plc.load("LD M8000\n" + program)
    panel = OperatorPanel(parts, **choices)
    session = Session(plc, panel, speed=None, name="panel")
    plc.run()
    return plc, panel, session


def wait(session, seconds):
    """Scan for so many seconds of simulated time."""
    end = session.plc.clock[0] + seconds * 1e6
    while session.plc.clock[0] < end:
        session.scan(10)


# -- keys -----------------------------------------------------------------------------------------------------------


def test_ten_keys_type_a_number_with_tky():
    plc, panel, session = operate("TKY X0 D0 M10", "keys")
    panel.press("2057")
    wait(session, 0.1)
    assert (plc["D0"], plc["M12"], plc["M20"]) == (2, 1, 1)
    wait(session, 1.6)
    assert (plc["D0"], plc["M17"], plc["M20"]) == (2057, 1, 0)
    panel.press("9")  # the fifth digit pushes the first one out
    wait(session, 0.5)
    assert plc["D0"] == 579


@pytest.mark.parametrize("scan_ms", [0, 5, 30])
def test_a_keypad_types_a_number_with_hky(scan_ms):
    constant = f"MOV K{scan_ms} D8039\nLD M8000\nOUT M8039\nLD M8000\n" if scan_ms else ""
    plc, panel, session = operate(f"{constant}HKY X20 Y14 D0 M0", "keypad")
    panel.press("4096", seconds=0.6)
    wait(session, 3.2)
    assert plc["D0"] == 4096
    panel.press("C", seconds=0.6)
    wait(session, 0.5)
    assert [plc[f"M{place}"] for place in range(8)] == [0, 0, 1, 0, 0, 0, 1, 0]
    assert plc["D0"] == 4096


def test_every_key_of_the_keypad_is_the_one_that_is_read():
    plc, panel, session = operate("SET M8167\nHKY X20 Y14 D0 M0", "keypad")
    for key in "0123456789ABCDEF":
        panel.press(key)
        wait(session, 0.4)
        assert plc["D0"] & 15 == int(key, 16)


def test_arrow_keys_set_a_number_on_the_display_with_arws():
    plc, panel, session = operate("ARWS X14 D0 Y0 K0", "arrows", "display")
    wait(session, 0.2)
    assert panel.shown() == "0000"
    panel.press(["up", "up", "right", "down", "right", "right", "up", "left", "left", "left", "down"])
    wait(session, 4.6)
    assert plc["D0"] == 1901  # 2000, 2900, 2901, 1901
    assert panel.shown() == "1901"


# -- switches -------------------------------------------------------------------------------------------------------


def test_switches_come_row_after_row_with_mtr():
    plc, panel, session = operate("MTR X40 Y20 M30 K3", "switches")
    for place in ((0, 1), (1, 7), (2, 0), (2, 5)):
        panel.switch(*place)
    wait(session, 0.3)
    on = [place for place in range(30) if plc[f"M{30 + place}"]]
    assert on == [1, 17, 20, 25]
    panel.switch(1, 7)
    wait(session, 0.3)
    assert [place for place in range(30) if plc[f"M{30 + place}"]] == [1, 20, 25]


@pytest.mark.parametrize(("sets", "numbers"), [(1, (2057,)), (2, (2057, 9830))])
def test_thumbwheels_are_read_with_dsw(sets, numbers):
    plc, panel, session = operate(f"DSW X30 Y24 D0 K{sets}", "wheels", sets=sets)
    for place, number in enumerate(numbers):
        panel.turn(number, place)
    wait(session, 1.0)
    assert [plc["D0"], plc["D1"]] == [*numbers, 0][:2]
    panel.hold("wheels 0 3 down")
    wait(session, 1.0)
    assert plc["D0"] == 1057


@dataclass
class Elsewhere:
    """A panel whose terminals are wired to others."""

    panel: OperatorPanel
    places: dict[str, str]  # the panel's terminal -> the PLC's

    def __post_init__(self):
        self.wiring = {self.places[device]: point for device, point in self.panel.wiring.items()}

    def step(self, seconds, outputs):
        said = self.panel.step(seconds, {device: outputs[place] for device, place in self.places.items() if place in outputs})
        return {self.places[device]: level for device, level in said.items()}


@pytest.mark.parametrize("scan_ms", [10, 15, 20, 40])
def test_a_keypad_and_switches_are_read_behind_the_filter_in_constant_scans(scan_ms):
    program = f"LD M8000\nMOV K{scan_ms} D8039\nLD M8000\nOUT M8039\nLD M8000\n"
    rows = {f"Y{14 + place}": f"Y{place}" for place in range(4)}
    panel = OperatorPanel(("keypad",))
    plc = Plc("H2U", scan_ms=1)
    plc.load(program + "HKY X0 Y0 D0 M0")
    session = Session(plc, Elsewhere(panel, {f"X{20 + place}": f"X{place}" for place in range(4)} | rows), speed=None, name="keypad")
    plc.run()
    panel.press("2057", seconds=1.0)
    wait(session, 5.0)
    assert plc["D0"] == 2057

    panel = OperatorPanel(("switches",))
    plc = Plc("H2U", scan_ms=1)
    plc.load(program + "MTR X0 Y0 M30 K3")
    rows = {f"Y{20 + place}": f"Y{place}" for place in range(3)}
    session = Session(plc, Elsewhere(panel, {f"X{40 + place}": f"X{place}" for place in range(8)} | rows), speed=None, name="switches")
    plc.run()
    for place in ((0, 1), (1, 7), (2, 0), (2, 5)):
        panel.switch(*place)
    wait(session, 1.0)
    assert [place for place in range(30) if plc[f"M{30 + place}"]] == [1, 17, 20, 25]


# -- display and printer --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("logic", [0, 1, 2, 3])
def test_segl_shows_a_number_on_a_display_of_each_logic(logic):
    plc, panel, session = operate(f"SEGL D0 Y0 K{logic}", "display", logic=logic)
    plc["D0"] = 2057
    wait(session, 0.2)
    assert panel.shown() == "2057"
    plc["D0"] = 9
    wait(session, 0.2)
    assert panel.shown() == "0009"


def test_segl_shows_two_numbers_on_two_displays_and_they_keep_them_when_the_plc_stops():
    plc, panel, session = operate("SEGL D0 Y0 K4", "display", sets=2)
    plc["D0"], plc["D1"] = 1234, 5678
    wait(session, 0.2)
    plc.stop()
    session.scan(20)
    assert not any(plc[f"Y{place:o}"] for place in range(12))
    assert (panel.shown(0), panel.shown(1)) == ("1234", "5678")


def test_a_display_of_the_other_logic_does_not_show_the_number():
    plc, panel, session = operate("SEGL D0 Y0 K0", "display", logic=2)
    plc["D0"] = 2057
    wait(session, 0.2)
    assert panel.shown() != "2057"


def test_pr_prints_eight_characters():
    _, panel, session = operate("ASC HELLO123 D0\nLD M100\nPR D0 Y30", "printer")
    session.set("M100", 1)
    wait(session, 0.3)
    assert panel.printed == "HELLO123"
    session.set("M100", 0)
    session.scan(5)
    panel.fail("no paper")
    session.set("M100", 1)
    wait(session, 0.3)
    assert panel.printed == "HELLO123"


def test_pr_prints_up_to_a_zero_with_m8027():
    plc, panel, session = operate("SET M8027\nLD M8002\nASC READY D0\nLD M100\nPR D0 Y30", "printer")
    session.scan(2)
    plc["D2"], plc["D3"] = 0x0D59, 0x000A  # Y, return, line feed
    session.set("M100", 1)
    wait(session, 0.3)
    assert panel.printed == "READY\r\n"
    assert panel.lines() == ["READY", ""]


def test_all_parts_work_side_by_side():
    program = """HKY X20 Y14 D0 M0
LD M8000
DSW X30 Y24 D10 K1
LD M8000
MTR X40 Y20 M30 K3
LD M8000
ADD D0 D10 D20
LD M8000
SEGL D20 Y0 K0"""
    plc, panel, session = operate(program, "keypad", "wheels", "switches", "display")
    panel.turn(1111)
    panel.switch(2, 3)
    panel.press("2345")
    wait(session, 2.0)
    assert (panel.shown(), plc["M53"]) == ("3456", 1)


# -- the panel by itself --------------------------------------------------------------------------------------------


def test_keys_go_down_one_after_the_other():
    panel = OperatorPanel(("keys",))
    panel.press("12", seconds=0.3)
    assert panel.step(0.29, {})["X1"] == 1
    assert panel.step(0.02, {}) == {f"X{place:o}": 0 for place in range(10)}
    assert panel.step(0.2, {})["X2"] == 1
    assert not any(panel.step(0.3, {}).values())


def test_a_finger_stays_until_it_is_taken_off():
    panel = OperatorPanel(("arrows",))
    panel.hold("arrows up")
    assert panel.step(5.0, {}) == {"X14": 0, "X15": 1, "X16": 0, "X17": 0}
    panel.release("arrows up")
    assert panel.step(0.1, {})["X15"] == 0


def test_a_row_without_its_output_is_silent():
    panel = OperatorPanel(("switches",))
    panel.switch(1, 2, True)
    panel.switch(1, 2, True)
    assert panel.step(0.1, {"Y20": 1, "Y21": 0, "Y22": 1}) == {f"X{40 + place}": 0 for place in range(8)}
    assert panel.step(0.1, {"Y20": 0, "Y21": 1, "Y22": 0}) == {f"X{40 + place}": int(place == 2) for place in range(8)}


def test_a_display_takes_a_digit_while_its_strobe_is_there_and_keeps_it():
    panel = OperatorPanel(("display",))
    dark = dict.fromkeys((f"Y{place}" for place in range(8)), 0)
    assert panel.shown() == "    "
    panel.step(0.1, dark | {"Y0": 1, "Y2": 1, "Y5": 1})
    panel.step(0.1, dark | {"Y1": 1})
    assert panel.shown() == "  5 "
    panel.step(0.1, dark | {"Y1": 1, "Y3": 1, "Y5": 1})  # 10 is no digit
    assert panel.shown() == "    "


def test_a_moment_comes_back():
    panel = OperatorPanel()
    panel.turn(1234)
    panel.press("7")
    state = panel.state()
    panel.turn(4321)
    panel.switch(0, 0)
    panel.step(1.0, dict.fromkeys(panel.DRIVES, 1))
    panel.restore(state)
    assert (panel.numbers, panel.switches[0], panel.pressed, panel.printed) == ((1234, 0), False, {"keypad 7"}, "")
    assert panel.seconds == 0.0


def test_a_key_from_the_session_comes_again_on_the_way_through_the_past():
    plc, _, session = operate("TKY X0 D0 M10", "keys")
    session.scan(10)
    session.post(lambda plc: session.plant.press("8"))
    wait(session, 0.3)
    scan = plc.scans
    session.back(scan - 5)
    assert plc["D0"] == 0
    session.seek(scan)
    assert plc["D0"] == 8


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda: OperatorPanel(("keys", "lamps")), "lamps"),
        (lambda: OperatorPanel(()), "one or more"),
        (lambda: OperatorPanel(sets=3), "1 or 2"),
        (lambda: OperatorPanel(logic=4), "0 to 3"),
        (lambda: OperatorPanel(("display",)).press("7"), "no key '7'"),
        (lambda: OperatorPanel(("keys",)).press("1A"), "no key 'A'"),
        (lambda: OperatorPanel(("keys",)).press("1", seconds=0), "more than 0"),
        (lambda: OperatorPanel(("keys",)).press(57), "57 is no text of keys"),
        (lambda: OperatorPanel(("keys",)).press("keys 1 2"), "no key 'keys 1 2'"),
        (lambda: OperatorPanel(("keys",)).hold(""), "no key ''"),
        (lambda: OperatorPanel(("keys",)).release(""), "no key ''"),
        (lambda: OperatorPanel().turn(5.0), "5.0 on four thumbwheels"),
        (lambda: OperatorPanel(("keys",)).turn(5), "no wheels"),
        (lambda: OperatorPanel().turn(10000), "0 to 9999"),
        (lambda: OperatorPanel().turn(1, 1), "the panel has 1"),
        (lambda: OperatorPanel().switch(3, 0), "rows are 0 to 2"),
        (lambda: OperatorPanel().hold("switches 1"), "ROW COLUMN"),
        (lambda: OperatorPanel().hold("wheels 0 7 sideways"), "DIGIT"),
        (lambda: OperatorPanel().hold("horn"), "no key 'horn'"),
    ],
)
def test_what_is_not_there_is_refused(act, words):
    with pytest.raises(EcsimError, match=re.escape(words)):
        act()


# -- the picture ----------------------------------------------------------------------------------------------------


def test_each_entry_of_the_picture_has_its_place_in_the_drawing():
    panel = OperatorPanel(sets=2)
    ids = {part.get("id") for part in xml.fromstring(PICTURE.svg()).iter()}
    state = PICTURE.state(Moment(panel, {}, {}))
    assert {entry.rpartition(":")[0] for entry in state} <= ids
    assert set(panel.wiring) <= ids


def test_each_key_of_the_drawing_can_be_pressed():
    panel = OperatorPanel(sets=2)
    keys = [part.get("data-key") for part in xml.fromstring(PICTURE.svg()).iter() if part.get("data-key")]
    assert len(keys) == len(set(keys)) == 10 + 16 + 4 + 24 + 2 * 2 * 4
    for key in keys:
        panel.hold(key)
        panel.release(key)
    assert all(panel.switches)


def test_the_picture_shows_keys_digits_paper_and_the_parts_that_are_there():
    panel = OperatorPanel(("display", "keypad", "printer", "wheels"))
    panel.turn(2057)
    panel.hold("keypad A")
    panel.step(0.1, dict.fromkeys(panel.DRIVES, 0) | {"Y0": 1, "Y4": 1})  # a 1 in the units
    for code in b"OK\r\nGO":
        panel.step(0.1, dict.fromkeys(panel.DRIVES, 0) | {f"Y{30 + place}": code >> place & 1 for place in range(8)} | {"Y40": 1})
        panel.step(0.1, dict.fromkeys(panel.DRIVES, 0))
    state = PICTURE.state(Moment(panel, {}, {}))
    assert [name for name in "abcdefg" if state[f"seg00{name}:class"].endswith(" on")] == ["b", "c"]
    assert not any(state[f"seg01{name}:class"].endswith(" on") for name in "abcdefg")
    assert state["pad10:class"] == "key on"
    assert [state[f"wheel0{digit}:text"] for digit in range(4)] == ["7", "5", "0", "2"]
    assert [state[f"paper{place}:text"] for place in range(4)] == ["", "", "OK", "GO"]
    assert (state["keypad-part:display"], state["keys-part:display"], state["display1:display"]) == ("inline", "none", "none")
