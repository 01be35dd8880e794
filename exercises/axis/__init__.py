"""A table on a screw, as in manual section 6.17.3: the machine of the positioning instructions."""

from .picture import PICTURE
from .plant import Axis, ServoAmplifier
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "Axis", "ServoAmplifier"]
