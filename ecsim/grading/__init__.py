"""Exercises and their grading: a program is judged by what it makes the machine do, never by how it is written."""

from .choices import Between, OneOf, Several
from .exercise import Exercise, exercise_names, find_exercise
from .grade import Replay
from .report import Failure, Report, Verdict
from .rules import Count, Custom, Lasts, Never, Order, Within
from .run import Do, Scenario

__all__ = [
    "Between", "Count", "Custom", "Do", "Exercise", "Failure", "Lasts", "Never", "OneOf", "Order", "Replay", "Report", "Scenario",
    "Several", "Verdict", "Within", "exercise_names", "find_exercise",
]  # fmt: skip
