"""The cell magic `%%il`: a cell that is a program, with completion. `%load_ext ecsim_widgets` loads it."""

from __future__ import annotations

import re

from IPython.core.completer import SimpleCompletion, context_matcher
from IPython.core.error import UsageError
from IPython.core.magic import Magics, cell_magic, magics_class
from IPython.core.magic_arguments import argument, magic_arguments, parse_argstring

from ecsim.assembler import assemble
from ecsim.errors import EcsimError, ProgramError
from ecsim.models import get_model
from ecsim.views.ladder import ladder

from .assist import Place, marks
from .change import change
from .lab import Lab

DEFAULT_MODEL = "EC20"


class CellError(EcsimError):
    """A cell holds no program; the traceback is the cell's lines with a mark below each problem."""

    def __init__(self, error: ProgramError, text: str, model):
        super().__init__(str(error))
        self.lines = list(_marked(text, model))
        self.head = str(error).split("\n")[0]

    def _render_traceback_(self) -> list[str]:
        return [f"\x1b[31m{self.head[:1].upper()}{self.head[1:]}\x1b[0m", *self.lines]


def _marked(text: str, model):
    """The lines with problems, each with a mark below the word and the sentence behind it."""
    lines = text.split("\n")
    shown = 0
    for mark in marks(text, model):
        if mark.line != shown:
            shown = mark.line
            yield f"{mark.line:>4}  {lines[mark.line - 1]}"
        section = f" (manual {mark.section})" if mark.section else ""
        yield f"      {' ' * (mark.column - 1)}\x1b[31m{'^' * mark.length}\x1b[0m {mark.words}{section}"


@magics_class
class Programs(Magics):
    """Cells in instruction list."""

    @magic_arguments()
    @argument("--lab", help="the lab that gets the program; one is made where there is none of this name")
    @argument("--model", help="EC10 or EC20; otherwise the lab's own, and EC20 without a lab")
    @argument("--run", action="store_true", help="run it at once, in the lab named 'lab' if no other is named")
    @cell_magic
    def il(self, line: str, cell: str):
        """Assemble the cell. It goes into the lab that is named, else the value is its ladder.

        A lab whose PLC is in RUN takes it as a change in RUN where the manual allows that (2.4.3), and says what it did.
        A cell that does not compile raises with its lines marked, and the lab goes on with the program that it has.
        """
        asked = parse_argstring(self.il, line)
        name = asked.lab or ("lab" if asked.run else None)
        there = Lab.named(name) if name else None
        try:
            model = get_model(asked.model or (there.plc.model.name if there else DEFAULT_MODEL))
        except EcsimError as error:
            raise UsageError(str(error)) from None
        if there is not None and model.name != there.plc.model.name:
            raise UsageError(f"the lab {name!r} is an {there.plc.model.name}, not an {model.name}; leave --model out, or name another lab")
        try:
            if name is None:
                return ladder(assemble(cell, model))
            if there is None:
                return Lab(model.name, cell, name=name, autostart=asked.run)
            print(change(there.rig, cell))
        except ProgramError as error:
            raise CellError(error, cell, model) from None
        if asked.run:
            there.session.run()
        return None


@context_matcher()
def il_matcher(context):
    """Completion in a `%%il` cell: instructions, devices, names."""
    head, _, program = context.full_text.partition("\n")
    if not head.startswith("%%il") or not context.cursor_line:
        return {"completions": []}
    at = sum(len(line) + 1 for line in program.split("\n")[: context.cursor_line - 1]) + context.cursor_position
    try:
        model = get_model((re.search(r"--model[ =](\w+)", head) or ["", DEFAULT_MODEL])[1])
    except EcsimError:
        model = get_model(DEFAULT_MODEL)
    place = Place(program, at, model)
    return {
        "completions": [SimpleCompletion(text=option.text, type=option.kind) for option in place.options()],
        "matched_fragment": place.word,
        "suppress": True,
        "ordered": True,
    }


def load_ipython_extension(shell) -> None:
    """What `%load_ext ecsim_widgets` does."""
    shell.register_magics(Programs)
    if il_matcher not in shell.Completer.custom_matchers:
        shell.Completer.custom_matchers.append(il_matcher)


def unload_ipython_extension(shell) -> None:
    """What `%unload_ext ecsim_widgets` does."""
    shell.magics_manager.magics["cell"].pop("il", None)
    if il_matcher in shell.Completer.custom_matchers:
        shell.Completer.custom_matchers.remove(il_matcher)
