"""The repair is judged by the rules of the mixer."""

from dataclasses import replace
from pathlib import Path

from ..rules import EXERCISE as MIXER

EXERCISE = replace(MIXER, folder=Path(__file__).parent, title="Mixer: repair")
