"""The pallet lift with four faults in its program, to be found and mended."""

from .rules import EXERCISE

__all__ = ["EXERCISE"]
