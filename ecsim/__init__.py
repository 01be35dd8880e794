"""ecsim: Emerson EC10 and EC20 PLCs, simulated in exact time."""

from .assembler import Program, assemble
from .errors import EcsimError, ProgramError
from .help import help  # noqa: A004 - the public name of the act
from .plc import Plc, SystemBlock
from .record import Recording
from .session import Session
from .views.listing import listing

__version__ = "0.1.0"
__all__ = ["EcsimError", "Plc", "Program", "ProgramError", "Recording", "Session", "SystemBlock", "compile", "help"]

Program.face = lambda program: listing(program)._repr_html_()


def compile(text: str, model: str = "EC20") -> Program:  # noqa: A001 - the public name of the act
    """The program that `text` spells, for a model; raises ProgramError with all errors."""
    return assemble(text, model)
