"""What the system does about steps when the program has ended: those that were left go OFF, monitors tell which are ON (FX, 4.1.1)."""

from ..memory import Memory

LISTED = 8  # step numbers in the registers from "active steps" on
ANNUNCIATORS = 900  # from this step on they tell of trouble


class Steps:
    """The steps of a family in which a step that is left stays ON up to the end of the scan."""

    def __init__(self, memory: Memory):
        self.memory = memory
        self.ending: set[int] = set()  # generated code adds to it

    def end(self) -> None:
        """The program has ended."""
        lists, model = self.memory.lists, self.memory.model
        steps = lists["S"]
        if self.ending:
            for number in self.ending:
                steps[number] = False
            self.ending.clear()
        relays, registers = lists[model.special_bits], lists[model.special_words]
        if relays[model.relays["monitor steps"]]:
            on = [number for number in range(ANNUNCIATORS) if steps[number]]
            relays[model.relays["step active"]] = bool(on)
            first = model.registers["active steps"]
            registers[first : first + LISTED] = (on + [0] * LISTED)[:LISTED]
        else:
            relays[model.relays["step active"]] = False
        if relays[model.relays["monitor annunciators"]]:
            lowest = next((number for number in range(ANNUNCIATORS, len(steps)) if steps[number]), 0)
            relays[model.relays["annunciator"]] = bool(lowest)
            registers[model.registers["annunciator"]] = lowest
        else:
            relays[model.relays["annunciator"]] = False
