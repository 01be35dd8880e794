"""Do the hints point to the fault? Every named mistake of every exercise, its hint, and the networks in which it differs from a right program.

python bench/hints.py [NAME ...] [--write]     --write fills the table in docs/grading.md

What is expected is read off the texts alone: the fewest lines by which the mistake differs from one of the solutions, and the networks
that hold them. A line that is missing counts for the networks on both sides of its place.
"""

import argparse
import time
from difflib import SequenceMatcher

import pages

from ecsim.grading import exercise_names, find_exercise
from ecsim.grading.hints import ALL, NONE, SOME, suspect


def code(text):
    """(line number, code) of the lines that are not empty, without comments."""
    lines = [(number, " ".join(line.partition("//")[0].split())) for number, line in enumerate(text.splitlines(), 1)]
    return [(number, words) for number, words in lines if words]


def differs(program, text, solutions):
    """(unit, number) of the networks in which a program differs from the solution that is nearest to it."""
    mine, nearest = code(text), None
    for solution in solutions:
        match = SequenceMatcher(None, [words for _, words in mine], [words for _, words in code(solution)], autojunk=False)
        changes = [change for change in match.get_opcodes() if change[0] != "equal"]
        size = sum(max(i2 - i1, j2 - j1) for _, i1, i2, j1, j2 in changes)
        if nearest is None or size < nearest[0]:
            nearest = size, changes
    lines, names = set(), set()
    for _, first, last, _, _ in nearest[1]:
        for place in range(first, last) if last > first else (first - 1, first):
            if 0 <= place < len(mine):
                lines.add(mine[place][0])
                if last > first and " AT " in mine[place][1]:
                    names.add(mine[place][1].split()[0])
    found = set()
    for unit in program.units:
        for network in unit.networks:
            instructions = unit.instructions[network.start : network.end]
            if any(one.line in lines or names & set(one.written) for one in instructions):
                found.add((unit.name, network.number))
    return found


def measured(name):
    """A row for an exercise; each mistake is printed."""
    exercise = find_exercise(name)
    counts, right, longest = dict.fromkeys((ALL, SOME, NONE), 0), 0, 0.0
    for mistake, (text, _) in exercise.mistakes.items():
        report = exercise.grade(text)
        began = time.process_time()
        found = suspect(exercise, report)
        took = time.process_time() - began
        expected = differs(report.compiled, text, exercise.solutions.values())
        good = (found.unit, found.network) in expected
        networks = " ".join(str(number) for _, number in sorted(expected))
        print(
            f"{name:18} {mistake:26} {'right' if good else 'WRONG'} network {found.network} of {networks}, mends {found.mends}, {took:.1f} s",
            flush=True,
        )
        counts[found.mends] += 1
        right += good
        longest = max(longest, took)
    total = sum(counts.values())
    cells = [name, total, counts[ALL], counts[SOME], counts[NONE], f"{right} of {total}", f"{longest:.0f} s"]
    return right, total, "| " + " | ".join(map(str, cells)) + " |"


def main():
    """Measure the exercises named, or all; 0 when four of five hints are right."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="exercises; all of them unless named")
    parser.add_argument("--write", action="store_true", help=f"write the table into {pages.GRADING.name}")
    options = parser.parse_args()
    rows = [measured(name) for name in options.names or exercise_names()]
    right, total = sum(row[0] for row in rows), sum(row[1] for row in rows)
    head = [
        "| exercise | mistakes | one line mends all | one line mends some | none found | the right network | longest |",
        "|---|---|---|---|---|---|---|",
    ]
    table = "\n".join([*head, *(row for _, _, row in rows), f"| all | {total} | | | | {right} of {total} | |"])
    print(table)
    if options.write:
        pages.put(pages.GRADING, "hints", table.splitlines())
    return 0 if right >= 0.8 * total else 1


if __name__ == "__main__":
    raise SystemExit(main())
