"""A motor started in star and run in delta: a sequence in time, with a lock and a pause."""

from .picture import PICTURE
from .plant import StarDelta
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "StarDelta"]
