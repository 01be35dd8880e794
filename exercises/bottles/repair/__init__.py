"""The bottle machine with five faults in its program, to be found and mended."""

from .rules import EXERCISE

__all__ = ["EXERCISE"]
