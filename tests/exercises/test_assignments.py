"""Exercises as assignments of nbgrader and otter-grader; bench/assignments.py goes their whole way by their own command line."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from ecsim_exercises.assignments import graded
from ecsim_exercises.assignments.notebooks import TOOLS, exercise_name, write

from ecsim import EcsimError
from ecsim.grading import exercise_names, find_exercise

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "exercises" / "assignments"
INSTALLED = [(ROOT / "build" / tool).exists() for tool in TOOLS]


def cells(path):
    return json.loads(path.read_text(encoding="utf-8"))["cells"]


def text(cell):
    return "".join(cell["source"])


@pytest.mark.parametrize("tool", TOOLS)
def test_the_mixer_that_lies_ready_is_what_would_be_written(tool, tmp_path):
    written = write(tool, "mixer", tmp_path)
    assert written != []
    assert {path.relative_to(tmp_path): path.read_text() for path in written} == {
        path.relative_to(HERE / tool): path.read_text() for path in (HERE / tool).rglob("*.*") if path.is_file()
    }


@pytest.mark.parametrize("name", exercise_names())
@pytest.mark.parametrize("tool", TOOLS)
def test_every_exercise_can_be_an_assignment(tool, name, tmp_path):
    notebook = next(path for path in write(tool, name, tmp_path) if path.suffix == ".ipynb")
    exercise = find_exercise(name)
    assert notebook.stem == exercise_name(exercise)
    for number, cell in enumerate(cells(notebook)):
        if cell["cell_type"] == "code":
            compile(text(cell), f"{name} {number}", "exec")
    (answer,) = [cell for cell in cells(notebook) if text(cell).startswith("program = ")]
    names = {"exercise": exercise}
    exec(text(answer).partition("\n#")[0], names)
    assert names["program"].strip() == exercise.starter.strip()
    exec(text(answer), names)
    assert names["program"] == exercise.solution


def test_nbgrader_gives_all_marks_in_one_locked_cell(tmp_path):
    write("nbgrader", "mixer", tmp_path)
    marked = [cell["metadata"]["nbgrader"] for cell in cells(tmp_path / "source/mixer/mixer.ipynb") if "nbgrader" in cell["metadata"]]
    assert [(one["points"], one["locked"], one["solution"]) for one in marked if one["grade"]] == [(23, True, False)]
    assert [one["grade_id"] for one in marked if one["solution"]] == ["answer"]
    assert len({one["grade_id"] for one in marked}) == len(marked)


def test_otter_has_a_test_with_its_marks_for_each_rule(tmp_path):
    write("otter", "mixer", tmp_path)
    tests = [text(cell) for cell in cells(tmp_path / "mixer.ipynb") if "BEGIN TEST CONFIG" in text(cell)]
    rules = find_exercise("mixer").rules
    assert len(tests) == len(rules)
    for test, rule in zip(tests, rules, strict=True):
        assert f'["{rule.name}"].passed' in test
        assert f"points: {rule.marks:g}\n" in test


def test_a_report_from_apart_has_the_graders_marks():
    mistake, rule = find_exercise("motor").mistakes["no_hold"]
    report = graded("motor", mistake)
    assert report[rule].state == "failed"
    here = find_exercise("motor").grade(mistake)
    assert [(one.rule, one.state, one.marks) for one in report.verdicts] == [(one.rule, one.state, one.marks) for one in here.verdicts]
    assert graded("motor", "LD Q0").marks == 0


def test_what_a_teacher_has_changed_is_not_written_over(tmp_path):
    (config,) = [path for path in write("nbgrader", "motor", tmp_path) if path.suffix == ".py"]
    config.write_text("c = get_config()\n")
    assert write("nbgrader", "motor", tmp_path) == []
    assert [path.stem for path in write("nbgrader", "tank", tmp_path)] == ["tank"]
    assert config.read_text() == "c = get_config()\n"
    notebook = tmp_path / "source/tank/tank.ipynb"
    notebook.write_text("{}")
    with pytest.raises(EcsimError, match="has been changed"):
        write("nbgrader", "tank", tmp_path)
    assert notebook.read_text() == "{}"


@pytest.mark.parametrize(("arguments", "words"), [(("otter", "nothing"), "no exercise 'nothing'"), (("moodle", "motor"), "invalid choice")])
def test_a_wrong_use_is_told_in_words(arguments, words, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "ecsim_exercises.assignments", *arguments, tmp_path / "course"], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 2
    assert words in done.stderr
    assert not (tmp_path / "course").exists()


@pytest.mark.slow
@pytest.mark.skipif(not all(INSTALLED), reason="nbgrader and otter-grader are not there: python bench/assignments.py install")
def test_both_tools_give_the_graders_marks():
    done = subprocess.run([sys.executable, ROOT / "bench" / "assignments.py", "motor"], capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr
