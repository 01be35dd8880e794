"""A table on a screw, as in manual section 6.17.3: the machine of the positioning instructions."""

from .plant import Axis, ServoAmplifier

__all__ = ["Axis", "ServoAmplifier"]
