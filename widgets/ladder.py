"""The ladder with the power flow of the last scan, laid out for the width that the page has."""

from __future__ import annotations

import re

from ecsim.views.ladder import Ladder as Drawing
from ecsim.views.ladder import ladder

from .panel import Part
from .rig import PREFIX, Rig

NARROWEST, WIDEST = 340, 1400


class Ladder(Part):
    """The whole program as a ladder. The drawing is an entry of the frame, since the page may ask for another width."""

    key = "ladder"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self._drawn = self._draw(NARROWEST)
        self.least = int(re.search(r' width="(\d+)', self._drawn[2])[1])  # the program may need more than was asked for

    def _draw(self, width: int) -> tuple[int, Drawing, str]:
        drawing = ladder(self.rig.program)
        return width, drawing, drawing.svg(PREFIX, width)

    def layout(self):
        steps = {}
        for unit in self.rig.program.units:
            for network in unit.networks:
                for instruction in unit.instructions[network.start : network.end]:
                    if instruction.mnemonic == "STL":
                        steps.setdefault(str(instruction.operands[0]), [unit.name, network.number])
        return {"about": f"{self.rig.program.steps} steps", "steps": steps, "least": self.least}

    def frame(self):
        _, drawing, svg = self._drawn
        return {"svg": svg, "active": self.rig.active(), **drawing.state(self.rig.plc)}

    def on_fit(self, width):
        """Lay the ladder out anew for a width in px."""
        width = min(max(int(width), NARROWEST), WIDEST)
        if width != self._drawn[0]:
            self._drawn = self._draw(width)
