"""Changing a program in RUN (2.4.3): what may differ, and what the instructions that stay remember."""

from difflib import SequenceMatcher

from .assembler import Instruction, Program, Region, Unit


def refusals(old: Program, new: Program) -> list[str]:
    """Why `new` cannot take the place of `old` in RUN; empty when it can."""
    found = []
    if _table(old.variables.values()) != _table(new.variables.values()):
        found.append(f"the global variables differ ({_difference(old.variables.values(), new.variables.values())})")
    before, after = ({unit.name.upper(): unit for unit in program.units} for program in (old, new))
    for words, missing in (("is missing", before.keys() - after.keys()), ("is new", after.keys() - before.keys())):
        found += [f"{_called((before | after)[name])} {words}" for name in sorted(missing)]
    for name in sorted(before.keys() & after.keys()):
        former, unit = before[name], after[name]
        if (former.kind, former.event) != (unit.kind, unit.event):
            found.append(f"{former.name} was {_called(former)} and is {_called(unit)}")
        elif _table(former.variables.values()) != _table(unit.variables.values()):
            found.append(f"the variables of {unit.name} differ ({_difference(former.variables.values(), unit.variables.values())})")
    return found


def _table(variables) -> list[tuple]:
    return sorted((v.name.casefold(), str(v.device), v.role, v.type.name if v.type else "") for v in variables)


def _difference(old, new) -> str:
    """The names of the rows in which two variable tables differ."""
    return ", ".join(sorted({row[0] for row in set(_table(old)) ^ set(_table(new))})) or "their order"


def _called(unit: Unit) -> str:
    kind = {"MAIN": "the main program", "SUBROUTINE": "the subroutine", "INTERRUPT": "the interrupt program"}[unit.kind]
    return f"{kind} {unit.name}" + (f" of event {unit.event}" if unit.event is not None else "")


def keep_memory(old: Program, new: Program) -> tuple[set[int], list[Instruction]]:
    """Let the instructions of `new` that stand in `old` too have the same places in memory, all others free ones.

    Gives the places that are kept, and the instructions of `old` that are gone.
    """
    kept: set[int] = set()
    gone: list[Instruction] = []
    waiting: list[tuple[Instruction | Region, str]] = []  # whose place is to be found, and the name of it
    for unit in new.units:
        former = old.unit(unit.name)
        stays = _pairs(former, unit)
        gone += [instruction for index, instruction in enumerate(former.instructions) if index not in stays.values()]
        for index, instruction in enumerate(unit.instructions):
            same = former.instructions[stays[index]] if index in stays else None
            for place in ("slot", "pulse"):
                if getattr(instruction, place) >= 0:
                    _place(instruction, place, getattr(same, place, -1), kept, waiting)
        steps = {region.steps: region for region in _steps(former)}
        for region in _steps(unit):
            same = steps.get(region.steps)
            _place(region, "slot", same.slot if same is not None else -1, kept, waiting)
    free = (number for number in range(old.slots + new.slots) if number not in kept)
    for owner, place in waiting:
        setattr(owner, place, next(free))
    used = [getattr(owner, place) for owner, place in waiting]
    new.slots = max([*kept, *used], default=-1) + 1
    return kept, gone


def _place(owner: "Instruction | Region", place: str, former: int, kept: set[int], waiting: list) -> None:
    if former >= 0:
        setattr(owner, place, former)
        kept.add(former)
    else:
        waiting.append((owner, place))


def _pairs(old: Unit, new: Unit) -> dict[int, int]:
    """Index of an instruction -> index of the same one before."""
    matcher = SequenceMatcher(None, list(map(str, new.instructions)), list(map(str, old.instructions)), autojunk=False)
    return {block.a + place: block.b + place for block in matcher.get_matching_blocks() for place in range(block.size)}


def _steps(unit: Unit) -> list[Region]:
    found, waiting = [], list(unit.nodes)
    while waiting:
        node = waiting.pop()
        if isinstance(node, Region):
            waiting += node.nodes
            found += [node] if node.kind == "STL" else []
    return found
