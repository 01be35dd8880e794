"""Do the hints point to the fault? Every named mistake of every exercise, its hint, and the networks in which it differs from a right program.

python bench/hints.py [NAME ...] [--write]     --write fills the table in docs/grading.md

What is expected is read off the texts alone: the fewest lines by which the mistake differs from one of the solutions, and the networks
that hold them. A line that is missing counts for the networks on both sides of its place; where it could be missing in several places
alike, for each of them. So a network that was forgotten is found when one of its neighbours is named.
"""

import argparse
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
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
        theirs = [words for _, words in code(solution)]
        match = SequenceMatcher(None, [words for _, words in mine], theirs, autojunk=False)
        changes = [change for change in match.get_opcodes() if change[0] != "equal"]
        size = sum(max(i2 - i1, j2 - j1) for _, i1, i2, j1, j2 in changes)
        if nearest is None or size < nearest[0]:
            nearest = size, changes, theirs
    lines, names = set(), set()
    for _, first, last, begin, end in nearest[1]:
        for place in range(first, last) if last > first else missing(mine, first, nearest[2], begin, end):
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


def missing(mine, first, theirs, begin, end):
    """The lines on both sides of the place where theirs[begin:end] are missing, and of places further up that leave the same difference."""
    places = {first - 1, first}
    while first and mine[first - 1][1] == theirs[end - 1]:
        first, begin, end = first - 1, begin - 1, end - 1
        places |= {first - 1, first}
    return places


def measured(exercise_name, mistake):
    """What a hint mends, whether it is right, the processor's time for it, and all this as a line."""
    exercise = find_exercise(exercise_name)
    text = exercise.mistakes[mistake][0]
    report = exercise.grade(text)
    began = time.process_time()
    found = suspect(exercise, report)
    took = time.process_time() - began
    expected = differs(report.compiled, text, exercise.solutions.values())
    right = (found.unit, found.network) in expected
    networks = " ".join(str(number) for _, number in sorted(expected))
    words = f"{'right' if right else 'WRONG'} network {found.network} of {networks}, mends {found.mends}, {took:.1f} s"
    return found.mends, right, took, f"{exercise_name:18} {mistake:26} {words}"


def row(name, results):
    """A row for an exercise."""
    counts = Counter(mends for mends, *_ in results)
    right, longest = sum(right for _, right, *_ in results), max(took for _, _, took, _ in results)
    cells = [name, len(results), *(counts[mends] for mends in (ALL, SOME, NONE)), f"{right} of {len(results)}", f"{longest:.0f} s"]
    return "| " + " | ".join(map(str, cells)) + " |"


def main():
    """Measure the exercises named, or all; 0 when four of five hints are right."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="exercises; all of them unless named")
    parser.add_argument("--write", action="store_true", help=f"write the table into {pages.GRADING.name}")
    options = parser.parse_args()
    names = options.names or exercise_names()
    work = [(name, mistake) for name in names for mistake in find_exercise(name).mistakes]
    results = {name: [] for name in names}
    head = [
        "| exercise | mistakes | a change mends all | a change mends some | none found | the right network | longest |",
        "|---|---|---|---|---|---|---|",
    ]
    rows, right, total = [], 0, 0
    with ProcessPoolExecutor() as pool:
        for (name, _), result in zip(work, pool.map(measured, *zip(*work, strict=True)), strict=True):
            print(result[-1], flush=True)
            results[name].append(result)
            right, total = right + result[1], total + 1
            if len(results[name]) == len(find_exercise(name).mistakes):
                rows.append(row(name, results[name]))
                table = [*head, *rows, f"| all | {total} | | | | {right} of {total} | |"]
                if options.write:  # what is done stands, whatever happens next
                    pages.put(pages.GRADING, "hints", table)
    print(*table, sep="\n")
    return 0 if right >= 0.8 * total else 1


if __name__ == "__main__":
    raise SystemExit(main())
