"""The device table's panel: windows on the rows, requests and their answers."""

import pytest
from ecsim_widgets.devices import Devices


@pytest.fixture
def part(make_rig):
    return Devices(make_rig(devices=["D0-D7999", "Start"]), clock=iter(range(10_000)).__next__)


def test_only_the_rows_that_a_page_sees_are_sent(part):
    part.receive("window", {"view": "v", "first": 4000, "count": 30})
    frame = part.frame()
    first, numbers, total = frame["shown.v"]
    assert (first, len(numbers), total) == (4000, 30, 8001)
    rows = {key for key in frame if key.startswith("row.")}
    assert len(rows) == 60  # the value and what it is, of each
    assert frame[f"row.{numbers[0]}.of"] == ["D4000", "", "", "decimal", "INT WORD DINT DWORD REAL", 16, "D4000"]


def test_a_window_ends_with_the_table(part):
    part.receive("window", {"view": "v", "first": 7990, "count": 30})
    first, numbers, _ = part.frame()["shown.v"]
    assert (first, len(numbers)) == (7971, 30)
    assert part.frame()[f"row.{numbers[-1]}.of"][:3] == ["X5", "Start", "start button"]


def test_a_row_has_text_bits_and_force(part):
    part.rig.plc["D0"] = -2
    part.rig.plc.force("D1", 5)
    part.receive("window", {"view": "v", "first": 0, "count": 2})
    frame = part.frame()
    one, two = frame["shown.v"][1]
    assert frame[f"row.{one}"] == ["-2", 0xFFFE, False]
    assert frame[f"row.{two}"] == ["5", 5, True]
    assert (frame["forced"], frame["count"]) == (1, 8001)


def test_what_is_added_is_shown_where_it_stands(part):
    part.receive("add", {"view": "v", "n": 1, "text": "M0-M9"})
    assert part.frame()["said.v"] == [1, "", 8002]
    part.receive("add", {"view": "v", "n": 2, "text": "D99999"})
    number, refused, _ = part.frame()["said.v"]
    assert number == 2
    assert "D99999" in refused
    assert part.frame()["count"] == 8011


def test_a_row_that_is_not_among_those_chosen_is_brought_to_sight(part):
    part.receive("arrange", {"find": "start"})
    assert part.frame()["as"] == ["start", "", False, ""]
    part.receive("add", {"view": "v", "n": 1, "text": "D5"})
    assert part.frame()["said.v"] == [1, "", 6]
    assert part.frame()["as"] == ["", "", False, ""]


def test_the_format_of_a_row(part):
    part.rig.plc["D0:REAL"] = 1.5
    part.receive("window", {"view": "v", "first": 0, "count": 1})
    (number,) = part.frame()["shown.v"][1]
    part.receive("show", {"view": "v", "n": 1, "number": number, "look": "real"})
    assert part.frame()[f"row.{number}"][:2] == ["1.5", 0x3FC00000]
    assert part.frame()[f"row.{number}.of"][3:] == ["real", "INT WORD DINT DWORD REAL", 32, "D0:REAL"]
    part.receive("show", {"view": "v", "n": 2, "number": number, "look": "bit"})
    assert "choose" in part.frame()["said.v"][1]


def test_forced_rows_alone_come_and_go_with_the_force(part):
    part.receive("window", {"view": "v", "first": 0, "count": 10})
    part.receive("arrange", {"only": "forced"})
    assert part.frame()["shown.v"][2] == 0
    part.rig.plc.force("D7000", 1)
    part.frame()
    first, numbers, total = part.frame()["shown.v"]
    assert (first, total) == (0, 1)
    part.receive("release_row", {"number": numbers[0]})
    assert part.rig.plc.forced == {}


def test_all_forces_are_released_at_once(part):
    part.rig.plc.force("D7000", 1)
    part.rig.plc.force("Y5", 1)
    part.receive("release_all", {})
    assert part.rig.plc.forced == {}


def test_rows_are_dropped_cleared_and_put_back(part):
    part.receive("window", {"view": "v", "first": 0, "count": 2})
    part.receive("drop", {"number": part.frame()["shown.v"][1][0]})
    assert part.frame()["count"] == 8000
    part.receive("clear", {})
    assert (part.frame()["count"], part.frame()["back"]) == (0, True)
    part.receive("put_back", {})
    assert (part.frame()["count"], part.frame()["back"]) == (8000, False)


def test_what_may_be_meant_is_offered_while_one_types(part):
    part.receive("offer", {"view": "v", "text": "Sta"})
    assert part.frame()["offers.v"] == [["Start", "X5", "start button"]]


def test_each_menu_has_the_formats_of_its_devices(part):
    menus = part.layout()["menus"]
    assert menus["BOOL"] == ["bit"]
    assert "contact" in menus["INT WORD BOOL"]
    assert "real" in menus["INT WORD DINT DWORD REAL"]


def test_windows_of_pages_that_went_away_are_given_up(part):
    for number in range(10):
        part.receive("window", {"view": str(number), "first": 0, "count": 10_000})
    frame = part.frame()
    assert sum(key.startswith("shown.") for key in frame) == 4
    assert max(len(frame[key][1]) for key in frame if key.startswith("shown.")) == 200
