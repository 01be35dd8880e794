"""What state a PLC is in: mode switch, RUN and STOP, power and battery, damage and the errors and lamps that tell of it (2.1.6, 2.3, 2.4.2)."""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps

from .assembler.inputs import occupied
from .errors import EcsimError
from .hardware.faults import ERRORS, KNOWN, LAMPS, Faults, SystemErrors
from .hardware.serial import Port
from .hardware.supply import Supply
from .system import within

SWITCH = ("ON", "TM", "OFF")
HOUR_US = 3_600_000_000
OPPOSITES = {"running": "not running", "first scan": "not first scan"}  # relays that are OFF while the others are ON
EEPROM, RETAINED, FORCES, INFORMATION, TRANSLATION = 24, 43, 44, 45, 60


def alone(method: Callable) -> Callable:
    """Let a method of Plc wait until no other thread is in the middle of a scan or a change."""

    @wraps(method)
    def waiting(self, *arguments, **named):
        with self.lock:
            return method(self, *arguments, **named)

    return waiting


@dataclass(frozen=True)
class MachineError:
    """One error that the machine reports, in words: what it means, what it does, what helps."""

    code: int
    meaning: str
    effect: str = ""
    remedy: str = ""
    section: str = "appendix 6"

    def __str__(self) -> str:
        return f"{self.code}: {self.meaning} (manual {self.section})"


