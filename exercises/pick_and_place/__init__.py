"""A pick-and-place arm: it takes parts out of a nest and sets them on a place, step by step, and drops none."""

from .picture import PICTURE
from .plant import Arm
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Arm"]
