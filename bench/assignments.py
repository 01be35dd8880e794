"""nbgrader and otter-grader on one exercise, by their own command line: the marks must be those of `ecsim grade`.

python bench/assignments.py install      each tool with ecsim in an environment of its own, build/nbgrader and build/otter
python bench/assignments.py [NAME]       write the assignment (mixer unless named), hand in some programs, grade them, compare
"""

import argparse
import json
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import venv
from pathlib import Path

from ecsim_exercises.assignments import graded
from ecsim_exercises.assignments.notebooks import exercise_name, write

from ecsim.grading import find_exercise
from ecsim.models import model_in

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
TOOLS = {"nbgrader": "nbgrader>=0.9,<0.10", "otter": "otter-grader>=6,<8"}


def tool(name: str) -> Path:
    """The command of a tool."""
    return BUILD / name / ("Scripts" if os.name == "nt" else "bin") / name


def install() -> None:
    """Make the two environments. The tools choose their own versions of what ecsim needs, within its ranges."""
    for name, wanted in TOOLS.items():
        venv.create(BUILD / name, with_pip=True, clear=True)
        python = tool(name).with_name("python")
        subprocess.run([python, "-m", "pip", "install", "--quiet", wanted, "ipykernel", "--editable", str(ROOT)], check=True)


def run(name: str, *arguments: str, folder: Path) -> None:
    """A tool's command; its output is shown when it fails."""
    path = os.pathsep.join([str(tool(name).parent), os.environ["PATH"]])
    done = subprocess.run(
        [tool(name), *arguments], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True, timeout=900
    )
    if done.returncode:
        print(done.stdout[-3000:], done.stderr[-3000:], file=sys.stderr)
        raise SystemExit(f"{name} {' '.join(arguments)} ended with {done.returncode}")


def programs(exercise_name: str) -> dict[str, str]:
    """What the students hand in: right, partly right, begun, not to be compiled, and a loop that keeps the watchdog quiet."""
    exercise = find_exercise(exercise_name)
    mistakes = exercise.mistakes
    return {
        "right": [text for name, text in exercise.solutions.items() if model_in(name) is None][-1],
        "partly": mistakes[min(mistakes)][0],
        "begun": exercise.starter,
        "unreadable": "LD X0\nOUT Q0\n",
        "endless": "LBL 1\nLD SM0\nWDT\nCJ 1\n",
    }


def handed_in(notebook: str, program: str) -> str:
    """A student's notebook: the released one with a program between the quotes."""
    cells = json.loads(notebook)
    for cell in cells["cells"]:
        text = "".join(cell["source"])
        if text.startswith('program = r"""'):
            cell["source"] = re.sub(r'r""".*?"""', lambda _: f'r"""\n{program}\n"""', text, flags=re.DOTALL)
            return json.dumps(cells)
    raise SystemExit("the released notebook has no cell to write in")


def by_nbgrader(name: str, texts: dict[str, str], course: Path) -> dict[str, float]:
    """The marks that nbgrader keeps, by student."""
    exercise = exercise_name(find_exercise(name))
    write("nbgrader", name, course)
    run("nbgrader", "generate_assignment", exercise, folder=course)
    released = (course / "release" / exercise / f"{exercise}.ipynb").read_text(encoding="utf-8")
    if "exercise.solution" in released:
        raise SystemExit("the released notebook shows the solution")
    for student, program in texts.items():
        place = course / "submitted" / student / exercise
        place.mkdir(parents=True)
        (place / f"{exercise}.ipynb").write_text(handed_in(released, program), encoding="utf-8")
    run("nbgrader", "autograde", exercise, folder=course)
    run("nbgrader", "generate_feedback", exercise, folder=course)
    run("nbgrader", "export", "--to", "marks.csv", folder=course)
    with sqlite3.connect(course / "gradebook.db") as book:
        rows = book.execute(
            "select submitted_assignment.student_id, sum(grade.auto_score) from grade join submitted_notebook on grade.notebook_id ="
            " submitted_notebook.id join submitted_assignment on submitted_notebook.assignment_id = submitted_assignment.id group by 1"
        )
        return dict(rows.fetchall())


def by_otter(name: str, texts: dict[str, str], course: Path) -> dict[str, float]:
    """The marks that otter-grader writes down, by student."""
    exercise = exercise_name(find_exercise(name))
    write("otter", name, course)
    run("otter", "assign", f"{exercise}.ipynb", "dist", folder=course)
    released = (course / "dist" / "student" / f"{exercise}.ipynb").read_text(encoding="utf-8")
    if "exercise.solution" in released:
        raise SystemExit("the student's notebook shows the solution")
    (archive,) = (course / "dist" / "autograder").glob("*.zip")
    found = {}
    for student, program in texts.items():
        place = course / student
        place.mkdir()
        (place / f"{exercise}.ipynb").write_text(handed_in(released, program), encoding="utf-8")
        run("otter", "run", "--autograder", str(archive), "--output-dir", str(place), str(place / f"{exercise}.ipynb"), folder=course)
        results = json.loads((place / "results.json").read_text(encoding="utf-8"))
        found[student] = round(sum(test.get("score", 0) for test in results["tests"]), 6)
    return found


ENGINES = {"nbgrader": by_nbgrader, "otter": by_otter}


def compare(name: str) -> bool:
    """Grade by both tools and print the marks beside those of `ecsim grade`."""
    texts = programs(name)
    wanted = {student: graded(name, text).marks for student, text in texts.items()}
    found = {}
    for engine, grade in ENGINES.items():
        course = BUILD / "assignments" / engine
        shutil.rmtree(course, ignore_errors=True)
        course.mkdir(parents=True)
        found[engine] = grade(name, texts, course)
    print(f"{'':12} {'ecsim':>8} " + " ".join(f"{engine:>8}" for engine in found))
    for student, marks in wanted.items():
        print(f"{student:12} {marks:8g} " + " ".join(f"{given[student]:8g}" for given in found.values()))
    return all(given[student] == marks for given in found.values() for student, marks in wanted.items())


def main() -> int:
    """Install, or compare; 0 when all marks agree."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("exercise", nargs="?", default="mixer", help="an exercise, or install")
    options = parser.parse_args()
    if options.exercise == "install":
        install()
        return 0
    lacking = [name for name in TOOLS if not tool(name).exists()]
    if lacking:
        print(f"not installed: {' and '.join(lacking)}; python bench/assignments.py install", file=sys.stderr)
        return 2
    return 0 if compare(options.exercise) else 1


if __name__ == "__main__":
    raise SystemExit(main())
