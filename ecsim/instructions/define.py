"""TABLE: every instruction, defined once by a decorated function in the module of its chapter.

Five forms, told apart by what the function is given:

    contact   operand values -> bool                       joined to the power flow
    value     operand values -> new value(s)               while the flow is ON
    always    the flow, a timer or counter, values         in every scan
    command   the machine or the flow, values              while the flow is ON; with the flow once more after it
    emitted   the code being written, the operands         the structure of the program

The functions of the first three forms are pure text to the engines as well: `engines/template.py` reads their bodies,
so they keep to arithmetic, comparisons, `if` and attributes of the unit they were handed.
"""

from collections.abc import Callable
from dataclasses import dataclass

from .signature import OperandSpec, parse_signature

RESULT = ("zero", "carry", "borrow")
BOTH = ("EC10", "EC20")
FX = ("H1U", "H2U")
H2U = ("H2U",)


@dataclass(frozen=True, slots=True)
class Definition:
    """One row of TABLE: what checker, engines, views, help and tests know of an instruction."""

    mnemonic: str
    form: str
    operands: tuple[OperandSpec, ...]
    steps: int | None
    section: str
    function: Callable
    join: str | None = None  # contacts: "LD", "AND" or "OR"
    flags: tuple[str, ...] = ()  # set by the result
    taken: tuple[str, ...] = ()  # what the function gets: names of operands, flags, "flow", "machine", "state", "now"
    given: tuple[str, ...] = ()  # flags and state that the function returns itself, after its values
    models: tuple[str, ...] = BOTH
    cleared: bool = False  # its destination is cleared when its MC is OFF or its step has been left (5.2.1, 5.3.1)
    released: bool = False  # there only its claim is released: what it has written stays (FX)
    application: bool = False  # of chapter 6, or with a function number: executed correctly it clears SM20 and SM22, or M8067
    as_stored: bool = False  # numbers go in and out as registers hold them: nothing to mask, nothing to wrap
    restarts: bool = False  # beyond a limit the result goes on from 0 with the limit's sign, rather than from the other limit (FNC 20)
    resets: bool = False  # an OFF written to a T or C clears its value too (5.1.17)
    transition_steps: int | None = None  # its length where it leads to, or clears, a step (5.3.2 to 5.3.4)
    bus: bool = False  # stands on the left bus, without a flow before it
    rising: bool = False  # executed only in the scan in which its flow rises
    faults: tuple[int, ...] = ()
    check: Callable | None = None  # (values of the operands; the `model` first, where it takes one) -> what is wrong with them, or None
    counted: str | None = None  # which of the model's limits a program's instructions of this kind count towards
    pulsed: bool | None = None  # whether it has a form for the rise of its flow, where a family has such forms; None: as usual
    occupies: Callable | None = None  # (model, operands) -> the numbers of the inputs X0 to X7 that it needs for itself (8.5)

    def __repr__(self) -> str:
        return f"<Definition of {self.mnemonic}, {self.section}>"

    @property
    def title(self) -> str:
        """The first sentence of the docstring."""
        return (self.function.__doc__ or "").strip().splitlines()[0]

    @property
    def pulses(self) -> bool:
        """Whether it can be executed at the rise of its flow only: what works on values can, what watches its flow by itself cannot."""
        return self.form in ("value", "command") and not self.keeps if self.pulsed is None else self.pulsed

    @property
    def keeps(self) -> bool:
        """Whether it remembers something from one execution to the next, in a slot of the memory's list E."""
        return "state" in self.taken or self.after or self.claims

    @property
    def claims(self) -> bool:
        """Whether a command holds something under a number, to be released when its flow has gone."""
        return "claim" in self.taken

    @property
    def after(self) -> bool:
        """Whether a command is called once more when its flow has gone."""
        return self.form == "command" and "flow" in self.taken

    @property
    def told(self) -> bool:
        """Whether it is written with its flow, and not only executed while that is ON."""
        return self.claims or ("flow" in self.taken and (self.assigns or self.after))

    @property
    def assigns(self) -> bool:
        """Whether its function gives values for its operands, rather than work on a unit or write structure."""
        return self.form in ("value", "always", "command") and any(spec.written and spec.plain for spec in self.operands)

    @property
    def outputs(self) -> bool:
        """Whether it uses a power flow and belongs at the right of a rung."""
        return self.form != "contact" and not self.bus


TABLE: dict[str, Definition] = {}


def _define(form: str, mnemonic: str, signature: str, steps: int | None, section: str, **columns) -> Callable[[Callable], Callable]:
    operands, taken, given = parse_signature(signature)
    columns["flags"] = tuple(dict.fromkeys((*columns.get("flags", ()), *(word for word in given if word != "state"))))
    columns.setdefault("application", section.startswith(("6.", "FNC ")))

    def decorate(function: Callable) -> Callable:
        if mnemonic in TABLE:
            raise ValueError(f"{mnemonic} is defined twice")
        parameters = function.__code__.co_varnames[: function.__code__.co_argcount]
        first = tuple(name for name in parameters[:1] if name in ("flow", "machine"))
        last = ("state",) if "state" in parameters and "state" not in taken else ()
        TABLE[mnemonic] = Definition(
            mnemonic, form, operands, steps, section, function, taken=(*first, *taken, *last), given=given, **columns
        )
        return function

    return decorate


def contact(mnemonic: str, signature: str, *, join: str, steps: int, section: str, **columns):
    """A contact: the function tells from the operand values whether it is closed; `join` says how it meets the flow."""
    return _define("contact", mnemonic, signature, steps, section, join=join, **columns)


def value(mnemonic: str, signature: str, *, steps: int, section: str, **columns):
    """While the flow is ON the function's result is wrapped and stored; `flags` tell about the exact result."""
    return _define("value", mnemonic, signature, steps, section, **columns)


def always(mnemonic: str, signature: str, *, steps: int, section: str, **columns):
    """Executed in every scan with the flow, ON or OFF; it returns its new values, or without such operands the flow that goes on."""
    return _define("always", mnemonic, signature, steps, section, **columns)


def command(mnemonic: str, signature: str, *, steps: int, section: str, **columns):
    """The function acts on the machine while the flow is ON; one that gets `flow` is called once more, with OFF, when the flow has gone.

    It may have destinations and state as a value instruction has; with `flow` the state is what is true while it is at work.
    One that takes a `claim` is called while the flow is ON; `machine.release(claim)` follows when it has gone.
    """
    return _define("command", mnemonic, signature, steps, section, **columns)


def emitted(mnemonic: str, signature: str, *, steps: int | None, section: str, **columns):
    """The function writes the program's structure through the engine's writer (`engines/writer.py`)."""
    return _define("emitted", mnemonic, signature, steps, section, **columns)
