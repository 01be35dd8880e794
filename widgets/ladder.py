"""The ladder with the power flow of the last scan, laid out for the width that the page has."""

from __future__ import annotations

import re

from ecsim.assembler.program import Instruction
from ecsim.devices import Bits, Device
from ecsim.instructions.signature import OperandSpec
from ecsim.values import BOOL
from ecsim.views.ladder import Ladder as Drawing
from ecsim.views.ladder import ladder

from .plate import Plated
from .rig import PREFIX, Rig

NARROWEST, WIDEST = 340, 1400


MOST_PLACES = 200  # of a device, told at once


class Ladder(Plated):
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
        return {"svg": svg, "active": self.rig.active(), **self.plates(), **drawing.state(self.rig.plc)}

    def on_fit(self, width):
        """Lay the ladder out anew for a width in px."""
        width = min(max(int(width), NARROWEST), WIDEST)
        if width != self._drawn[0]:
            self._drawn = self._draw(width)

    def on_about(self, position):
        """What an element speaks of: each of its devices, as a plate takes it, and every place where it is used.

        Gives a dict for each device with label, name, what, `written` here or only read, and `places`: [position, unit, network, step, words].
        """
        instruction = self.rig.instructions[int(position)]
        return [
            {"label": _label(operand, spec, instruction), "written": spec.written, "places": self._places(operand)}
            | dict(zip(("name", "what"), self.rig.point(str(operand)), strict=True))
            for operand, spec in _devices(instruction)
        ]

    def _places(self, wanted: Device | Bits) -> list[list]:
        """Where a device is used, alone, in a Kn string or among the registers of a longer value, in the program's order."""
        found = []
        for unit in self.rig.program.units:
            for network in unit.networks:
                for instruction in unit.instructions[network.start : network.end]:
                    uses = {spec.written for operand, spec in _devices(instruction) if _meet(operand, spec, wanted)}
                    if uses:
                        words = f"{instruction.mnemonic} {'writes' if True in uses else 'reads'}"
                        found.append([instruction.position, unit.name, network.number + 1, instruction.step, words])
        return found[:MOST_PLACES]


def _devices(instruction: Instruction) -> list[tuple[Device | Bits, OperandSpec]]:
    """The operands that are a fixed device; where an index points changes with every scan."""
    pairs = zip(instruction.operands, instruction.definition.operands, strict=False)
    return [(operand, spec) for operand, spec in pairs if isinstance(operand, Device | Bits) and operand.index is None]


def _label(operand: Device | Bits, spec: OperandSpec, instruction: Instruction) -> str:
    """A device as it is read there: T0 as a contact, D0 as one register or as two."""
    if isinstance(operand, Bits):
        return str(operand)
    if operand.area in ("T", "C"):
        return f"{operand}:BOOL" if spec.type is BOOL else str(operand)
    return f"{operand}:{spec.type.name}" if spec.type.words > 1 and spec.plain else str(operand)


def _meet(operand: Device | Bits, spec: OperandSpec, wanted: Device | Bits) -> bool:
    """Whether an operand reaches a device that is looked for."""
    count = 4 * operand.digits if isinstance(operand, Bits) else max(1, spec.type.words) * (spec.span if isinstance(spec.span, int) else 1)
    size = 4 * wanted.digits if isinstance(wanted, Bits) else 1
    return operand.area == wanted.area and operand.number < wanted.number + size and wanted.number < operand.number + count
