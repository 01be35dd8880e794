"""A water tank that two pumps keep full: hysteresis between level switches, pumps that take turns, and a watch on leaks."""

from .picture import PICTURE
from .plant import Tank
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Tank"]