class States:
    """The part of a Plc that changes its state; memory, units and engine are the Plc's own."""

    lock: threading.RLock
    faults: Faults
    health: SystemErrors
    supply: Supply
    ports: list[Port]
    power_ups = 0  # how often it has started up since it was made

    # -- RUN and STOP -------------------------------------------------------------------------------------------

    @property
    def switch(self) -> str:
        """The mode switch: "ON", "TM" or "OFF". Turned to ON it puts the PLC into RUN, turned to OFF into STOP (2.3.2).

        At TM port 0 speaks the programming protocol, whatever the system block says (10.1).
        """
        return self._switch

    @switch.setter
    @alone
    def switch(self, position: str) -> None:
        turned = str(position).upper()
        if turned not in SWITCH:
            raise EcsimError(f"the mode switch has no position {position!r}; choose {' or '.join(SWITCH)}")
        before, self._switch = self._switch, turned
        self.ports[0].reserve(turned == "TM")
        if turned == "OFF":
            self.stop()
        elif turned == "ON" and before != "ON" and self.supply.powered:
            self._enter_run()

    @alone
    def run(self) -> None:
        """STOP -> RUN by the programming software, with the mode switch at ON or TM: retained devices stay, EEPROM and data block are
        loaded, all else is cleared unless values are held (2.1.6).

        A PLC with a serious system error stays in STOP; `errors` tells why. Raises EcsimError without power and with the switch at OFF.
        """
        if self.running:
            return
        self._need_power()
        if self._switch == "OFF":
            raise EcsimError("the mode switch is OFF, which allows no RUN; set plc.switch to 'ON' or 'TM' (2.3.2)")
        self._enter_run()

    def _enter_run(self) -> None:
        if self.running:
            return
        self.health.happen("run")
        if self.health.stopping:
            return
        self._halted = 0
        if self.model.clears_at_stop:
            self._begin_run()
        else:
            self._initialise(hold=self.system.hold_values)
            self._init_special(power_up="power up" in self.model.relays and bool(self._special[0][self.model.relays["power up"]]))
        if self.health.met == TRANSLATION:
            self._stop_with(TRANSLATION)
            return
        self._tell("running", True)
        self._tell("first scan", True)
        self._special[1][self.model.registers["least scan time"]] = 0
        self.memory.slots(self.program.slots)
        self.modules.set_up(self.system.modules)
        self.clocks.restart(self.clock[0])
        self.timers.restart()
        self._restart_units()
        self._assign()
        self.running = self._first = True

    def _assign(self) -> None:
        """Tell inputs and interrupts what the program needs of them."""
        self.inputs.assign(*occupied(self.program.units, self.model))
        self.interrupts.assign({unit.event: unit.name for unit in self.program.units if unit.event is not None})

    @alone
    def stop(self) -> None:
        """RUN -> STOP: values are kept, outputs do what the system block says (2.3.3)."""
        if not self.running:
            return
        self.running = False
        self._set_constant_scan(self.system.constant_scan_ms)
        self._run_level = self._at_run_input(self.memory.lists["X"])
        self._tell("running", False)
        self._restart_units()
        if self.model.clears_at_stop:
            self._end_run()
            return
        if self.system.stop_outputs == "freeze":
            return
        self.memory.clear("Y")
        if self.system.stop_outputs == "configure":
            for name, state in self.system.stop_output_table.items():
                device, kind = self.memory.parse(name)
                self.memory.set(device, kind, state)

    def _begin_run(self) -> None:
        """RUN of a PLC that has cleared its devices before: outputs begin OFF, the errors of the last run are forgotten."""
        self.memory.clear("Y")
        self._load(self.system.retention(self.model))
        self.faults.forget()
        self.health.show()
        self._obey()

    def _end_run(self) -> None:
        """What is not retained is cleared, and every special relay that programs write; "hold memory" leaves all, outputs too."""
        if self._says("hold memory"):
            return
        self._clear(self.system.retention(self.model))
        relays = self.memory.lists[self.model.special_bits]
        kept = self.model.read_only_relays | self.model.latched_relays
        for number in self.model.special(self.model.special_bits):
            relays[number] = relays[number] and number in kept

    def _stop_with(self, code: int) -> None:
        """A serious execution error: STOP and the ERR lamp; SM20 and SD20 tell of it, SM3 and SD3 belong to system errors (2.4.2)."""
        self._services["FRAMES"].clear()
        self.faults.note(code)
        self._halted = code
        self.stop()

    def _meet(self) -> bool:
        """Execute a program that is damaged: it is stopped before it does anything."""
        self._stop_with(self.health.met)
        return False

    def _at_run_input(self, levels: list) -> bool:
        """The level of the input that puts the PLC into RUN; ON where none does."""
        if self.system.run_input is None:
            return True
        return bool(levels[self.memory.parse(self.system.run_input)[0].number])

    def _rest(self, now: int) -> bool:
        """Before a scan in STOP: the run input going ON ends it (2.3.2). False without power: then nothing happens."""
        if not self.supply.powered:
            return False
        if self.inputs.changed:
            self.inputs.refresh(now)
        if self.system.run_input is not None:
            before, self._run_level = self._run_level, self._at_run_input(self.memory.lists["X"])
            if self._run_level and not before and self._switch == "ON":
                self._enter_run()
        return True

    # -- power --------------------------------------------------------------------------------------------------

    @property
    def powered(self) -> bool:
        """Whether the PLC has power. Without it time goes by, and that is all."""
        return self.supply.powered

    def _need_power(self) -> None:
        if not self.supply.powered:
            raise EcsimError("the PLC has no power; power_on() gives it")

    @alone
    def power_off(self) -> None:
        """Switch the power off for longer than the PLC can bridge: its power-loss program runs (9.7), then it stops, all outputs OFF."""
        if not self.supply.powered:
            return
        self.supply.mains = False
        self.supply.show()
        if self.running:
            self.interrupts.fire(self.model.power_loss_event)
            self._serve_queue()
        self.stop()
        for port in self.ports:
            port.power(False)
        self.memory.clear("Y")
        self.supply.powered = False
        self.supply.since = self.clock[0]
        self.supply.watch()

    @alone
    def power_on(self) -> None:
        """Switch the power on: what is not retained is cleared, then RUN if switch and run input say so (2.1.6, 2.3.2)."""
        if self.supply.powered:
            return
        supply, now = self.supply, self.clock[0]
        lost, supply.lost = supply.lost, False
        supply.powered = supply.mains = True
        self.inputs.advance(now)
        bridged = self.model.limits.get("clock hours")
        if lost or (bridged is not None and now - supply.since > bridged * HOUR_US):
            self.rtc.lose(now)
        self._start_up(lost)

    @alone
    def power_cycle(self, off_ms: float | None = None) -> None:
        """Power off and on again; what is forced stays so (2.4.6).

        Without `off_ms` it takes no simulated time. With it the mains fail for so many milliseconds: the PLC works on for its detection
        time (SD5; EC10 has none), with SM5 ON; a failure that is not longer has no other effect (2.2.1).
        """
        if off_ms is None:
            self.power_off()
            self.power_on()
            return
        within("off_ms", off_ms, 0, 1e12)
        self._need_power()
        scans, off_us, patience = self.scans, round(off_ms * 1000), self.supply.patience_us
        failed = self.clock[0]
        self.supply.mains = False
        self.supply.show()
        while self.clock[0] < failed + patience:
            self._one_scan()
        if off_us > patience or not patience:
            self.power_off()
            self.clock[0] = max(self.clock[0], failed + off_us)
            self.power_on()
        self.supply.mains = True
        self.supply.show()
        self.scans, self._asked = (
            scans,
            self.clock[0],
        )  # scans that nobody asked for are not counted: a step back repeats all this as one action

    @alone
    def reset(self) -> None:
        """Begin anew as after power-up, with nothing lost: what is not retained is cleared, then RUN if switch and run input say so."""
        self._need_power()
        self.stop()
        self._start_up()

    def _start_up(self, lost: bool = False) -> None:
        """Power-up or reset; `lost` tells that the memory had no supply."""
        self.power_ups += 1
        if lost and not self.supply.no_battery:
            for code in {RETAINED, FORCES, INFORMATION} & self.health.rows.keys():
                self.health.damage(code)
        kept = not (lost or RETAINED in self.health.damaged)
        if lost or FORCES in self.health.damaged:
            self.memory.hold({})
        self.modules.power_up()
        self.health.happen("power-up")
        for port in self.ports:
            port.power(True)
        self._halted = 0
        self._rebind()
        self._initialise(hold=False, kept=kept)
        self.inputs.waiting.clear()
        self.inputs.changed = True
        self._init_special(power_up=True, keep_pulses=False)
        self._restart_units()
        self._run_level = self._at_run_input(self.inputs.terminals)
        if self._switch == "ON" and self._run_level:
            self._enter_run()

    @property
    def battery(self) -> str:
        """The battery: "present", "failing" or "absent"; may be changed at any time. "" on a model without one."""
        return self.supply.battery

    @battery.setter
    @alone
    def battery(self, state: str) -> None:
        self.supply.change_battery(state)

    @property
    def dc24(self) -> bool:
        """Whether the 24 V for the inputs are there (SM6 tells of a failure); may be switched off and on."""
        return self.supply.dc

    @dc24.setter
    @alone
    def dc24(self, on: bool) -> None:
        self.supply.change_dc(bool(on), self.clock[0])

    @property
    def driven(self) -> list:
        """What the output terminals carry: the image Y, or all OFF while a special relay switches the outputs off."""
        image = self.memory.lists["Y"]
        return [False] * len(image) if self._says("outputs off") else image

    # -- errors -------------------------------------------------------------------------------------------------

    def _part(self, part: str) -> int:
        code = self.health.parts.get(part) if isinstance(part, str) else None
        if code is None:
            raise EcsimError(f"{self.model.name} has no part {part!r} to be damaged; it has {', '.join(self.health.parts)}")
        return code

    @alone
    def damage(self, part: str) -> None:
        """Damage a part, as an error of appendix 6 supposes it: "program", "data block", "SRAM", "clock" ... (see docs/errors.md).

        Hardware is noticed at once, files and memories when the PLC looks at them: at power-up, most of them at STOP -> RUN too.
        """
        self.health.damage(self._part(part))
        self.eeprom.sound = EEPROM not in self.health.damaged
        if self.health.stopping:
            self.stop()
        self._rebind()

    @alone
    def repair(self, part: str) -> None:
        """Make a damaged part of the hardware whole; files are renewed by downloading them."""
        code = self._part(part)
        row = ERRORS[code]
        if "damage" not in row.found:
            raise EcsimError(f"the {part} cannot be repaired: {row.remedy}")
        self.health.repair(code)
        self.eeprom.sound = EEPROM not in self.health.damaged

    @property
    def system_error(self) -> int:
        """The gravest error that keeps SM3 ON or has stopped the PLC, 0 without one."""
        return self.model.fault_code(next(iter(self.health.codes), self._halted))

    @property
    def stopped_by(self) -> int:
        """The error that keeps the PLC in STOP, 0 without one."""
        return self.system_error if self.health.stopping else self.model.fault_code(self._halted)

    @property
    def errors(self) -> list[MachineError]:
        """What SD3 and SD20 to SD24 say, in words, system errors first."""
        found = [*self.health.codes, *([self._halted] if self._halted else [])]
        rows = {code: KNOWN[code] for code in (*map(self.model.fault_code, found), *self.faults.codes())}
        return [MachineError(code, row.meaning, row.effect, row.remedy) for code, row in rows.items()]

    @property
    def lamps(self) -> dict[str, str]:
        """The lamps on the front: RUN, ERR and BAT, each "off", "on" or "flashing"."""
        if not self.supply.powered:
            return dict.fromkeys(("RUN", "ERR", "BAT"), "off")
        states = [ERRORS[code].lamp for code in (*self.health.codes, *([self._halted] if self._halted else []))]
        return {
            "RUN": "on" if self.running else "off",
            "ERR": max(states, key=LAMPS.index, default="off"),
            "BAT": "on" if self.supply.low and not self._says("battery lamp off") else "off",
        }

    # -- what devices begin with --------------------------------------------------------------------------------

    def _initialise(self, hold: bool, kept: bool = True) -> None:
        """The order of 2.1.6: retained (when they were kept), EEPROM, data block, held values, cleared."""
        retained = self.system.retention(self.model) if kept else {}
        if not hold:
            self._clear(retained)
        self._load(retained)

    def _clear(self, retained: dict[str, frozenset[int]]) -> None:
        """Clear what is neither an input, nor retained, nor special."""
        for area in self.model.areas:
            if area != "X":
                self.memory.clear(area, retained.get(area, frozenset()).union(self.model.special(area)))

    def _load(self, retained: dict[str, frozenset[int]]) -> None:
        """All timers stand; the data block and the EEPROM give their values to what is not retained."""
        for part in ("DUE", "REST"):
            values = self.memory.lists[part]
            values[:] = [0] * len(values)
        if self.system.data_block_valid:
            for name, value in self.system.data_block.items():
                device, kind = self.memory.parse(name)
                if device.number not in retained.get(device.area, ()):
                    self.memory.set(device, kind, value)
        self.eeprom.recall(keep=retained.get("D", frozenset()))

    def _init_special(self, power_up: bool, keep_pulses: bool = True) -> None:
        """SM and SD at their initial values, at STOP -> RUN but for the pulse counts SD50 to SD55 (appendix 2); the input filter as the
        system block has it.
        """
        self.inputs.set_filter(self.inputs.usual_us)
        model = self.model
        registers = self.memory.lists[model.special_words]
        pulses = registers[50:56]
        for area in (model.special_bits, model.special_words):
            self.memory.clear(area, range(model.first_special))
        if keep_pulses:
            registers[50:56] = pulses
        numbers = model.registers
        values = {
            "type": model.type_code, "version": 100, "capacity": model.limits["steps"] // 1000,
            "watchdog": self.system.watchdog_ms, "constant scan": self.system.constant_scan_ms, "input filter": self.inputs.filter_us // 1000,
        }  # fmt: skip
        if self.system.run_input is not None:
            values["run input"] = self.memory.parse(self.system.run_input)[0].number
        for meaning, value in values.items():
            if meaning in numbers:
                registers[numbers[meaning]] = value
        for number, value in model.initial_registers.items():
            registers[number] = value
        for port in self.ports:
            port.show()
        self._tell("running", self.running)
        self._tell("first scan", False)
        self._tell("power up", power_up)
        self._tell("constant scan", self.system.constant_scan_ms > 0)
        self._tell("run input", self.system.run_input is not None)
        self.supply.show()
        self.health.show()
        self.modules.show()

    def _tell(self, meaning: str, on: bool) -> None:
        """Turn a special relay ON or OFF by its meaning, if the model has one for it."""
        for each, state in ((meaning, on), (OPPOSITES.get(meaning), not on)):
            if each in self.model.relays:
                self.memory.lists[self.model.special_bits][self.model.relays[each]] = state

    def _says(self, meaning: str) -> bool:
        """Whether a special relay by which programs tell the machine something is ON; not where the model has none."""
        number = self.model.relays.get(meaning)
        return number is not None and bool(self.memory.lists[self.model.special_bits][number])
