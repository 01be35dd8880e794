"""The pallet-lift conveyor of manual section 7.5.1: a simple sequence."""

from pathlib import Path

from .picture import PICTURE
from .plant import Conveyor
from .rules import EXERCISE

TITLE = "Pallet lift"
STATEMENT = Path(__file__).with_name("statement.md")
SOLUTION = Path(__file__).with_name("solution.il")

__all__ = ["EXERCISE", "PICTURE", "SOLUTION", "STATEMENT", "TITLE", "Conveyor"]
