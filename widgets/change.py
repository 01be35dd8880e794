"""Another program for a PLC that is being watched: changed in RUN where the manual allows it (2.4.3), else downloaded."""

from __future__ import annotations

from difflib import SequenceMatcher
from typing import Any

from ecsim.assembler import Program, assemble
from ecsim.editing import refusals

from .rig import Rig


def change(rig: Rig, text: str) -> str:
    """Have the PLC run the program that a text spells; says in words what was done.

    Raises ProgramError when it does not compile, EcsimError without the password for a download; the PLC then goes on as it is.
    """
    with rig.session.held() as plc:
        program = assemble(text, plc.model)
        plc.protection.demand("download")
        former, running = plc.program, plc.running
        why = refusals(former, program) if running else ["the PLC is in STOP"]
        if not why:
            rig.session.edit(text)
            return f"Changed in RUN: {_difference(former, program)}. No device has changed its value."

        def load(plc: Any) -> None:
            plc.load(text)
            if running:
                plc.run()

        rig.session.post(load)
    begun = "Downloaded, from STOP to RUN" if running else "Downloaded"
    return f"{begun}: {'; '.join(why)}."


def _difference(old: Program, new: Program) -> str:
    before, after = ([str(instruction) for instruction in program.instructions] for program in (old, new))
    same = sum(block.size for block in SequenceMatcher(None, before, after, autojunk=False).get_matching_blocks())
    fresh, gone = len(after) - same, len(before) - same
    if not fresh and not gone:
        return "every instruction is the same"
    return f"{fresh} new instruction{'s' if fresh != 1 else ''}, {gone} gone"
