"""python -m ecsim_exercises.assignments TOOL EXERCISE FOLDER: write an exercise as an assignment of nbgrader or otter-grader."""

import argparse
import sys
from pathlib import Path

from ecsim.errors import EcsimError
from ecsim.grading import exercise_names

from .notebooks import TOOLS, write


def main() -> int:
    """Write the files and say which; 2 for a wrong use."""
    parser = argparse.ArgumentParser(prog="python -m ecsim_exercises.assignments", description=__doc__.partition(": ")[2])
    parser.add_argument("tool", choices=TOOLS)
    parser.add_argument("exercise", help=f"a folder, or a name: {', '.join(exercise_names())}")
    parser.add_argument("folder", type=Path, help="the course's folder")
    options = parser.parse_args()
    try:
        written = write(options.tool, options.exercise, options.folder)
    except (EcsimError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    print("\n".join(f"wrote {path}" for path in written) or "all is there already")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
