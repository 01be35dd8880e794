"""The ladder's Python side: what an element speaks of, where that is used, and its plate."""

import json
from itertools import pairwise

import pytest
from ecsim_widgets import ladder as module
from ecsim_widgets.ladder import Ladder
from ecsim_widgets.panel import Panel
from ecsim_widgets.stream import Stream

PROGRAM = """VAR_GLOBAL
  Start AT X5      // start button
END_VAR
PROGRAM MAIN
LD Start
OUT M3
LD T0
MOV K4M0 D0
LD M3
DMOV D0 D10
LD SM0
TON T0 50
MOV D1 D0Z1
CALL SUB
END_PROGRAM
SUBROUTINE SUB
LD M3
OUT Y0
END_SUBROUTINE
"""


@pytest.fixture
def ladder(make_rig):
    return Ladder(make_rig(program=PROGRAM))


def position(ladder, text):
    return next(i.position for i in ladder.rig.instructions if str(i) == text)


def used(ladder, text, place=0):
    return [f"{unit} {network} {words}" for _, _, unit, network, _, words in ladder.on_about(position(ladder, text))[place]["places"]]


def test_an_element_tells_its_device_with_name_and_comment(ladder):
    (about,) = ladder.on_about(position(ladder, "LD Start"))
    assert (about["label"], about["name"], about["what"], about["written"]) == ("X5", "Start", "start button", False)


def test_a_bit_is_used_in_all_units_and_in_kn_strings(ladder):
    assert used(ladder, "OUT M3") == ["MAIN 1 OUT writes", "MAIN 2 MOV reads", "MAIN 3 LD reads", "SUB 1 LD reads"]


def test_a_register_is_used_where_a_longer_value_covers_it(ladder):
    assert used(ladder, "MOV D1 D0Z1") == ["MAIN 3 DMOV reads", "MAIN 4 MOV reads"]


def test_the_label_says_how_the_device_is_read_there(ladder):
    assert [about["label"] for about in ladder.on_about(position(ladder, "LD T0"))] == ["T0:BOOL"]
    assert [about["label"] for about in ladder.on_about(position(ladder, "TON T0 50"))] == ["T0"]
    assert [about["label"] for about in ladder.on_about(position(ladder, "DMOV D0 D10"))] == ["D0:DINT", "D10:DINT"]
    assert [about["label"] for about in ladder.on_about(position(ladder, "MOV K4M0 D0"))] == ["K4M0", "D0"]


def test_an_element_without_a_device_has_nothing_to_tell(ladder):
    assert ladder.on_about(position(ladder, "CALL SUB")) == []


def test_a_plate_of_the_ladder_forces(ladder):
    ladder.receive("look", {"plate": "p", "device": "M3"})
    assert ladder.frame()["plate.p"]["device"] == "M3"
    ladder.receive("force", {"plate": "p", "n": 1, "text": "1"})
    ladder.rig.session.scan()
    assert ladder.rig.plc.forced == {"M3": 1}


# -- of a large program only what somebody looks at ----------------------------------------------------------------

RUNGS = "\n".join(f"LD X{n % 8}\nANI X7\nOUT M{n}" for n in range(400))


@pytest.fixture
def large(make_rig):
    return Ladder(make_rig(program=RUNGS))


def drawn(frame):
    return sorted(int(key[4:]) for key in frame if key.startswith("net."))


def test_a_frame_has_the_networks_that_are_looked_at_and_no_others(large):
    large.receive("see", {"view": "a", "first": 100, "last": 120})
    frame = large.frame()
    assert drawn(frame) == list(range(100, 121))
    assert {key for key in frame if key.startswith("e")} == {f"e{p}:{what}" for p in range(300, 363) for what in ("class", "aria-label")}
    large.rig.put("X4", 1)  # M100 = X4 and not X7
    large.rig.session.scan(2)
    assert large.frame()["e302:class"] == "coil flow"


def test_two_views_get_what_both_look_at_until_one_goes(large):
    large.receive("see", {"view": "a", "first": 0, "last": 1})
    large.receive("see", {"view": "b", "first": 398, "last": 500})
    assert large.frame()["looked"] == [0, 1, 398, 399]
    large.receive("unsee", {"view": "a"})
    assert large.frame()["looked"] == [398, 399]


def test_views_that_went_away_unseen_are_forgotten(large):
    for number in range(9):
        large.receive("see", {"view": f"v{number}", "first": number, "last": number})
    assert large.frame()["looked"] == [5, 8]


def alive(frame):
    """The networks whose coils have their state in a frame."""
    return [n for n in range(400) if f"e{3 * n + 2}:class" in frame]


def test_what_was_looked_at_keeps_its_drawing_longer_than_its_values(large, monkeypatch):
    monkeypatch.setattr(module, "LIVE", 4)
    monkeypatch.setattr(module, "KEPT", 6)
    for first in (10, 20, 30, 40):
        large.receive("see", {"view": "a", "first": first, "last": first + 1})
    frame = large.frame()
    assert drawn(frame) == [20, 21, 30, 31, 40, 41]
    assert alive(frame) == [30, 31, 40, 41]
    assert (frame["live"], frame["looked"]) == ([30, 31, 40, 41], [40, 41])
    large.receive("see", {"view": "a", "first": 20, "last": 21})  # back again: the oldest are now others
    frame = large.frame()
    assert (drawn(frame), alive(frame)) == ([20, 21, 30, 31, 40, 41], [20, 21, 40, 41])


