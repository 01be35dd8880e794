"""The commands `ecsim grade` and `ecsim mutate`."""

import argparse
import json
import os
import sys
from pathlib import Path

from ..errors import EcsimError
from .classroom import grade_class
from .exercise import Exercise, exercise_names, find_exercise, place_of
from .mutation import GOAL, mutate
from .page import page, panel
from .sandbox import Judge, Limits, Submission

EXERCISE = f"a folder, or a name: {', '.join(exercise_names())}"


def add_commands(commands: argparse._SubParsersAction) -> None:
    """Give the command line of ecsim the commands of grading."""
    grading = commands.add_parser(
        "grade",
        help="grade a program, or a class",
        description="Grade a program by what a machine does under it; with a folder of submissions, a whole class. "
        "Each program runs in a process of its own, within limits of time and memory. The status is 0 when all marks are earned.",
    )
    grading.add_argument("exercise", metavar="EXERCISE", help=EXERCISE)
    grading.add_argument("answer", type=Path, metavar="ANSWER", help="an .il file, or a folder with one file or folder for each student")
    grading.add_argument("--model", help="the PLC, the exercise's first one unless given")
    grading.add_argument("--json", action="store_true", help="print the report as JSON")
    grading.add_argument("--html", type=Path, metavar="PATH", help="write the report as a page; for a class a folder of pages")
    grading.add_argument("--hint", action="store_true", help="say in which network the fault lies, where one line mends it")
    grading.add_argument("--report", type=Path, metavar="FILE.csv", help="a class: keep the marks in this table, and go on with it")
    grading.add_argument("--workers", type=int, metavar="N", help="a class: so many processes, all cores unless given")
    grading.add_argument("--scheduler", metavar="tcp://HOST:PORT", help="a class: grade on a Dask cluster")
    grading.add_argument("--seconds", type=int, default=Limits.cpu_s, help=f"processor time for each program ({Limits.cpu_s})")
    grading.add_argument("--memory", type=int, default=Limits.memory_mb, help=f"MB for each program ({Limits.memory_mb})")
    grading.set_defaults(act=_grade)
    mutants = commands.add_parser(
        "mutate",
        help="measure the rules of an exercise",
        description="Put one fault at a time into the reference solution and see which ones the rules catch. "
        f"The status is 0 when {100 * GOAL:.0f} %% are caught of those that change the machine's behaviour.",
    )
    mutants.add_argument("exercise", metavar="EXERCISE", help=EXERCISE)
    mutants.add_argument("--workers", type=int, metavar="N", help="so many processes, all cores unless given")
    mutants.add_argument("--json", action="store_true", help="print the result as JSON")
    mutants.set_defaults(act=_mutate)


def _grade(options: argparse.Namespace) -> int:
    exercise = find_exercise(options.exercise)
    limits = Limits(cpu_s=options.seconds, wall_s=3.0 * options.seconds, memory_mb=options.memory)
    if options.model is not None and options.model not in exercise.models:
        raise EcsimError(f"the exercise {exercise.name} is for {' and '.join(exercise.models)}, not for {options.model}")
    if options.answer.is_dir():
        return _grade_class(exercise, options, limits)
    if options.report or options.scheduler or options.workers:
        raise EcsimError("--report, --scheduler and --workers are for a folder of submissions")
    told: list[int] = []

    def searching(done: int, of: int) -> None:
        told.append(done)
        _bar(100 * done // max(of, 1), 100, "looking for a hint")

    with Judge(place_of(exercise), options.model, limits, options.hint, searching if sys.stderr.isatty() else None) as judge:
        report = judge.grade(Submission.read(options.answer))
    if told:
        print(file=sys.stderr)
    if options.html is not None:
        options.html.write_text(page(report.title, panel(report, styled=False)), encoding="utf-8")
    print(report.as_json() if options.json else report)
    return 0 if report.passed else 1


def _grade_class(exercise: Exercise, options: argparse.Namespace, limits: Limits) -> int:
    if options.workers is not None and options.workers < 1:
        raise EcsimError(f"{options.workers} workers; give a number from 1 on")
    bar = None if options.json or not sys.stderr.isatty() else _bar
    graded = grade_class(
        exercise, options.answer, options.report, options.html,
        model=options.model, workers=options.workers, scheduler=options.scheduler, limits=limits, hints=options.hint, progress=bar,
    )  # fmt: skip
    if bar:
        print(file=sys.stderr)
    if options.json:
        rows = [
            {"name": row.name, "marks": row.marks, "out_of": row.out_of, "rules": row.states, "reason": row.reason} for row in graded.rows
        ]
        print(json.dumps(rows, indent=1, ensure_ascii=False))
    else:
        for row in graded.rows:
            print(f"{row.name:<24} {row.marks:5g} of {row.out_of:g}  {row.reason}".rstrip())
        print(graded)
    return 0 if all(row.marks == row.out_of for row in graded.rows) else 1


def _bar(done: int, of: int, name: str) -> None:
    """One line that is written over and over: how many are graded."""
    width = 30
    filled = width * done // max(of, 1)
    print(f"\r[{'#' * filled}{'.' * (width - filled)}] {done}/{of} {name[:30]:<30}", end="", file=sys.stderr, flush=True)


def _mutate(options: argparse.Namespace) -> int:
    bar = None if options.json or not sys.stderr.isatty() else lambda done, of: _bar(done, of, "")
    found = mutate(find_exercise(options.exercise), options.workers or os.cpu_count() or 1, bar)
    if bar:
        print(file=sys.stderr)
    print(json.dumps(found.as_dict(), indent=1) if options.json else found)
    return 0 if found.share >= GOAL else 1
