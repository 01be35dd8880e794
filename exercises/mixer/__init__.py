"""The mixer of manual section 7.5.2: a selection, two products in one vessel."""

from .picture import PICTURE
from .plant import Mixer
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Mixer"]
