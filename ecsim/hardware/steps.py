"""What the system does about steps when the program has ended: those that were left go OFF, monitors tell which are ON (FX, 4.1.1)."""

from ..memory import Memory

LISTED = 8  # step numbers in the registers from "active steps" on
ANNUNCIATORS = 900  # from this step on they tell of trouble


class Steps:
    """The steps of a family in which a step that is left stays ON up to the end of the scan."""

    def __init__(self, memory: Memory, held: list[bool]):
        self.memory, self.held = memory, held
        self.ending: set[int] = set()  # generated code takes out what it sets
        relays = memory.model.relays
        self.bits, self.holds = memory.model.special_bits, relays["hold transitions"]
        self.asked = relays["monitor steps"], relays["monitor annunciators"]
        self.shown = relays["step active"], relays["annunciator"]
        numbers = *self.asked, *self.shown
        self.watched = slice(min(numbers), max(numbers) + 1)

    def hand_over(self, target: int, source: int, *others: int) -> None:
        """A transition: `target` begins, `source` and `others` end with the scan; nothing while transitions are held."""
        lists = self.memory.lists
        if not (self.held[0] or lists[self.bits][self.holds]):
            ending = self.ending
            ending.add(source)
            if others:
                ending.update(others)
            ending.discard(target)
            lists["S"][target] = True

    def end(self) -> None:
        """The program has ended."""
        lists = self.memory.lists
        if self.ending:
            steps = lists["S"]
            for number in self.ending:
                steps[number] = False
            self.ending.clear()
        relays = lists[self.bits]
        if True in relays[self.watched]:  # the four lie side by side
            self._monitor(relays)

    def _monitor(self, relays: list[bool]) -> None:
        model, steps = self.memory.model, self.memory.lists["S"]
        registers = self.memory.lists[model.special_words]
        on = [number for number in range(ANNUNCIATORS) if steps[number]]
        if relays[self.asked[0]]:
            first = model.registers["active steps"]
            registers[first : first + LISTED] = (on + [0] * LISTED)[:LISTED]
        relays[self.shown[0]] = relays[self.asked[0]] and bool(on)
        lowest = next((number for number in range(ANNUNCIATORS, len(steps)) if steps[number]), 0)
        if relays[self.asked[1]]:
            registers[model.registers["annunciator"]] = lowest
        relays[self.shown[1]] = relays[self.asked[1]] and bool(lowest)
