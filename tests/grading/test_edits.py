"""Single edits, the measure of the rules that is made of them, and the hint."""

import pytest
from ecsim_exercises.plant import Point

from ecsim import EcsimError
from ecsim.grading import Between, Do, Exercise, Never, Scenario, Within, find_exercise
from ecsim.grading.edits import additions, edits
from ecsim.grading.hints import ALL, SOME, hint, suspect
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


def test_additions_are_conditions_and_coils_more():
    found = {edit.new for edit in additions("LD X0\nAND X1\nOUT Y0\nTON T0 0\nLD= D0 7\nOUT Y1", ["X0"], ["Y1"], ["D0"])}
    assert {"AND X1\nANI X0", "AND X1\nORI X0", "AND X1\nED", "AND X1\nAND> D0 7", "LD X0\nAND= D0 0"} <= found
    assert {"OUT Y0\nRST Y1", "OUT Y0\nSET Y1", "TON T0 7"} <= found


@pytest.fixture
def lamp(tmp_path):
    """A lamp that follows a switch while a second one is off; its rules are as good as `rules`."""

    class Lamp:
        wiring = {"X0": Point("Switch", "a switch"), "X1": Point("Lock", "a lock"), "Y0": Point("Lamp", "a lamp")}

        def step(self, seconds, outputs):
            return {}

    def make(*rules, text="// Follow the switch\nLD X0\nANI X1\nOUT Y0\n"):
        (tmp_path / "solution.il").write_text(text)
        script = lambda chosen: [
            Do({"Switch": 1}, at=chosen.at),
            Do({"Lock": 1}, after=1.0),
            Do({"Lock": 0}, after=1.0),
            Do({"Switch": 0}, after=1.0),
        ]
        scenario = Scenario("s", "The switches are moved", 6, script, {"at": Between(0.5, 1.5)}, draws=2)
        return Exercise(tmp_path, "Lamp", Lamp, [scenario], rules)

    return make


FOLLOWS = Within("follows", "The lamp follows the switch", "Switch and not Lock", "Lamp", 0.1)
LOCKED = Never("locked", "Not while it is locked", "Lamp and Lock", 1, needs="Lamp")
DARK = Never("dark", "Not without the switch", "Lamp and not Switch", 1, needs="Lamp")


def test_good_rules_catch_every_fault(lamp):
    found = mutate(lamp(FOLLOWS, LOCKED, DARK))
    assert (found.share, found.missed) == (1.0, [])
    assert sum(found.by_rule.values()) == len(found.caught) >= 6
    assert found.as_dict()["share"] == 1.0


def test_a_missing_rule_lets_faults_pass(lamp):
    found = mutate(lamp(FOLLOWS, DARK))
    assert found.share < 0.95
    assert "line 3: ANI X1 -> nothing" in map(str, found.missed)
    assert "missed  line 3: ANI X1 -> nothing" in str(found)


def test_a_line_that_does_nothing_is_no_fault(lamp):
    found = mutate(lamp(FOLLOWS, LOCKED, DARK, text="LD X0\nANI X1\nOUT Y0\nLD X5\nSET M7\n"))
    assert "line 5: SET M7 -> RST M7" in map(str, found.same)
    assert found.share == 1.0


def test_progress_is_told(lamp):
    seen = []
    mutate(lamp(FOLLOWS, LOCKED, DARK), progress=lambda done, of: seen.append((done, of)))
    assert seen[-1][0] == seen[-1][1] == len(seen)


@pytest.mark.parametrize(
    ("program", "line"),
    [
        ("// Follow the switch\nLD X0\nAND X1\nOUT Y0", "lines 2 to 4"),
        ("// Nothing here\nLD X5\nOUT M0\n\n// Follow\nLDI X0\nANI X1\nOUT Y0", "lines 6 to 8"),
        ("LD X0\nOUT Y0", "lines 1 to 2"),  # a condition is missing
    ],
)
def test_a_hint_names_the_network_and_not_the_line(lamp, program, line):
    exercise = lamp(FOLLOWS, LOCKED, DARK)
    said = hint(exercise, exercise.grade(program))
    assert line in said
    assert "X1" not in said


def test_hints_come_in_steps_and_then_the_network(lamp, tmp_path):
    exercise = lamp(FOLLOWS, LOCKED, DARK)
    (tmp_path / "hints.md").write_text("# Hints\n\n1. What locks it?\n2. Look at\n   the second switch.\n")
    report = exercise.grade("LD X0\nAND X1\nOUT Y0")
    said = [exercise.hint(report, attempt) for attempt in (1, 2, 3)]
    assert said[:2] == ["What locks it?", "Look at the second switch."]
    assert "lines 1 to 3" in said[2]
    assert exercise.hint(exercise.grade(exercise.solution)) == ""


def test_no_hint_without_a_fault_or_without_a_single_line(lamp):
    exercise = lamp(FOLLOWS, LOCKED, DARK)
    assert hint(exercise, exercise.grade(exercise.solution)) == ""
    assert "No single line" in hint(exercise, exercise.grade("LDI X0\nAND X1\nOUT Y1"))
    assert "compiler" in hint(exercise, exercise.grade("LD Q0"))


def test_a_rule_cannot_ask_for_the_steps_of_a_program_without(lamp):
    odd = Never("odd", "Odd", "Step == 'S1'")
    with pytest.raises(EcsimError, match="no lane"):
        lamp(odd).grade("LD X0\nOUT Y0")


@pytest.mark.parametrize(
    ("name", "mistake", "coils", "mends"),
    [
        ("motor", "overload_forgotten", {"RunR"}, ALL),  # AND Healthy is missing in the network of RunR
        ("motor", "no_hold", {"RunF", "RunR"}, SOME),  # OR RunF and OR RunR are missing in their networks: each mends its half
        ("star_delta", "no_hold", {"Line"}, ALL),  # OR Line
        ("star_delta", "overload_forgotten", {"Line"}, ALL),  # AND Healthy
        ("conveyor", "gate_stays_down", {"Gate"}, ALL),  # SET where OUT should be
    ],
)
def test_a_hint_finds_the_network_of_a_mistake(name, mistake, coils, mends):
    exercise = find_exercise(name)
    report = exercise.grade(exercise.mistakes[mistake][0])
    seen = []
    found = suspect(exercise, report, lambda done, of: seen.append((done, of)))
    network = next(unit for unit in report.compiled.units if unit.name == found.unit).networks[found.network]
    assert report.compiled.main.instructions[network.end - 1].written[0] in coils
    assert found.mends == mends
    assert seen == sorted(seen)
    assert 0 < seen[-1][0] <= seen[-1][1]


def test_a_program_that_does_nothing_has_a_hint(lamp):
    exercise = lamp(FOLLOWS, LOCKED, DARK)
    assert "does nothing yet" in hint(exercise, exercise.grade(""))
