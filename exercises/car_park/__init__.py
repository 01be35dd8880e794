"""A car park with one lane for both ways: two light barriers tell by their order what comes in and what goes out."""

from .picture import PICTURE
from .plant import CarPark, Visit
from .rules import EXERCISE

__all__ = ["EXERCISE", "PICTURE", "CarPark", "Visit"]
