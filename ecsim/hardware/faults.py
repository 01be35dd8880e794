"""Errors as the machine reports them: SM3 and SD3 of the system, SM20 to SM22 and the record SD20 to SD24 of the program (2.4, appendix 6)."""

from dataclasses import dataclass, replace

from ..errors import OPERAND, RANGE
from ..memory import Memory
from ..models import Model
from .unit import Unit

KINDS = {RANGE: "fault range", OPERAND: "fault operand"}  # errors with a relay of their own
BOTH = ("EC10", "EC20")
FX = ("H1U", "H2U")
LAMPS = ("off", "flashing", "on")  # of ERR, the gravest last


@dataclass(frozen=True, slots=True)
class Error:
    """A row of appendix 6: what an error means, what it does and what clears it.

    `part` is what has to be damaged for it (`plc.damage`); `found` says when the machine looks: "damage" at once, "power-up", "run".
    `cleared` names what clears it; what renews the part ("program", "format" ...) repairs it as well, the other ones clear the
    error of a part that is whole again.
    """

    code: int
    meaning: str
    kind: str = "execution"  # "system": SM3 and SD3; "execution": SM20 and SD20
    lamp: str = "off"
    stops: bool = False
    models: tuple[str, ...] = BOTH
    part: str = ""
    found: tuple[str, ...] = ()
    cleared: tuple[str, ...] = ()
    relay: str = ""
    remedy: str = ""

    @property
    def effect(self) -> str:
        """What the error does, in words."""
        return ("the program is stopped" if self.stops else "the program runs on") + f", ERR lamp {self.lamp}"


def _unit(code: int, meaning: str, part: str, relay: str = "", cleared: tuple[str, ...] = ()) -> Error:
    """A fault of the hardware that stops the program until it is repaired and the power was off."""
    return Error(
        code, meaning, "system", "on", True, ("EC10",), part, ("damage", "power-up"), ("power-up", *cleared), relay,
        "repair the part, then switch the power off and on",
    )  # fmt: skip


def _passing(code: int, meaning: str, part: str, relay: str = "") -> Error:
    """A fault of the hardware that the machine lives with and forgets when it is gone."""
    found = ("damage", "power-up")
    return Error(code, meaning, "system", "flashing", False, ("EC10",), part, found, ("repair",), relay, "repair the part")


def _file(code: int, meaning: str, part: str, remedy: str) -> Error:
    """A damaged file without which the program does not run."""
    return Error(code, meaning, "system", "on", True, BOTH, part, ("power-up", "run"), (part, "format"), "", remedy)


def _lost(code: int, meaning: str, part: str, lamp: str, cleared: tuple[str, ...], remedy: str) -> Error:
    """A loss that is noticed at power-up and does not stop the program."""
    return Error(code, meaning, "system", lamp, False, BOTH, part, ("power-up",), (*cleared, "format"), "", remedy)


def _stop(code: int, meaning: str, part: str, remedy: str) -> Error:
    """An execution error that stops the program (2.4.2)."""
    return Error(code, meaning, lamp="on", stops=True, part=part, cleared=("program", "format") if part else (), remedy=remedy)


