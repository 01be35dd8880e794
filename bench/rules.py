"""How good are the rules? Single-edit faults in each reference solution, and the share that the exercise's rules catch.

python bench/rules.py [NAME ...] [--workers N] [--write]     --write fills the table in docs/grading.md
"""

import argparse
import os
import time

import pages

from ecsim.grading import exercise_names, find_exercise
from ecsim.grading.mutation import GOAL, mutate


def measured(name, workers):
    """One row of the table; what was missed is printed."""
    began = time.perf_counter()
    exercise = find_exercise(name)
    report = exercise.grade(exercise.solution)
    found = mutate(exercise, workers=workers)
    print(found, flush=True)
    total = len(found.caught) + len(found.missed)
    graded = f"{report.took_s:.2f} s for {report.simulated_s / 3600:.1f} h" if report.simulated_s > 3600 else f"{report.took_s:.2f} s"
    return found.share, (
        f"| {exercise.title} | {len(exercise.rules)} | {graded} | {len(found.caught)} of {total} | {found.share:.1%} "
        f"| {time.perf_counter() - began:.0f} s |"
    )


def main():
    """Measure the exercises named, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="exercises; all of them unless named")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--write", action="store_true", help=f"write the table into {pages.GRADING.name}")
    options = parser.parse_args()
    names = options.names or [name for name in exercise_names() if "/" not in name]  # a second task has the rules of the first
    rows = [measured(name, options.workers) for name in names]
    table = "\n".join(
        ["| exercise | rules | the reference graded in | faults caught | share | measured in |", "|---|---|---|---|---|---|"]
        + [row for _, row in rows]
    )
    print(table)
    if options.write:
        pages.put(pages.GRADING, "rules", table.splitlines())
    return 0 if all(share >= GOAL for share, _ in rows) else 1


if __name__ == "__main__":
    raise SystemExit(main())
