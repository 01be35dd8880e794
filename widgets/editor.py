"""The editor: the program as text, with completion and problems marked while it is typed; a change goes to the PLC at a key."""

from __future__ import annotations

import weakref
from dataclasses import dataclass, field
from typing import Any

from ecsim.errors import EcsimError, ProgramError

from .assist import Place, marks
from .change import change
from .panel import Part
from .rig import Rig


@dataclass
class Desk:
    """What lies on the desk of one lab: the text that is being worked at, and what was said of it. It outlives a cell that runs again."""

    draft: str | None = None  # typed and not downloaded
    help: dict[str, Any] = field(default_factory=dict)
    said: dict[str, Any] = field(default_factory=dict)
    rig: Any = lambda: None


class Editor(Part):
    """The text of the program. `help` answers what was typed last, `said` the last download; both carry the page's number `n`."""

    key = "editor"
    _desks: dict[str, Desk] = {}

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self.desk = self._desks.setdefault(rig.session.name, Desk())
        if self.desk.rig() is not rig:
            self.desk.rig, self.desk.help, self.desk.said = weakref.ref(rig), {}, {}
        if self.desk.draft == rig.program.source:
            self.desk.draft = None

    def layout(self):
        program = self.rig.program
        return {"source": program.source, "draft": self.desk.draft, "model": self.rig.plc.model.name, "about": f"{program.steps} steps"}

    def frame(self):
        return {"help": self.desk.help, "said": self.desk.said}

    def on_typed(self, text, at, n):
        """Something was typed, the cursor stands at `at`: tell the problems, what may follow, and the operands of the line."""
        self.desk.draft = None if text == self.rig.program.source else text
        model = self.rig.plc.model
        place = Place(text, at, model)
        self.desk.help = {
            "n": n,
            "marks": marks(text, model),
            "from": place.start,
            "options": place.options(),
            "signature": place.signature(),
        }

    def on_run(self, text, n):
        """Have the PLC run the text; what refuses it is told, and the text stays as it is."""
        self.desk.draft = text
        try:
            said = change(self.rig, text)
        except ProgramError as error:
            count = len(error.problems)
            self.desk.help = {"n": n, "marks": marks(text, self.rig.plc.model), "from": 0, "options": [], "signature": None}
            words = f"Not downloaded: {count} problem{'s' if count != 1 else ''}. The PLC goes on with the program that it has."
            self.desk.said = {"n": n, "refused": True, "words": words}
        except EcsimError as error:
            self.desk.said = {"n": n, "refused": True, "words": f"Not downloaded: {error}"}
        else:
            self.desk.draft = None
            self.desk.said = {"n": n, "refused": False, "words": said}

    def on_drop(self):
        """What was typed is given up."""
        self.desk.draft, self.desk.help = None, {}
