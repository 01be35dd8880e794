"""Hints name the network at fault and what to look at there, and never show the answer."""

import pytest

from ecsim.grading import Never, Within, find_exercise
from ecsim.grading.hints import ALL, NONE, SOME, Hint, hint, suspect


@pytest.mark.parametrize(
    ("program", "line"),
    [
        ("// Follow the switch\nLD X0\nAND X1\nOUT Y0", "lines 2 to 4"),
        ("// Nothing here\nLD X5\nOUT M0\n\n// Follow\nLDI X0\nANI X1\nOUT Y0", "lines 6 to 8"),
        ("LD X0\nOUT Y0", "lines 1 to 2"),  # a condition is missing
    ],
)
def test_a_hint_names_the_network_and_not_the_line(lamp, program, line):
    exercise = lamp()
    said = hint(exercise, exercise.grade(program))
    assert line in said
    assert "X1" not in said
    assert said.endswith("Ask yourself what switches Y0 ON, and what OFF.")


def test_hints_come_in_steps_and_then_the_network(lamp, tmp_path):
    exercise = lamp()
    (tmp_path / "hints.md").write_text("# Hints\n\n1. What locks it?\n2. Look at\n   the second switch.\n")
    report = exercise.grade("LD X0\nAND X1\nOUT Y0")
    said = [exercise.hint(report, attempt) for attempt in (1, 2, 3)]
    assert said[:2] == ["What locks it?", "Look at the second switch."]
    assert "lines 1 to 3" in said[2]
    assert exercise.hint(exercise.grade(exercise.solution)) == ""


def test_no_hint_without_a_fault_or_without_a_single_line(lamp):
    exercise = lamp()
    assert hint(exercise, exercise.grade(exercise.solution)) == ""
    odd = lamp(*exercise.rules, Never("odd", "What no program can keep", "Switch"))
    assert "No single change" in hint(odd, odd.grade(odd.solution))
    assert "compiler" in hint(exercise, exercise.grade("LD Q0"))


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
    code = [" ".join(one.partition("//")[0].split()) for one in exercise.solution.splitlines()]
    assert not [one for one in code if " " in one and one in str(found)]
    assert seen == sorted(seen)
    assert 0 < seen[-1][0] <= seen[-1][1]


def test_a_program_that_does_nothing_has_a_hint(lamp):
    exercise = lamp()
    assert "does nothing yet" in hint(exercise, exercise.grade(""))


LATCHED = """LD SM1
SET S0
STL S0
LD X0
SET S20
STL S20
OUT Y0
RET"""


def test_a_network_that_is_missing_is_told_of(lamp):
    """Nothing lets S20 end: no line of the program can be changed so that it does when the switch goes OFF."""
    exercise = lamp(
        Within("on", "The lamp is lit", "Switch", "Lamp", 0.1),
        Within("stays", "And stays so", "held(Switch, 0.5)", "Lamp", 0.01),
        Never("dark", "Not without the switch", "Lamp and not Switch", 1, needs="Lamp"),
    )
    found = suspect(exercise, exercise.grade(LATCHED))
    assert (found.network, found.mends, found.missing) == (4, ALL, True)
    assert str(found) == (
        "Something is missing behind network 4 of MAIN, line 7: it makes the difference. Ask yourself what else has to happen in step S20."
    )


@pytest.mark.parametrize(
    ("program", "question"),
    [
        ("LD SM0\nTON T0 500\nLD X0\nANI X1\nAND T0\nOUT Y0", "when T0 begins, and how long it is to take"),
        ("LD SM0\nMOV 5 D0\nLD X0\nANI X1\nAND= D0 6\nOUT Y0", "when D0 changes, and to what"),
    ],
)
def test_a_hint_asks_about_what_its_network_does(lamp, program, question):
    """The lamp never lights up; what keeps it dark is as well to be found in the first network as in the second."""
    exercise = lamp()
    found = suspect(exercise, exercise.grade(program))
    asked = {0: question, 1: "what switches Y0 ON, and what OFF"}
    assert found.mends == ALL
    assert found.look == asked[found.network]


def test_where_nothing_is_certain_the_order_of_suspicion_is_told(lamp):
    exercise = lamp(*lamp().rules, Never("odd", "What no program can keep", "Switch"))
    found = suspect(exercise, exercise.grade("LD X5\nOUT M7\nLD X0\nOUT M0\nLD M0\nOUT Y0"))
    assert (found.network, found.others, found.mends) == (2, (1, 0), NONE)
    assert str(found).startswith("No single change was found that mends the program. Begin with network ")
    one = Hint("MAIN", 3, "", (7, 9), NONE, False, "what switches Y0 ON, and what OFF", (2, 5))
    assert str(one) == (
        "No single change was found that mends the program. Begin with network 3 of MAIN, lines 7 to 9: it has to do with what broke first, "
        "then with networks 2 and 5. Ask yourself what switches Y0 ON, and what OFF."
    )
