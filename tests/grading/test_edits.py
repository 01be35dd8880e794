"""Single edits, and the measure of the rules that is made of them."""

import pytest

from ecsim import EcsimError
from ecsim.grading import Never
from ecsim.grading.edits import edits
from ecsim.grading.mutation import mutate


def news(text):
    return [edit.new for edit in edits(text)]


def test_a_contact_is_turned_exchanged_and_left_out():
    assert news("LD X0\nOUT Y0")[:2] == ["LDI X0", ""]
    assert {"ORI X1", "AND X1", "ANI X0", ""} <= set(news("LD X0\nANI X1\nOUT Y0"))


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("OUT Y0", {"SET Y0", ""}),
        ("SET Y0", {"OUT Y0", "RST Y0", ""}),
        ("TON T0 30", {"TOF T0 30", "TONR T0 30", "TON T0 33", "TON T0 27", "TON T0 300", "TON T0 3", "TON T0 15", ""}),
        ("MOV 0 D0", {"MOV 1 D0", "MOV -1 D0", ""}),
        ("LD>= D0 5", {"LD> D0 5", "LD< D0 5", "LD>= D0 6", "LD>= D0 4", "LD>= D0 50", "LD>= D0 0", "LD>= D0 2", ""}),
    ],
)
def test_what_a_line_becomes(line, expected):
    assert set(news(line)) == expected


def test_a_name_gives_way_to_its_neighbours():
    text = "VAR_GLOBAL\nA AT X0\nB AT X1\nC AT X2\nEND_VAR\nPROGRAM MAIN\nLD B // why\nOUT Y0\nEND_PROGRAM"
    found = {edit.new: edit for edit in edits(text)}
    assert {"LD A", "LD C"} <= found.keys()
    assert found["LD A"].text == text.replace("LD B // why", "LD A")
    assert str(found["LD A"]) == "line 7: LD B -> LD A"


def test_good_rules_catch_every_fault(lamp):
    found = mutate(lamp())
    assert (found.share, found.missed) == (1.0, [])
    assert sum(found.by_rule.values()) == len(found.caught) >= 6
    assert found.as_dict()["share"] == 1.0


def test_a_missing_rule_lets_faults_pass(lamp):
    found = mutate(lamp(*(rule for rule in lamp().rules if rule.name != "locked")))
    assert found.share < 0.95
    assert "line 3: ANI X1 -> nothing" in map(str, found.missed)
    assert "missed  line 3: ANI X1 -> nothing" in str(found)


def test_a_line_that_does_nothing_is_no_fault(lamp):
    found = mutate(lamp(text="LD X0\nANI X1\nOUT Y0\nLD X5\nSET M7\n"))
    assert "line 5: SET M7 -> RST M7" in map(str, found.same)
    assert found.share == 1.0


def test_progress_is_told(lamp):
    seen = []
    mutate(lamp(), progress=lambda done, of: seen.append((done, of)))
    assert seen[-1][0] == seen[-1][1] == len(seen)


def test_a_rule_cannot_ask_for_the_steps_of_a_program_without(lamp):
    odd = Never("odd", "Odd", "Step == 'S1'")
    with pytest.raises(EcsimError, match="no lane"):
        lamp(odd).grade("LD X0\nOUT Y0")
