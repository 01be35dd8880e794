"""A pedestrian crossing on demand: a sequence in time that must never show two greens."""

from .picture import PICTURE
from .plant import Crossing
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Crossing"]
