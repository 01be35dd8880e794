"""Every exercise, by one measure: its solutions keep all rules, its starter does not, each mistake breaks the rule that it names."""

import re

import pytest

import ecsim
from ecsim.grading import exercise_names, find_exercise
from ecsim.grading.mutation import GOAL, mutate
from ecsim.models import get_model, model_in

EXERCISES = exercise_names()
SOLUTIONS = [(name, solution) for name in EXERCISES for solution in find_exercise(name).solutions]
MISTAKES = [(name, mistake) for name in EXERCISES for mistake in find_exercise(name).mistakes]


def test_there_are_exercises():
    assert "conveyor" in EXERCISES


@pytest.mark.parametrize(("name", "solution"), SOLUTIONS)
def test_a_correct_program_keeps_every_rule(name, solution):
    exercise = find_exercise(name)
    own = model_in(solution) or exercise.models[0]
    family = [model for model in exercise.models if get_model(model).family == get_model(own).family]
    for model in family if solution == "solution" else [own]:
        report = exercise.grade(exercise.solutions[solution], model)
        assert report.passed, str(report)


@pytest.mark.parametrize(("name", "mistake"), MISTAKES)
def test_a_mistake_breaks_the_rule_that_it_names(name, mistake):
    exercise = find_exercise(name)
    text, rule = exercise.mistakes[mistake]
    report = exercise.grade(text)
    assert report.problems == []
    assert report[rule].state == "failed", str(report)


@pytest.mark.parametrize("name", EXERCISES)
class TestExercise:
    def test_the_starter_compiles_and_is_no_solution(self, name):
        exercise = find_exercise(name)
        report = exercise.grade(exercise.starter)
        assert report.problems == []
        assert not report.passed

    def test_it_has_what_a_course_needs(self, name):
        exercise = find_exercise(name)
        assert len(exercise.solutions) >= 3
        assert len(exercise.mistakes) >= 4
        assert len({rule for _, rule in exercise.mistakes.values()}) >= 3
        assert len(exercise.hints) >= 3
        assert exercise.statement.startswith("# ")

    def test_the_statement_names_every_point(self, name):
        exercise = find_exercise(name)
        machine = find_exercise(name.partition("/")[0])  # a second task on a machine leaves the points to the first one
        assert machine is exercise or f"{machine.name}/statement.md" in exercise.statement
        points = exercise.wiring.items()
        assert [device for device, point in points if device not in machine.statement or point.name not in machine.statement] == []

    def test_names_can_stand_in_conditions_and_programs(self, name):
        names = [point.name for point in find_exercise(name).wiring.values()]
        assert [one for one in names if not re.fullmatch(r"[A-Za-z]\w{0,7}", one)] == []
        assert len({one.casefold() for one in names}) == len(names)

    def test_the_solutions_differ(self, name):
        exercise = find_exercise(name)
        programs = [ecsim.compile(text, model_in(solution) or exercise.models[0]) for solution, text in exercise.solutions.items()]
        written = [[str(instruction) for instruction in program.instructions] for program in programs]
        assert all(one != other for place, one in enumerate(written) for other in written[:place])

    def test_a_longer_search_finds_nothing_wrong_with_the_reference(self, name):
        if "/" not in name:  # a second task has the rules of the first
            exercise = find_exercise(name)
            assert exercise.grade(exercise.solution, more=3, seed=7).passed


@pytest.mark.slow
@pytest.mark.parametrize("name", ["conveyor", "motor"])  # bench/rules.py measures all of them
def test_the_rules_catch_the_faults(name):
    found = mutate(find_exercise(name), workers=2)
    assert len(found.caught) >= 20
    assert found.share >= GOAL, str(found)
