"""Exercises as assignments of nbgrader and otter-grader: the notebooks that they take, and what those ask about a program.

`python -m ecsim_exercises.assignments nbgrader mixer course/` writes them; README.md beside this file says what comes before and after.
"""

from functools import cache

from ecsim.grading import Report
from ecsim.grading.sandbox import Judge, Submission

__all__ = ["graded"]


@cache
def graded(exercise: str, program: str) -> Report:
    """The report of `ecsim grade` on a program text, from a process of its own within limits of time and memory; made once for each text.

    A program that cannot be graded has a report without marks, whose `reason` says why. Raises EcsimError for an exercise that is not there.
    """
    with Judge(exercise) as judge:
        return judge.grade(Submission("program", {"program.il": program.encode()}))
