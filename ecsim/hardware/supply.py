"""The supply: mains, the 24 V for the inputs, and the battery that keeps the memory while there is no mains (2.1.7, 2.1.10, SM4 to SM7)."""

from ..errors import EcsimError
from ..memory import Memory
from .unit import Unit

BATTERIES = {"present": (30, True), "failing": (22, True), "absent": (0, False)}  # tenths of a volt, whether the memory is kept
LOW = 24  # appendix 1: SM4 goes OFF above 2.4 V
CHECK_US = 50_000  # appendix 1: how often a loss of the 24 V is looked at again
SHORTEST_MS, LONGEST_MS = 10, 100  # SD5


class Supply(Unit):
    """What feeds the PLC. `powered` is whether it works; `lost` is whether its memory was without any supply since it worked last."""

    def __init__(self, memory: Memory, awake: list[Unit]):
        super().__init__(awake)
        self.memory = memory
        self.powered = self.mains = self.dc = True
        self.battery = "present" if memory.model.battery else ""
        self.lost = False
        self.no_battery = False  # the mode of 2.1.10
        self.loss_ms = 0  # the detection time that the system block sets
        self.since = 0  # when the power went
        self.due: int | None = None  # when the 24 V are looked at again

    @property
    def low(self) -> bool:
        """Whether there is a battery to complain of."""
        return bool(self.battery) and BATTERIES[self.battery][0] <= LOW

    @property
    def patience_us(self) -> int:
        """How long the PLC works on without mains; only one with a setting for it does."""
        if "power loss delay" not in self.memory.model.registers:
            return 0
        return 1000 * min(max(self.loss_ms, SHORTEST_MS), LONGEST_MS)

    def change_battery(self, state: str) -> None:
        """Put another battery in, or none; without mains and battery the memory is lost."""
        if not self.battery:
            raise EcsimError(f"{self.memory.model.name} has no battery; its retained devices stand in the EEPROM (2.1.7)")
        if state not in BATTERIES:
            raise EcsimError(f"the battery is {state!r}; choose {' or '.join(BATTERIES)}")
        self.battery = state
        self.watch()
        self.show()

    def watch(self) -> None:
        """Note whether the memory has lost what it held."""
        if not self.powered and self.battery and not BATTERIES[self.battery][1]:
            self.lost = True

    def change_dc(self, on: bool, now: int) -> None:
        """The 24 V fail, or come again."""
        self.dc = on
        if not on and self.due is None:
            self.due = now + CHECK_US
            self.wake()
        self.show()

    def advance(self, now: int) -> None:
        if self.due is not None and now >= self.due:
            self.due = None if self.dc else now + CHECK_US
            self.wake(self.due is not None)
            self.show()

    def show(self) -> None:
        """Tell of the supply in special relays and registers."""
        model = self.memory.model
        relays, registers = self.memory.lists[model.special_bits], self.memory.lists[model.special_words]
        states = {"battery low": self.low, "power lost": not self.mains, "24 V lost": self.due is not None, "no battery": self.no_battery}
        for meaning, on in states.items():
            if meaning in model.relays:
                relays[model.relays[meaning]] = on
        if "battery" in model.registers and self.battery:
            registers[model.registers["battery"]] = BATTERIES[self.battery][0]
        if "power loss delay" in model.registers:
            registers[model.registers["power loss delay"]] = self.patience_us // 1000

    def snapshot(self) -> tuple:
        return self.powered, self.mains, self.dc, self.battery, self.lost, self.since, self.due

    def restore(self, snapshot: tuple) -> None:
        self.powered, self.mains, self.dc, self.battery, self.lost, self.since, self.due = snapshot
        self.wake(self.due is not None)
