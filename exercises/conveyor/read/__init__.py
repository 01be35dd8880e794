"""The pallet lift's program, to be read before it is run."""

from .questions import READING

__all__ = ["READING"]
