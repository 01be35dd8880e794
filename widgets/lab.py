"""The lab: one simulation with all its panels on the page."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ecsim.assembler import Program
from ecsim.errors import EcsimError
from ecsim.plc import Plc
from ecsim.session import Session

from .chart import Chart
from .devices import Devices
from .editor import Editor
from .ladder import Ladder
from .machine import Machine
from .microscope import Microscope
from .panel import Panel, Part
from .rig import Rig
from .timers import Timers
from .trace import Trace
from .transport import Transport
from .unit import Unit

PARTS = {part.key: part for part in (Transport, Unit, Machine, Chart, Ladder, Microscope, Trace, Timers, Devices, Editor)}


def parts_of(rig: Rig) -> list[str]:
    """The panels that have something to show: no machine without a picture, no chart without steps; the editor stands alone."""
    shown = {"editor": False, "machine": rig.picture is not None, "chart": bool(rig.charted)}
    return [key for key in PARTS if shown.get(key, True)]


def _names(what: str, names: Iterable[str]) -> tuple[str, ...]:
    """The names that an argument lists; raises EcsimError for what is no list of names."""
    found = (None,) if isinstance(names, str) or not isinstance(names, Iterable) else tuple(names)
    if not all(isinstance(name, str) for name in found):
        raise EcsimError(f'{what}= takes a list of names, such as ["D0", "X5"], not {names!r:.60}')
    return found


class Lab(Panel):
    """A PLC with its program, its plant and all panels, running on its own.

    `model` is a model's name or a Plc, `program` what `Plc.load` takes, `plant` a machine with `wiring` and `step`,
    `picture` its drawing. `controls` says what drives an input: "switch" (the default), "push", "latch" or "stop".
    `devices` are watched in the device table, ["D0", "D100-D120:REAL"]; without it those that the program names.
    `trace` names the lanes of the logic analyser, "S" the steps; without it the terminals of the machine and the steps.
    It takes the place of a lab of the same `name`, which is stopped and closed, so running a cell again leaves one simulation.
    `speed` is times real time, None as fast as it goes; `autostart=False` leaves it paused. Raises ProgramError and EcsimError
    for what it cannot take; then a lab of the same name goes on.
    """

    _labs: dict[str, Lab] = {}

    def __init__(
        self,
        model: str | Plc = "EC20",
        program: str | Path | Program | None = None,
        plant: Any = None,
        picture: Any = None,
        *,
        name: str = "lab",
        speed: float | None = 1.0,
        autostart: bool = True,
        controls: Mapping[str, str] | None = None,
        title: str = "",
        devices: Iterable[str] = (),
        trace: Iterable[str] = (),
    ):
        devices, trace = _names("devices", devices), _names("trace", trace)
        plc = model if isinstance(model, Plc) else Plc(model)
        if program is not None:
            plc.load(program)
        session = Session(plc, plant=plant, name=name, speed=speed)
        self.name = name
        title = title or re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(plant).__name__) if plant is not None else ""
        rig = Rig(plc, session, picture=picture, controls=controls, title=title, devices=devices, traced=trace)
        super().__init__(rig)
        if name in self._labs:
            self._labs[name].close()
        self._labs[name] = self
        session.trace_frames = True
        if autostart:
            session.run()

    @classmethod
    def named(cls, name: str) -> Lab | None:
        """The lab of that name, None where there is none."""
        return cls._labs.get(name)

    def chosen(self) -> list[type[Part]]:
        return [PARTS[key] for key in parts_of(self.rig)]

    @property
    def plc(self) -> Plc:
        """The PLC; reading it and setting inputs from a cell is safe while it runs."""
        return self.rig.plc

    @property
    def session(self) -> Session:
        """What runs the PLC: run, pause, scan, next_step, back, reset, speed, set."""
        return self.rig.session

    def panel(self, key: str) -> Panel:
        """One panel of this lab alone: "transport", "unit", "machine", "chart", "ladder", "microscope", "trace", "timers", "devices",
        "editor"."""
        there = [*parts_of(self.rig), Editor.key]
        if key not in there:
            raise ValueError(f"there is no panel {key!r} here; there are {', '.join(there)}")
        return Panel(self.rig, [PARTS[key]])

    def stop(self) -> None:
        """End the simulation; raises what went wrong inside it. The panels keep the last state."""
        self.session.stop()

    def close(self) -> None:
        """End the simulation and take the panels from the page."""
        with contextlib.suppress(AttributeError):  # it may not have been made to the end
            if self._labs.get(self.name) is self:
                del self._labs[self.name]
        with contextlib.suppress(Exception):
            self.session.stop()
        super().close()

    def __repr__(self) -> str:
        return f"<Lab {self.name!r}: {self.plc.model.name}, {self.plc.program.steps} steps>"
