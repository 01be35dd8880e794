"""Start, stop and reversing of a motor with two contactors that must never be closed together."""

from .picture import PICTURE
from .plant import Motor
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Motor"]
