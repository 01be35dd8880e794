"""8.5: each of the inputs X0 to X7 serves one function; 9.1: which interrupt events a model has."""

from collections.abc import Callable, Iterator

from ..devices import Bits, Device
from ..models import Model
from .program import Unit


def check_inputs(units: list[Unit], model: Model, report: Callable[..., None], where: Callable[[int], str]) -> None:
    """Report every input that two functions need, and every event that the model has not; `report(line, message, hint, section)`.

    `where(line)` names a line in a message.
    """
    for unit in units:
        if unit.event is not None and unit.event not in model.events:
            known = ", ".join(_runs(sorted(model.events)))
            report(unit.line, f"{model.name} has no interrupt event {unit.event}", f"it has {known}", "9.1")
    users: dict[int, tuple[str, int]] = {}
    for number, what, line in _uses(units, model):
        first, earlier = users.setdefault(number, (what, line))
        if first != what:
            report(
                line,
                f"X{number} serves {first} in {where(earlier)} and {what} in {where(line)}",
                "each of X0 to X7 can serve one high-speed counter, SPD, pulse capture or interrupt only",
                "8.5",
            )


def _uses(units: list[Unit], model: Model) -> Iterator[tuple[int, str, int]]:
    """(input, function, line) in the order of the lines."""
    capture = model.relays.get("capture")
    for unit in units:
        if unit.event in model.edge_events:
            yield model.edge_events[unit.event][0], f"the interrupt event {unit.event}", unit.line
        for instruction in unit.instructions:
            if instruction.definition.occupies:
                named = " ".join((instruction.spelled or instruction.mnemonic, instruction.written[0]))
                for number in instruction.definition.occupies(model, instruction.operands):
                    yield number, named, instruction.line
            if capture is not None:
                for number in captures(instruction.operands, model):
                    yield number, f"pulse capture {model.special_bits}{capture + number}", instruction.line


def captures(operands: tuple, model: Model) -> Iterator[int]:
    """The inputs whose capture relays some operands name."""
    capture = model.relays.get("capture")
    for operand in operands:
        if capture is not None and isinstance(operand, (Device, Bits)) and operand.area == model.special_bits:
            length = 4 * operand.digits if isinstance(operand, Bits) else 1
            yield from (n - capture for n in range(operand.number, operand.number + length) if 0 <= n - capture < model.captures)


def occupied(units: list[Unit], model: Model) -> tuple[set[int], set[int]]:
    """The inputs that counters and SPD need, and those that capture and interrupts watch."""
    taken: set[int] = set()
    watched: set[int] = set()
    for unit in units:
        for instruction in unit.instructions:
            if instruction.definition.occupies:
                taken.update(instruction.definition.occupies(model, instruction.operands))
            watched.update(captures(instruction.operands, model))
    watched.update(model.edge_events[unit.event][0] for unit in units if unit.event in model.edge_events)
    return taken, watched


def _runs(numbers: list[int]) -> Iterator[str]:
    """Numbers as text, runs of neighbours drawn together: 0 to 7, 10."""
    place = 0
    while place < len(numbers):
        last = place
        while last + 1 < len(numbers) and numbers[last + 1] == numbers[last] + 1:
            last += 1
        yield str(numbers[place]) if last == place else f"{numbers[place]} to {numbers[last]}"
        place = last + 1
