"""An exercise as a notebook for nbgrader or otter-grader, written from its folder: task, starter, and a mark for each rule that is kept.

Notebooks are plain data here (nbformat 4.5), so that neither tool need be installed to write them.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ecsim.errors import EcsimError
from ecsim.grading import Exercise, find_exercise
from ecsim.grading.exercise import place_of

CONFIG = """\
# nbgrader grades the notebooks of this folder: python -m ecsim_exercises.assignments wrote it.
c = get_config()  # noqa: F821 - nbgrader gives it
c.CourseDirectory.course_id = "plc"
# The starter stands outside the region of the solution, so that nothing need stand in its place.
c.ClearSolutions.code_stub = {"python": "# Your program stands between the quotes above."}
# A program is ended by its own limits before that.
c.ExecutePreprocessor.timeout = 300
"""


def _cell(kind: str, name: str, text: str, **metadata: Any) -> dict[str, Any]:
    cell = {"cell_type": kind, "id": name, "metadata": metadata, "source": text.strip("\n").splitlines(keepends=True)}
    return cell | ({"execution_count": None, "outputs": []} if kind == "code" else {})


def _notebook(cells: list[dict[str, Any]]) -> str:
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return json.dumps({"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}, indent=1, ensure_ascii=False) + "\n"


def _task(exercise: Exercise) -> str:
    return (
        f"# {exercise.title}\n\nThe cell below shows the task. Write your program between the quotes of the cell after it, and run the cell "
        "behind that one as often as you like: it tries your program on the machine and says which rules it keeps. Each rule that is "
        f"kept earns its marks, {_marks(exercise):g} in all; it does not matter how the program is built."
    )


def _marks(exercise: Exercise) -> float:
    return sum(rule.marks for rule in exercise.rules)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _setting(name: str) -> str:
    return (
        "from ecsim_exercises.assignments import graded\n"
        "from IPython.display import Markdown\n\n"
        "from ecsim.grading import find_exercise\n\n"
        f"exercise = find_exercise({_quoted(name)})\n"
        "Markdown(exercise.statement)"
    )


def _answer(exercise: Exercise, begin: str, end: str) -> str:
    return f'program = r"""\n{exercise.starter.strip()}\n"""\n{begin}\nprogram = exercise.solution\n{end}'


def nbgrader_notebook(exercise: Exercise) -> str:
    """The source notebook of an assignment: one cell to be written in, one that gives the marks as nbgrader's partial credit."""
    name = place_of(exercise)

    def cell(kind: str, grade_id: str, text: str, solution: bool = False, points: float | None = None) -> dict[str, Any]:
        marks = {"grade": points is not None, "grade_id": grade_id, "locked": not solution, "schema_version": 3}
        marks |= {"solution": solution, "task": False} | ({"points": points} if points is not None else {})
        return _cell(kind, grade_id, text, nbgrader=marks)

    return _notebook(
        [
            cell("markdown", "task", _task(exercise)),
            cell("code", "setting", _setting(name)),
            cell("code", "answer", _answer(exercise, "### BEGIN SOLUTION", "### END SOLUTION"), solution=True),
            _cell("code", "try-it", f"graded({_quoted(name)}, program)"),
            cell(
                "code",
                "marks",
                f"# The marks of your program.\nfrom ecsim_exercises.assignments import graded\n\ngraded({_quoted(name)}, program).marks",
                points=_marks(exercise),
            ),
        ]
    )


def otter_notebook(exercise: Exercise) -> str:
    """The master notebook of an assignment: one question whose tests are the rules, each with its marks."""
    name = place_of(exercise)
    cells = [
        _cell("raw", "config", f"# ASSIGNMENT CONFIG\nname: {exercise.name}\nexport_cell:\n  pdf: false\ngenerate: true"),
        _cell("markdown", "task", _task(exercise)),
        _cell("code", "setting", _setting(name)),
        _cell("raw", "question", "# BEGIN QUESTION\nname: program"),
        _cell("markdown", "words", "Your program:"),
        _cell("raw", "solution", "# BEGIN SOLUTION"),
        _cell("code", "answer", _answer(exercise, "# BEGIN SOLUTION NO PROMPT", "# END SOLUTION")),
        _cell("raw", "solution-end", "# END SOLUTION"),
        _cell("raw", "tests", "# BEGIN TESTS"),
    ]
    for number, rule in enumerate(exercise.rules):
        config = f'""" # BEGIN TEST CONFIG\npoints: {rule.marks:g}\nfailure_message: {_quoted(f"not kept: {rule.words}")}'
        test = f'{config}\n"""  # END TEST CONFIG\nassert graded({_quoted(name)}, program)[{_quoted(rule.name)}].passed'
        cells.append(_cell("code", f"rule-{number}", test))
    cells += [
        _cell("raw", "tests-end", "# END TESTS"),
        _cell("raw", "question-end", "# END QUESTION"),
        _cell("code", "try-it", f"graded({_quoted(name)}, program)"),
    ]
    return _notebook(cells)


def _nbgrader_files(exercise: Exercise) -> dict[str, str]:
    name = exercise_name(exercise)
    return {f"source/{name}/{name}.ipynb": nbgrader_notebook(exercise), "nbgrader_config.py": CONFIG}


def _otter_files(exercise: Exercise) -> dict[str, str]:
    return {f"{exercise_name(exercise)}.ipynb": otter_notebook(exercise)}


TOOLS: dict[str, Callable[[Exercise], dict[str, str]]] = {"nbgrader": _nbgrader_files, "otter": _otter_files}


def exercise_name(exercise: Exercise) -> str:
    """An exercise's name as one word: mixer, mixer-repair."""
    place = place_of(exercise)
    return place.replace("/", "-") if not Path(place).is_absolute() else exercise.name


def write(tool: str, name: str, folder: Path) -> list[Path]:
    """Write the files of an exercise for a tool into a folder and say which; a configuration that is there already stays.

    Raises EcsimError, and writes nothing, when a notebook is there with another content.
    """
    if tool not in TOOLS:
        raise EcsimError(f"there is no tool {tool!r}; there are {' and '.join(TOOLS)}")
    files = {folder / place: text for place, text in TOOLS[tool](find_exercise(name)).items()}
    for path, text in files.items():
        if path.exists() and path.read_text(encoding="utf-8") != text and path.name != "nbgrader_config.py":
            raise EcsimError(f"{path} is there already and has been changed; move it away, or write into another folder")
    written = [path for path in files if not path.exists()]
    for path in written:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(files[path], encoding="utf-8")
    return written
