"""What the system does about steps when the program has ended: those that were left go OFF, monitors tell which are ON (FX, 4.1.1)."""

from ..memory import Memory

LISTED = 8  # step numbers in the registers from "active steps" on
ANNUNCIATORS = 900  # from this step on they tell of trouble


class Steps:
    """The steps of a family in which a step that is left stays ON up to the end of the scan."""

    def __init__(self, memory: Memory):
        self.memory = memory
        self.ending: set[int] = set()  # generated code adds to it
        relays = memory.model.relays
        self.asked = relays["monitor steps"], relays["monitor annunciators"]
        self.shown = relays["step active"], relays["annunciator"]

    def end(self) -> None:
        """The program has ended."""
        lists, ending = self.memory.lists, self.ending
        if ending:
            steps = lists["S"]
            for number in ending:
                steps[number] = False
            ending.clear()
        relays = lists[self.memory.model.special_bits]
        if relays[self.asked[0]] or relays[self.asked[1]] or relays[self.shown[0]] or relays[self.shown[1]]:
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
