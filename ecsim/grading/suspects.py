"""Which networks of a program come under suspicion first when a rule breaks: those near to the outputs in question, in steps that were active then."""

from itertools import pairwise
from math import log10

from ..assembler import Network, Program, Unit
from ..devices import Constant, Device
from .exercise import Exercise
from .rules import Finding, Rule
from .run import STEP, Trace

Place = tuple[str, int]  # area and number of a device
UNSEEN = 1.5  # how much farther a network counts whose step has not been seen, though it may have been passed through


class Uses:
    """What a network reads and writes, by area and number; its steps are read, and left by a transition out of them."""

    def __init__(self, unit: Unit, network: Network):
        self.steps = {("S", number) for kind, number in network.region if kind == "STL"}
        self.read, self.written = set(self.steps), set()
        for instruction in unit.instructions[network.start : network.end]:
            numbers = {
                spec.name: operand.value for spec, operand in zip(instruction.definition.operands, instruction.operands, strict=False)
                if isinstance(operand, Constant)
            }  # fmt: skip
            for spec, operand in zip(instruction.definition.operands, instruction.operands, strict=False):
                if isinstance(operand, Device):
                    length = spec.length(numbers) or 1
                    places = {(operand.area, operand.number + more) for more in range(max(1, length))}
                    if spec.written or instruction.definition.form in ("always", "command"):
                        self.written |= places
                    if spec.read or not spec.written:
                        self.read |= places
        if any(area == "S" for area, _ in self.written):
            self.written |= self.steps


def suspects(
    exercise: Exercise, program: Program, rule: Rule | None, finding: Finding | None, trace: Trace | None
) -> list[tuple[Unit, Network]]:
    """The networks that can have to do with a broken rule, the likeliest first; `trace` is the run in which it broke."""
    places = [(unit, network) for unit in program.units for network in unit.networks]
    uses = [Uses(*place) for place in places]
    distances = _distances(uses, _looked_at(exercise, rule))
    seen = _last_active(trace, finding) if finding is not None else None
    active = _passed_through(uses, seen) if seen is not None else None
    ranks = {}
    for number, use in enumerate(uses):
        ago = unseen = 0
        if use.steps and active is not None:
            last = min(active.get(step, -1) for step in use.steps)
            if last < 0:
                continue
            ago = finding.scan - last
            unseen = UNSEEN * (not use.steps <= seen.keys())
        ranks[number] = distances.get(number, len(uses)) + log10(1 + ago) + unseen
    return [places[number] for number in sorted(ranks, key=lambda number: (ranks[number], number))]


def _looked_at(exercise: Exercise, rule: Rule | None) -> set[Place]:
    """The outputs that a rule looks at, all outputs where it looks at none."""
    names = {point.name: device for device, point in exercise.wiring.items()}
    for lanes in (rule.marked, rule.lanes) if rule is not None else ():
        found = {names.get(lane, lane) for lane in lanes}
        outputs = {device for device in found if device in exercise.wiring and device[0] == "Y"}
        if outputs:
            break
    else:
        outputs = {device for device in exercise.wiring if device[0] == "Y"}
    return {("Y", int(device[1:], 8)) for device in outputs}


def _distances(uses: list[Uses], wanted: set[Place]) -> dict[int, int]:
    """Number of a network -> how far what it writes is from what is wanted: 0 writes it, 1 writes what such a network reads.

    Where a step is wanted that no network leads to, any network that leads to a step may be the one that should.
    """
    found: dict[int, int] = {}
    begun = {place for use in uses for place in use.written if place[0] == "S" and place not in use.steps}
    seen, distance = set(wanted), 0
    while wanted:
        if any(area == "S" and (area, number) not in begun for area, number in wanted):
            wanted = wanted | begun
        reached = {number for number, use in enumerate(uses) if number not in found and use.written & wanted}
        found |= dict.fromkeys(reached, distance)
        wanted = set().union(*(uses[number].read for number in reached)) - seen
        seen |= wanted
        distance += 1
    return found


def _last_active(trace: Trace, finding: Finding) -> dict[Place, int] | None:
    """Step -> the last scan up to the failure after which it was active; None where steps cannot be seen."""
    if STEP not in trace.places:
        return None
    changes = [*trace.lane(STEP), (trace.end, "")]
    last: dict[Place, int] = {}
    for (scan, steps), (after, _) in pairwise(changes):
        if scan <= finding.scan:
            last |= {("S", int(step[1:])): min(after - 1, finding.scan) for step in str(steps).split()}
    return last


def _passed_through(uses: list[Uses], seen: dict[Place, int]) -> dict[Place, int]:
    """The same with the steps that hand over in the scan in which they begin and are never seen: active when what leads to them was."""
    active, again = dict(seen), True
    while again:
        again = False
        for use in uses:
            last = min((active.get(step, -1) for step in use.steps), default=-1)
            for place in use.written if last >= 0 else ():
                if place[0] == "S" and place not in seen and active.get(place, -1) < last:
                    active[place] = last
                    again = True
    return active
