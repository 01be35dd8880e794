"""How long a class takes: 200 submissions to an exercise, right ones, typical mistakes, slips, loops without end, refused programs.

python bench/classroom.py [NAME] [--count N] [--workers N] [--write]     --write fills the table in docs/performance.md
"""

import argparse
import os
import random
import resource
import tempfile
import time
from pathlib import Path

import pages

from ecsim.grading import find_exercise
from ecsim.grading.classroom import grade_class
from ecsim.grading.edits import edits
from ecsim.grading.sandbox import Judge, Submission
from ecsim.models import model_in

LOOP = "LBL 1\nLD SM0\nCJ 1\n"  # the watchdog ends it
REFUSED = ("LD X0\nOUT Q0\n", "import os\n", "LD X0\n", "STL S0\nSTL\n")


def submissions(exercise, count):
    """Name -> program: a third right, a third slips of the hand, the rest mistakes, the starter, loops and what does not compile."""
    chance = random.Random(1)
    right = [text for name, text in exercise.solutions.items() if model_in(name) is None]
    wrong = [text for text, _ in exercise.mistakes.values()]
    slips = [edit.text for edit in edits(exercise.solution)]
    kinds = [
        lambda: chance.choice(right), lambda: chance.choice(slips), lambda: chance.choice(wrong), lambda: chance.choice(right),
        lambda: chance.choice(slips), lambda: chance.choice([exercise.starter, LOOP, *REFUSED]),
    ]  # fmt: skip
    # A comment of its own makes each text another one.
    return {f"student{number:03}": f"// {number}\n{kinds[number % len(kinds)]()}" for number in range(count)}


def measured(name, count, workers):
    """What one right submission takes, and the class: seconds of the wall and of the processor, and the marks."""
    exercise = find_exercise(name)
    with Judge(name) as judge:
        judge.grade(Submission("warm", {"a.il": b"LD X0\nOUT Q0\n"}))
        began = time.perf_counter()
        one = judge.grade(Submission("one", {"a.il": exercise.solution.encode()}))
        alone = time.perf_counter() - began
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "submissions"
        folder.mkdir()
        for student, text in submissions(exercise, count).items():
            (folder / f"{student}.il").write_text(text, encoding="utf-8")
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        graded = grade_class(exercise, folder, Path(place) / "marks.csv", Path(place) / "report", workers=workers)
        took = time.perf_counter() - began
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    full = sum(row.marks == row.out_of for row in graded.rows)
    none = sum(row.marks == 0 for row in graded.rows)
    return one, alone, took, cpu, full, none, len(graded.rows)


def main():
    """Measure and print; 0 when a submission takes less than 2 s and the class less than 90 s."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", nargs="?", default="mixer")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--write", action="store_true", help=f"write the table into {pages.PERFORMANCE.name}")
    options = parser.parse_args()
    one, alone, took, cpu, full, none, count = measured(options.name, options.count, options.workers)
    table = "\n".join(
        [
            f"`python bench/classroom.py --write`, {options.workers} workers; the machine's load was {os.getloadavg()[0]:.1f}.",
            "",
            "| | wall clock | processor | to stay below |",
            "|---|---|---|---|",
            f"| a right program for the {options.name}, {one.runs} runs, {one.simulated_s / 3600:.1f} h of plant time | {alone:.2f} s | | 2 s |",
            f"| {count} submissions, {full} with all marks, {none} with none, with pages | {took:.0f} s | {cpu:.0f} s | 90 s |",
        ]
    )
    print(table)
    if options.write:
        pages.put(pages.PERFORMANCE, "classroom", table.splitlines())
    return 0 if alone < 2 and took < 90 else 1


if __name__ == "__main__":
    raise SystemExit(main())
