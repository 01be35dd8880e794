"""A garage door with one key: every press means what the door's state makes of it."""

from .picture import PICTURE
from .plant import Garage
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Garage"]
