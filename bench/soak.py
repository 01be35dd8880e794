"""Random programs on both engines for as long as wanted: what tests/engines/test_differential.py does in seconds.

    .venv/bin/python bench/soak.py                 for a minute
    .venv/bin/python bench/soak.py --minutes 60 --first 100000
    .venv/bin/python bench/soak.py --first 4711 --count 1    one of them again

Each program has a number, which is all that chance depends on. A program on which the engines part is made as small as it
can be and printed; the exit code is then 1.
"""

import argparse
import random
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from ecsim.assembler import assemble
from ecsim.errors import EcsimError
from tests.engines.random_programs import random_program
from tests.engines.side_by_side import run_side_by_side

MODELS = ("EC20", "EC20", "EC20", "EC10")


def trouble(text: str, number: int, scans: int) -> str:
    """What goes wrong with a program, in a line; nothing when the machines agree."""
    try:
        run_side_by_side(text, random.Random(number), scans, MODELS[number % len(MODELS)])
    except Exception as error:  # whatever it is, it is what the soak looks for
        return f"{type(error).__name__}: {str(error).splitlines()[0]}"
    return ""


def smaller(text: str, model: str, fails: Callable[[str], bool]) -> str:
    """The program with as few lines as still compile and fail."""

    def still(lines: list[str]) -> bool:
        try:
            assemble("\n".join(lines), model)
        except EcsimError:
            return False
        return fails("\n".join(lines))

    lines, before = text.split("\n"), None
    while lines != before:
        before = lines
        length = max(1, len(lines) // 2)
        while length:
            place = 0
            while place < len(lines):
                rest = lines[:place] + lines[place + length :]
                if still(rest):
                    lines = rest
                else:
                    place += length
            length //= 2
    return "\n".join(lines)


def main() -> int:
    """Run, and tell how many programs, instructions and scans agreed."""
    parser = argparse.ArgumentParser(description="Run random programs on both engines and compare them.")
    parser.add_argument("--minutes", type=float, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first program")
    parser.add_argument("--count", type=int, help="how many programs, instead of how long")
    parser.add_argument("--size", type=int, default=6, help="about how many structures a main program has")
    parser.add_argument("--scans", type=int, default=20)
    options = parser.parse_args()
    began, lines, found, number = time.monotonic(), 0, 0, options.first
    while number < options.first + options.count if options.count else time.monotonic() - began < 60 * options.minutes:
        model = MODELS[number % len(MODELS)]
        text = random_program(random.Random(-1 - number), options.size, model)
        lines += text.count("\n") + 1
        wrong = trouble(text, number, options.scans)
        if wrong:
            found += 1
            small = smaller(text, model, lambda rest, number=number: bool(trouble(rest, number, options.scans)))
            print(f"program {number} ({model}): {trouble(small, number, options.scans) or wrong}\n{small}\n", flush=True)
        number += 1
    done = number - options.first
    print(f"{done} programs, {lines} lines, {done * options.scans} scans on three machines each: {found} part")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
