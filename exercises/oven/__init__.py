"""An oven with a heater behind a relay: a temperature loop with time-proportioned output, and what makes it safe."""

from .picture import PICTURE
from .plant import Oven
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Oven"]
