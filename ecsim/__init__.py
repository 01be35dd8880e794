"""ecsim: Emerson EC10 and EC20 PLCs, simulated in exact time."""

from pathlib import Path

from .assembler import Program, assemble
from .errors import EcsimError, ProgramError
from .help import help  # noqa: A004 - the public name of the act
from .plc import Plc
from .project import own_lines, read_project
from .record import Recording
from .session import Session
from .system import SystemBlock
from .views.listing import listing

__version__ = "0.1.0"
__all__ = ["EcsimError", "Plc", "Program", "ProgramError", "Recording", "Session", "SystemBlock", "compile", "help"]

Program.face = lambda program: listing(program)._repr_html_()


def compile(program: "str | Path", model: str | None = None) -> Program:  # noqa: A001 - the public name of the act
    """The program of a text, an .il file or a project folder; raises ProgramError with all errors. EC20 unless the project says otherwise."""
    text, name, chosen = read_project(program)
    with own_lines(program):
        return assemble(text, model or chosen.get("model", "EC20"), name)
