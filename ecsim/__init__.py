"""ecsim: Emerson EC10 and EC20, Inovance H1U and H2U PLCs, simulated in exact time."""

from pathlib import Path

from .assembler import Program
from .errors import EcsimError, ProgramError
from .help import help  # noqa: A004 - the public name of the act
from .modbus import serve
from .monitor import Monitor
from .plc import Plc
from .project import Project
from .record import Recording
from .session import Session
from .system import SystemBlock
from .views.listing import listing
from .views.monitor import table

__version__ = "0.1.0"
__all__ = ["EcsimError", "Plc", "Program", "ProgramError", "Project", "Recording", "Session", "SystemBlock", "compile", "help", "serve"]

Program.face = lambda program: listing(program)._repr_html_()
Monitor.face = table


def compile(program: "str | Path | Project", model: str | None = None) -> Program:  # noqa: A001 - the public name of the act
    """The program of a text, an .il file, a project folder or a Project; raises ProgramError with all errors. EC20 unless the project says otherwise."""
    return Project.of(program).compile(model)