_ROWS = (
    _unit(10, "the SRAM has failed", "SRAM"),
    _unit(11, "the FLASH has failed", "FLASH"),
    _unit(12, "a communication port has failed", "port"),
    _unit(13, "the real-time clock has failed", "clock chip", "clock error"),
    _unit(14, "the I2C bus has failed", "I2C"),
    _unit(20, "the inputs and outputs of the main unit have failed", "main unit I/O", "bus error", ("run", "program")),
    _passing(21, "an I/O module has failed", "I/O module", "module error"),
    _passing(22, "a special module has failed", "special module", "special module error"),
    _passing(23, "the clock was read with a wrong time", "clock", "clock error"),
    _passing(24, "the EEPROM cannot be read or written", "EEPROM"),
    _passing(25, "the built-in analog channels have failed", "analog channels"),
    _passing(26, "the special modules are not those of the system block", "module configuration"),
    _file(40, "the program file is damaged", "program", "download a program"),
    _file(41, "the system block is damaged", "system block", "download a system block"),
    _file(42, "the data block is damaged", "data block", "download a data block"),
    _lost(
        43, "the retained data are lost", "retained data", "flashing", ("devices", "power-up"), "clear the devices, or switch off and on"
    ),
    _lost(
        44, "the force table is lost", "force table", "flashing", ("devices", "force", "power-up"), "force a device, or switch off and on"
    ),
    _lost(45, "the user information file is damaged", "user information", "off", ("program",), "download a program"),
    _stop(60, "the program does not compile", "program translation", "download a program"),
    _stop(61, "the program took longer than the watchdog allows", "", "shorten the program or raise the watchdog, then run"),
    _stop(62, "an illegal instruction was met", "instruction", "download a program"),
    _stop(63, "an operand has an illegal kind of device", "operand", "download a program"),
    Error(64, "the value of an operand is illegal"),
    Error(65, "the number of an operand's device is out of range"),
    Error(66, "the subroutine stack is full"),
    Error(67, "the interrupt queue is full"),
    Error(68, "an illegal jump or call"),
    Error(69, "division by zero"),
    Error(70, "a stack is defined wrongly: its size or count is below zero, or the count above the size"),
    Error(72, "the subroutine or interrupt program does not exist"),
    Error(73, "there is no special module with this address", models=("EC20",)),
    Error(74, "the special module did not answer", models=("EC20",)),
    Error(75, "an immediate refresh failed"),
    Error(76, "the clock was given an illegal time"),
    Error(77, "a parameter of PLSR is illegal"),
    Error(78, "the special module has no such buffer", models=("EC20",)),
    Error(79, "the servo did not answer in time", models=("EC10",)),
    Error(80, "the servo's answer has a wrong checksum", models=("EC10",)),
)
ERRORS = {row.code: row for row in _ROWS}
# What H1U and H2U say instead; Model.fault_codes tells which becomes which.
_FX_ROWS = (
    Error(6105, "the program took longer than the watchdog allows", lamp="on", stops=True, remedy="shorten the program or raise D8000"),
    Error(6401, "the program is damaged", "system", "on", True, remedy="download a program"),
    Error(6701, "the target of a jump or call does not exist or cannot be reached"),
    Error(6702, "the subroutine stack is full"),
    Error(6703, "the interrupt queue is full"),
    Error(6706, "the value of an operand is illegal, or the number of its device is out of range"),
    Error(6708, "a special module does not exist or did not answer"),
    Error(6760, "the servo did not answer in time, or its answer has a wrong checksum"),
)
KNOWN = ERRORS | {row.code: replace(row, models=FX) for row in _FX_ROWS}
MEANINGS = {code: row.meaning for code, row in ERRORS.items()}


def group_of(model: Model, code: int) -> int:
    """The number of the relay and register for errors of the same hundred."""
    return model.fault_groups + model.fault_code(code) // 100


def show_group(memory: Memory, group: int, code: int) -> None:
    """Show an error in its relay and register, 0 for none."""
    model = memory.model
    relays, registers = memory.lists[model.special_bits], memory.lists[model.special_words]
    relays[group], registers[group] = code != 0, code
    show_any(memory)


def show_any(memory: Memory) -> None:
    """Tell in the relay and register for it whether there is an error of any group."""
    model = memory.model
    relays, registers = memory.lists[model.special_bits], memory.lists[model.special_words]
    shown = [each for each in sorted({group_of(model, row) for row in model.fault_codes}) if relays[each]]
    relays[model.relays["error"]] = bool(shown)
    registers[model.registers["error"]] = shown[0] if shown else 0


class Faults:
    """Notes execution errors; the program reads them in special relays and registers."""

    def __init__(self, memory: Memory):
        self.memory = memory
        model = memory.model
        self.bits, self.words = model.special_bits, model.special_words
        self.flag = model.relays["fault"]
        self.kinds = {code: model.relays[kind] for code, kind in KINDS.items() if kind in model.relays}
        self.cleared = [self.flag, *(number for code, number in self.kinds.items() if code == OPERAND)]
        self.record, self.length = model.registers["faults"], model.fault_record
        self.groups = [] if model.fault_groups is None else sorted({group_of(model, code) for code in model.fault_codes})

    def note(self, code: int) -> bool:
        """An instruction failed: set the flags, push the record when the code differs from the newest. Gives False, the flow of a failed contact."""
        if self.groups:
            return self._note_group(code)
        relays, registers = self.memory.lists[self.bits], self.memory.lists[self.words]
        relays[self.flag] = True
        if code in self.kinds:
            relays[self.kinds[code]] = True
        first = self.record
        if registers[first] != code:
            registers[first : first + self.length] = [code, *registers[first : first + self.length - 1]]
        return False

    def _note_group(self, code: int) -> bool:
        """The same where each hundred of codes has a relay and a register."""
        relays, model = self.memory.lists[self.bits], self.memory.model
        group = group_of(model, code)
        show_group(self.memory, group, model.fault_code(code))
        if group == self.flag:
            relays[model.relays["fault latch"]] = True
        return False

    def forget(self) -> None:
        """RUN begins: the errors of execution are over."""
        for group in self.groups:
            show_group(self.memory, group, 0)

    def executed(self) -> None:
        """An application instruction was executed correctly: SM20 and SM22 go OFF, the record stays."""
        relays = self.memory.lists[self.bits]
        for number in self.cleared:
            relays[number] = False
        if self.groups:
            show_any(self.memory)

    def codes(self) -> list[int]:
        """The record, newest first."""
        if self.groups:
            return [code for group in self.groups if (code := self.memory.lists[self.words][group])]
        return [code for code in self.memory.lists[self.words][self.record : self.record + self.length] if code]


