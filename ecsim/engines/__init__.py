"""Two engines over one form of program: compiled for speed, stepping for looking on."""

from .compiled import CompiledEngine
from .stepping import SteppingEngine
from .trace import Trace, Write

__all__ = ["CompiledEngine", "SteppingEngine", "Trace", "Write"]
