"""The repair is judged by the rules of the pallet lift."""

from dataclasses import replace
from pathlib import Path

from ..rules import EXERCISE as CONVEYOR

EXERCISE = replace(CONVEYOR, folder=Path(__file__).parent, title="Pallet lift: repair")
