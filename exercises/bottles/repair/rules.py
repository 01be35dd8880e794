"""The repair is judged by the rules of the bottle machine."""

from dataclasses import replace
from pathlib import Path

from ..rules import EXERCISE as BOTTLES

EXERCISE = replace(BOTTLES, folder=Path(__file__).parent, title="Bottle machine: repair")
