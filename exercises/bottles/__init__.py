"""The bottle machine of manual section 7.5.3: three stations of a turntable that work at the same time."""

from .picture import PICTURE
from .plant import BottleMachine
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "BottleMachine"]