def test_a_view_that_stands_keeps_its_values_however_far_another_goes(large, monkeypatch):
    monkeypatch.setattr(module, "LIVE", 4)
    large.receive("see", {"view": "a", "first": 7, "last": 8})
    for first in range(100, 200, 2):
        large.receive("see", {"view": "b", "first": first, "last": first + 1})
    assert {7, 8} <= {*alive(large.frame())}


def test_following_fast_steps_sends_each_drawing_once(large):
    panel = Panel(large.rig, [Ladder])
    sent, now_s = [], iter(range(10**6))
    panel.stream, panel.send = Stream(now_s.__next__), sent.append
    panel._receive(panel, {"hello": True}, [])
    sent.clear()
    for update in range(200):  # ten seconds: from one end of the program to the other with every update, as a ladder that follows does
        first = 20 if update % 2 else 360
        panel.rig.put("X3", update % 2)
        panel._receive(panel, {"part": "ladder", "do": "see", "view": "a", "first": first, "last": first + 26}, [])
        panel.rig.session.scan()
    assert len(sent) >= 200
    entries = [entry for message in sent for entry in message["state"].get("ladder", {}).items()]
    drawings = [key for key, markup in entries if key.startswith("net.") and markup]
    assert sorted(drawings) == sorted(f"net.{number}" for first in (20, 360) for number in range(first, first + 27))
    octets = sum(len(json.dumps(message)) for message in sent)
    assert octets < 10 * 100_000


def test_a_view_cannot_ask_for_all_of_a_large_program(large):
    large.receive("see", {"view": "a", "first": -5, "last": 10**6})
    assert len(drawn(large.frame())) == 300


def test_the_height_of_every_network_is_told_at_once(large):
    tops = large.frame()["sheet"]["tops"]
    assert len(tops) == 401
    assert {later - earlier for earlier, later in pairwise(tops)} == {84}  # 56 to the wire, 28 below it


def test_places_of_use_name_the_network_that_is_to_be_gone_to(large):
    (about,) = large.on_about(position(large, "OUT M399"))
    assert about["places"] == [[399, 1199, "MAIN", 400, 399 * 3 + 2, "OUT writes"]]


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("m399", [[399, 1199]]),  # a device
        ("400", [[133, 400], [399, 1197]]),  # a program step, and a network
        ("out m398", [[398, 1196]]),  # an instruction
        ("nowhere", []),
        ("  ", []),
    ],
)
def test_what_is_looked_for_is_found_in_networks_that_are_not_drawn(large, text, places):
    assert [place[:2] for place in large.on_find(text)] == places


def test_names_titles_and_comments_are_found(make_rig):
    found = Ladder(make_rig()).on_find
    assert [place[5] for place in found("follows the")] == ["the lamp follows the button"]
    assert [place[5] for place in found("lamp")][-1] == "OUT writes"
    assert [place[5] for place in found("Start")] == ["LD reads", "LD reads"]


def test_what_a_password_closes_is_not_found(make_rig):
    rig = make_rig(program="LD M3\nCALL SUB\nEND_PROGRAM\nSUBROUTINE SUB\nLD M3\nOUT Y0\nEND_SUBROUTINE".join(("PROGRAM MAIN\n", "")))
    rig.program.unit("SUB").password = "secret"
    ladder = Ladder(rig)
    assert [place[1] for place in ladder.on_find("M3")] == [0]


# -- breakpoints ---------------------------------------------------------------------------------------------------


def test_a_breakpoint_is_set_at_a_contact_and_the_stop_shows_there(ladder):
    contact = position(ladder, "LD M3")
    ladder.receive("break", {"position": contact})
    assert [point.text for point in ladder.rig.session.breakpoints] == ["M3"]
    coil = position(ladder, "OUT M3")  # what the coil does is the same question
    frame = ladder.frame()
    assert frame["breaks"][str(contact)] == frame["breaks"][str(coil)] == "on"
    assert frame[f"e{contact}:aria-label"].endswith("open, breakpoint")
    ladder.rig.put("X5", 1)
    ladder.rig.session.scan(3)
    frame = ladder.frame()
    assert (frame["breaks"][str(contact)], frame["hit"]) == ("hit", [2, contact])
    assert frame[f"e{contact}:aria-label"].endswith("power flows, the run stopped here")
    ladder.rig.session.breakpoints.enable("M3", False)
    assert ladder.frame()["breaks"][str(contact)] == "off"
    ladder.receive("break", {"position": contact})
    assert (len(ladder.rig.session.breakpoints), ladder.frame()["breaks"]) == (0, {})


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        ("LD Start", "X5"),
        ("LD T0", "T0"),
        ("DMOV D0 D10", "M3"),  # that power comes to the box
        ("TON T0 50", "T0"),
        ("OUT Y0", "Y0"),
    ],
)
def test_what_a_breakpoint_at_an_element_asks(ladder, text, asked):
    assert ladder.on_break(position(ladder, text)) == ""
    assert [point.text for point in ladder.rig.session.breakpoints] == [asked]


def test_where_nothing_can_be_asked_it_says_so_and_sets_none(make_rig):
    ladder = Ladder(make_rig(program="LD X0\nEU\nINC D0"))
    assert ladder.on_break(1) == "EU has no breakpoint: between two scans nothing can be asked of it"
    assert ladder.on_break(2).startswith("INC D0 has no breakpoint")
    assert len(ladder.rig.session.breakpoints) == 0
