"""The ladder's Python side: what an element speaks of, where that is used, and its plate."""

import pytest
from ecsim_widgets.ladder import Ladder

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
    return [f"{unit} {network} {words}" for _, unit, network, _, words in ladder.on_about(position(ladder, text))[place]["places"]]


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