class SystemErrors(Unit):
    """Which parts of a PLC are damaged, and which errors of that it has found; SM3 and SD3 tell of the gravest one (2.4.2)."""

    def __init__(self, memory: Memory, awake: list[Unit]):
        super().__init__(awake)
        self.memory = memory
        model = memory.model
        self.rows = {
            code: row
            for code, row in ERRORS.items()
            if row.part and (model.name in row.models or code in model.fault_codes or (row.relay and row.relay in model.relays))
        }
        self.damaged: set[int] = set()
        self.found: set[int] = set()  # errors of damaged parts that the machine has noticed

    @property
    def parts(self) -> dict[str, int]:
        """What can be damaged -> the code of its error."""
        return {row.part: code for code, row in self.rows.items()}

    def happen(self, what: str) -> None:
        """Something took place that finds, clears or repairs: "power-up", "run", "program", "devices", "force" and so on."""
        for code, row in self.rows.items():
            if what in row.found and code in self.damaged:
                self.found.add(code)
                if what in row.cleared and "damage" not in row.found:  # a loss that is over when it was noticed
                    self.damaged.discard(code)
            elif what in row.cleared:
                if what not in ("power-up", "run", "repair") and "damage" not in row.found:
                    self.damaged.discard(code)  # the part is a new one
                if code not in self.damaged:
                    self.found.discard(code)
        self.show()

    def damage(self, code: int) -> None:
        """Damage a part; hardware is noticed at once, files and memories when the machine looks at them next."""
        self.damaged.add(code)
        if "damage" in self.rows[code].found:
            self.found.add(code)
            self.show()

    def repair(self, code: int) -> None:
        """Make a part whole again."""
        self.damaged.discard(code)
        self.happen("repair")

    @property
    def codes(self) -> list[int]:
        """The system errors that are present, the gravest first; errors of execution stand in SD20."""
        rows = [self.rows[code] for code in self.found if self.rows[code].kind == "system"]
        return [row.code for row in sorted(rows, key=lambda row: (not row.stops, -LAMPS.index(row.lamp), row.code))]

    @property
    def stopping(self) -> bool:
        """Whether one of them keeps the PLC in STOP."""
        return any(self.rows[code].stops for code in self.codes)

    @property
    def met(self) -> int:
        """The code of damage in the program that its execution meets, 0 without one."""
        return min((code for code in self.damaged if self.rows[code].kind == "execution"), default=0)

    def show(self) -> None:
        """Tell of the errors in special relays and registers."""
        model, codes = self.memory.model, self.codes
        if model.fault_groups is not None:
            for group in {group_of(model, code) for code in self.rows}:
                show_group(self.memory, group, next((model.fault_code(code) for code in codes if group_of(model, code) == group), 0))
        relays, registers = self.memory.lists[model.special_bits], self.memory.lists[model.special_words]
        if "system error" in model.relays:
            relays[model.relays["system error"]] = bool(codes)
        if "system error" in model.registers:
            registers[model.registers["system error"]] = codes[0] if codes else 0
        for relay in {row.relay for row in self.rows.values()} & model.relays.keys():
            relays[model.relays[relay]] = any(self.rows[code].relay == relay for code in codes)

    def snapshot(self) -> tuple[tuple[int, ...], ...]:
        return tuple(tuple(sorted(codes)) for codes in (self.damaged, self.found))

    def restore(self, snapshot: tuple[tuple[int, ...], ...]) -> None:
        self.damaged, self.found = map(set, snapshot)
