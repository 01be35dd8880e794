"""The plate of a device: what it shows, writing, forcing, refusals."""

import pytest
from ecsim_widgets.plate import Plated
from ecsim_widgets.rig import Rig

from ecsim.plc import Plc
from ecsim.session import Session


@pytest.fixture
def part(rig):
    return Plated(rig)


def plate(part, key="p"):
    return part.plates()[f"plate.{key}"]


def lines(part):
    return dict(plate(part)["rows"])


def test_an_input_shows_its_way_from_the_terminal_to_the_program(part):
    part.rig.plc.inputs.set_filter(20_000)
    part.receive("look", {"plate": "p", "device": "X5"})
    assert (plate(part)["name"], plate(part)["what"], plate(part)["bit"]) == ("Start", "start button", True)
    part.receive("write", {"plate": "p", "n": 1, "text": "1"})
    part.rig.session.scan()  # the filter lasts for two scans
    assert lines(part) == {"at the terminal": "1", "after the filter": "0", "seen by the program": "0"}
    part.rig.session.scan(3)
    assert lines(part) == {"at the terminal": "1", "after the filter": "1", "seen by the program": "1"}
    part.receive("force", {"plate": "p", "n": 2, "text": "0"})
    part.rig.session.scan()
    assert lines(part) == {"at the terminal": "1", "after the filter": "1", "seen by the program": "F 0"}
    part.receive("unforce", {"plate": "p", "n": 3})
    part.rig.session.scan()
    assert lines(part)["seen by the program"] == "1"
    assert plate(part)["done"] == 3


def test_a_forced_output_shows_what_the_program_says(part):
    part.receive("look", {"plate": "p", "device": "Y0"})
    part.receive("force", {"plate": "p", "n": 1, "text": "1"})
    part.rig.session.scan()
    assert lines(part) == {"the program says": "0", "at the output": "F 1"}
    assert plate(part)["forced"] == "1"


def test_an_input_of_the_machine_is_taken_over_when_it_is_written(make_rig, shuttle):
    part = Plated(make_rig(shuttle))
    part.receive("look", {"plate": "p", "device": "X0"})
    part.receive("write", {"plate": "p", "n": 1, "text": "1"})
    assert part.rig.by("X0") == "stuck"


def test_what_is_typed_is_told_in_other_formats_before_it_is_written(part):
    part.rig.plc["D12"] = 7
    part.receive("look", {"plate": "p", "device": "D12", "look": "hex"})
    assert (plate(part)["text"], plate(part)["equals"][0]) == ("16#0007", ["decimal", "7"])
    part.receive("typed", {"plate": "p", "text": "FA0"})
    assert plate(part)["equals"] == [["decimal", "4000"], ["hex", "16#0FA0"], ["binary", "2#0000111110100000"], ["text", "'..'"]]
    assert part.rig.plc["D12"] == 7
    part.receive("write", {"plate": "p", "n": 1, "text": "FA0"})
    assert part.rig.plc["D12"] == 4000
    assert (plate(part)["done"], plate(part)["refused"]) == (1, "")


def test_a_real_shows_its_bits(part):
    part.receive("look", {"plate": "p", "device": "D0:REAL"})
    part.receive("typed", {"plate": "p", "text": "-12.5"})
    assert plate(part)["equals"] == [["hex", "16#C1480000"]]
    part.receive("write", {"plate": "p", "n": 1, "text": "-12.5"})
    assert part.rig.plc["D0:REAL"] == -12.5


@pytest.mark.parametrize(
    ("device", "text", "words"),
    [("D0", "70000", "70000"), ("D0", "full", "number"), ("SD20", "1", "system writes"), ("D0:REAL", "x", "no number")],
)
def test_what_cannot_be_written_is_refused_in_words_and_changes_nothing(part, device, text, words):
    part.receive("look", {"plate": "p", "device": device})
    before = part.rig.plc[device]
    part.receive("write", {"plate": "p", "n": 1, "text": text})
    assert words in plate(part)["refused"]
    assert plate(part)["done"] == 1
    assert part.rig.plc[device] == before


@pytest.mark.parametrize(("device", "text", "words"), [("D0:DINT", "5", "16-bit"), ("SM0", "0", "system writes"), ("D0", "x", "number")])
def test_what_cannot_be_forced_is_refused_in_words(part, device, text, words):
    part.receive("look", {"plate": "p", "device": device})
    part.receive("force", {"plate": "p", "n": 1, "text": text})
    part.rig.session.scan()
    assert words in plate(part)["refused"]
    assert part.rig.plc.forced == {}


def test_a_contact_and_a_value_of_a_timer_are_two_devices(part):
    part.receive("look", {"plate": "p", "device": "T0:BOOL"})
    part.receive("look", {"plate": "q", "device": "T0"})
    part.receive("force", {"plate": "p", "n": 1, "text": "1"})
    part.rig.session.scan()
    assert (plate(part)["forced"], plate(part, "q")["forced"]) == ("1", None)


def test_a_step_back_repeats_the_force_and_answers_nobody(part):
    part.receive("look", {"plate": "p", "device": "Y3"})
    part.receive("force", {"plate": "p", "n": 1, "text": "1"})
    part.rig.session.scan(2)
    part.receive("unforce", {"plate": "p", "n": 2})
    part.rig.session.scan(2)
    assert part.rig.session.back(2)
    assert plate(part)["done"] == 2
    assert part.rig.plc["Y3"] == 1


def test_plates_of_pages_that_went_away_are_given_up(part):
    for number in range(20):
        part.receive("look", {"plate": str(number), "device": "D0"})
    assert len(part.plates()) == 8
    part.receive("leave", {"plate": "19"})
    part.receive("write", {"plate": "19", "n": 1, "text": "5"})
    assert (len(part.plates()), part.rig.plc["D0"]) == (7, 0)


# -- an analog terminal --------------------------------------------------------------------------------------------


@pytest.fixture
def analog():
    """Plates of an EC20 with a 4AD and a 4DA."""
    plc = Plc("EC20", scan_ms=10, io=[(24, 16), "4AD", "4DA"])
    plc.load("LD X0\nOUT Y0")
    plc.run()
    return Plated(Rig(plc, Session(plc, name="test")))


def test_a_signal_is_written_on_the_plate_of_its_terminal(analog):
    analog.receive("look", {"plate": "p", "device": "AI0.0:V"})
    assert (plate(analog)["device"], plate(analog)["look"], lines(analog)) == ("AI0.0", "V", {"at the terminal": "no signal"})
    analog.receive("write", {"plate": "p", "n": 1, "text": "-2.5"})
    analog.rig.session.scan()
    assert (analog.rig.plc["AI0.0:V"], lines(analog), plate(analog)["refused"]) == (-2.5, {"at the terminal": "-2.5 V"}, "")
    analog.receive("write", {"plate": "p", "n": 2, "text": "none"})
    analog.rig.session.scan()
    assert analog.rig.plc["AI0.0:V"] is None


def test_a_terminal_cannot_be_forced_and_an_output_not_written(analog):
    analog.receive("look", {"plate": "p", "device": "AI0.0:V"})
    analog.receive("force", {"plate": "p", "n": 1, "text": "1"})
    analog.rig.session.scan()
    assert "AI0.0:V is a terminal and cannot be forced" in plate(analog)["refused"]
    analog.receive("look", {"plate": "q", "device": "AO1.0:V"})
    analog.receive("write", {"plate": "q", "n": 1, "text": "1"})
    assert "AO1.0:V is an output" in plate(analog, "q")["refused"]
