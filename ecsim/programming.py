"""What the programming software does with a PLC (2.4): download, upload, change in RUN, clear, format, passwords, monitor."""

import copy
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from .assembler import Program, assemble
from .devices import Device
from .editing import keep_memory, refusals
from .engines import CompiledEngine
from .errors import EcsimError
from .monitor import Monitor
from .project import Project
from .protection import KINDS, Protection
from .states import INFORMATION, alone
from .system import SystemBlock
from .upload import unsealed, uploaded

LARGEST_READING = 500  # D registers (2.4.7)


class Programming:
    """The part of a Plc that the programming software reaches."""

    def __init__(self) -> None:
        self.lock = threading.RLock()  # a scan in progress has it, and so has what must not come between: load, force, run ...
        self.program: Program | None = None
        self.downloads = 0  # how often a program was loaded; a change in RUN is none
        self.protection = Protection()
        self._files: dict[str, str] = {}
        self._line: list[Program] = []  # the program that was loaded, and what became of it in RUN

    # -- download, upload -------------------------------------------------------------------------------------------

    @alone
    def load(self, program: "str | Path | Project | Program") -> Program:
        """Download a program: its text, the path of an .il file or project folder, a Project, or a Program (2.4.1). A running PLC is stopped first.

        What a project sets comes with it: a system block and a data block take the place of those that are there, as a whole, and so do
        passwords; what it says nothing about stays. Its `io` is for a Plc that was made without one; others keep what they have. Devices
        keep their values until RUN. A program that does not compile raises ProgramError, and everything stays as it is, running if it ran.
        """
        self._need_power()
        project = None
        if not isinstance(program, Program):
            project = Project.of(program)
            project.check(self.model)
            program = project.compile(self.model)
        self._check_model(program)
        self.protection.demand("download")
        self._take_program(program, unsealed(project.files)[0] if project else {"": program.source})
        if project is not None:
            self._take_settings(project)
        return program

    def _take_program(self, program: Program, files: dict[str, str]) -> None:
        engine = self._engine_for(program, self.memory.slots)
        if self.running:
            self.stop()
        self.health.happen("program")
        self._files = files
        self.downloads += 1
        self._line = [program]
        self._install(program, engine)

    def _check_model(self, program: Program) -> None:
        if program.model.name != self.model.name:
            raise EcsimError(
                f"the program was compiled for {program.model.name}, this is an {self.model.name}; compile it for {self.model.name}"
            )

    def _take_settings(self, project: Project) -> None:
        scan_ms = self.scan_ms if project.scan_ms is None else project.scan_ms
        system = copy.deepcopy(project.system or self.system)
        if system.input_filter_ms is None:
            system.input_filter_ms = self.system.input_filter_ms
        self._settle(scan_ms, system)
        if project.io is not None and self.modules.base is None and not self.modules:
            self.modules.configure(project.io)
        if project.system is not None:
            self.health.happen("system block")
            self.health.happen("data block")
        if project.passwords is not None:
            self.protection.download(replace(project.passwords))

    def _engine_for(self, program: Program, make_room: Callable[[int], None]) -> CompiledEngine:
        """An engine that runs a program; when there cannot be one, the program that is there goes on as before."""
        engine = CompiledEngine.__new__(CompiledEngine)
        slots = self.memory.lists["E"]
        kept = list(slots)
        make_room(program.slots)
        try:
            engine.__init__(program, self.memory, self._services)
        except BaseException:
            slots[:] = kept
            raise
        return engine

    def _install(self, program: Program, engine: CompiledEngine) -> None:
        """Let the PLC run a program from now on."""
        self.program = program
        self._program_ns = program.main.length() * self.model.instruction_ns
        self._routine_ns = {unit.name: unit.length() * self.model.instruction_ns for unit in program.units if unit.event is not None}
        self._engines = {CompiledEngine: engine}
        self._names = {name.casefold(): variable.device for name, variable in program.variables.items()}
        self._with_locals = {
            unit.name
            for unit in program.units
            if any(getattr(operand, "area", None) in self.model.local_areas for i in unit.instructions for operand in i.operands)
        }
        self._choose_engine()

    @alone
    def upload(self) -> Project:
        """The program, system block and data block as a Project (2.4.1). Units that a password closes come sealed: they can be downloaded, not
        read. Names of variables and comments are missing while the user information file is damaged (error 45).

        Raises EcsimError when the upload is forbidden, or closed by a password that has not been given.
        """
        if self.protection.passwords.forbid_upload:
            raise EcsimError("the upload was forbidden with the last download; download again with forbid_upload = false (2.1.11)")
        self.protection.demand("upload")
        files = uploaded(self.program, self._files, informed=INFORMATION not in self.health.damaged)
        return Project(files, model=self.model.name, scan_ms=self.scan_ms, system=copy.deepcopy(self.system), io=self.modules.io)

    @alone
    def unlock(self, what: str, password: str) -> None:
        """Give a password (2.1.11): `what` is "upload", "download", "monitor" or the name of a program unit.

        Raises EcsimError for a wrong one; ten in a row lock the entry for 5 minutes of simulated time.
        """
        if not isinstance(what, str) or not isinstance(password, str):
            raise EcsimError(f"unlock({what!r:.40}, {password!r:.40}): both are texts, what is opened and its password (2.1.11)")
        if what in KINDS:
            self.protection.enter(what, getattr(self.protection.passwords, what), password, self.time_us)
        else:
            unit = self.program.unit(what)
            self.protection.enter(unit.name, unit.password, password, self.time_us)
            unit.opened = True

    # -- a change in RUN ----------------------------------------------------------------------------------------

    @alone
    def edit(self, program: "str | Path | Project | Program") -> Program:
        """Change the code in RUN (2.4.3): the next scan runs the new program, no device changes its value.

        Instructions that stand in both programs remember the scan before, and hold what they held (a pulse output, a comparison); new ones
        begin as in the first scan. What hardware the others held is given back, a timer that none drives any longer stands still, and
        outputs whose coils are gone stay as they are. Raises EcsimError in STOP, and when variables or the set of units differ.
        """
        files = None if isinstance(program, Program) else unsealed(Project.of(program).files)[0]
        program = self.check_edit(program)
        former, slots = self.program, self.memory.lists["E"]
        kept, gone = keep_memory(former, program)
        held = [instruction.slot for instruction in gone if instruction.definition.claims and slots[instruction.slot]]
        values = [slots[number] if number in kept else False for number in range(max(program.slots, len(slots)))][: program.slots]

        def make_room(count: int) -> None:
            slots[:] = values

        engine = self._engine_for(program, make_room)
        for claim in held:
            self.release(claim)
        self._line.append(program)
        self._install(program, engine)
        self._assign()
        for number in _driven_timers(former) - _driven_timers(program):
            self.memory.lists["DUE"][number] = 0
            self.timers.watched.pop(number, None)
        self._files = files or {"main.il": program.source}
        self.health.happen("program")
        return program

    def check_edit(self, program: "str | Path | Project | Program") -> Program:
        """The program that `edit` would take; raises what `edit` would raise, and changes nothing."""
        if not self.running:
            raise EcsimError("the PLC is in STOP, so nothing is changed in RUN; load() the program (2.4.3)")
        self.protection.demand("download")
        if isinstance(program, Program):
            self._check_model(program)
            program = assemble(program.source, self.model)  # a copy: it gets its places in memory from the one that runs
        else:
            project = Project.of(program)
            project.check(self.model)
            program = project.compile(self.model)
        why = refusals(self.program, program)
        if why:
            raise EcsimError(f"this cannot be changed in RUN: {'; '.join(why)}; stop() and load() it (2.4.3)")
        for unit in program.units:
            former = self.program.unit(unit.name)
            unit.password, unit.opened = unit.password or former.password, former.opened
        return program

    def has_been(self, program: Program) -> bool:
        """Whether the program is the one that was loaded, or what became of it in RUN."""
        return any(each is program for each in self._line)

    def return_to(self, program: Program) -> None:
        """Run what the program was before a change in RUN, or after it; raises EcsimError for one of another download."""
        if not self.has_been(program):
            raise EcsimError("the snapshot was taken with another program; load that one first")
        slots = self.memory.lists["E"]
        self._install(program, self._engine_for(program, lambda count: slots.__setitem__(slice(None), [False] * count)))
        self._assign()

    # -- clear, format ------------------------------------------------------------------------------------------

    @alone
    def clear(self, what: str) -> None:
        """Clear "devices", the "program" or the "data block" (2.4.4); raises EcsimError in RUN. Forced devices stay forced."""
        acts = {"devices": self._clear_devices, "program": self._clear_program, "data block": self._clear_data_block}
        if not isinstance(what, str) or what not in acts:
            raise EcsimError(f"{what!r} cannot be cleared; choose {', '.join(acts)}")
        self._demand_stop(f"the {what}")
        acts[what]()

    @alone
    def format(self) -> None:
        """Clear the whole PLC (2.4.4): program, system block, data block, passwords, forced devices and values.

        Raises EcsimError in RUN, and when the system block locks it (2.1.11).
        """
        if self.system.format_lock:
            raise EcsimError("the system block locks the format; download one with format_lock = false first (2.1.11)")
        self._demand_stop("the whole PLC")
        self.health.happen("format")
        self.unforce()
        self.protection = Protection()
        self._settle(self.scan_ms, SystemBlock())
        self._clear_program()
        self._clear_devices()

    def _demand_stop(self, what: str) -> None:
        self._need_power()
        if self.running:
            raise EcsimError(f"{what} can be cleared in STOP only; stop() the PLC first (2.4.4)")

    def _clear_devices(self) -> None:
        for area in self.model.areas:
            if area != "X":
                self.memory.clear(area, self.model.special(area))
        self.memory.lists["E"][:] = [False] * len(self.memory.lists["E"])
        self.health.happen("devices")
        self._init_special(power_up=False)
        self.inputs.changed = True

    def _clear_program(self) -> None:
        self._take_program(assemble("", self.model), {"": ""})

    def _clear_data_block(self) -> None:
        self._settle(self.scan_ms, replace(self.system, data_block={}))
        self.health.happen("data block")

    # -- looking ------------------------------------------------------------------------------------------------

    def monitor(self, *names: str, fmt: "str | dict[str, str] | None" = None) -> Monitor:
        """A table of devices that shows their values whenever it is shown (2.4.6).

        A name is a device, a variable, or either with a type ("D10:REAL"). `fmt` is "decimal", "hex", "binary", "octal", "float" or "text" for
        all rows, or a dict of them by name. Raises EcsimError for a name that there is not, and without the password for monitoring.
        """
        self.protection.demand("monitor")
        return Monitor(self, names, fmt)

    @alone
    def read_data(self, first: str = "D0", count: int = LARGEST_READING) -> dict[str, int]:
        """The values of up to 500 D registers as a data block (2.4.7): add it to `project.system.data_block`, or put it there instead."""
        device, _ = self.memory.parse(first, self._names)
        if not isinstance(device, Device) or device.area != "D":
            raise EcsimError(f"{first} is no D register; a data block holds D devices")
        room = min(LARGEST_READING, self.model.areas["D"].count - device.number)
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= room:
            raise EcsimError(f"{count!r} registers from {device}; read from 1 to {room} at a time (2.4.7)")
        return {f"D{number}": self.memory.lists["D"][number] for number in range(device.number, device.number + count)}

    @property
    def information(self) -> dict[str, Any]:
        """What the PLC tells of itself (2.4.5): model, firmware, program, state, times in ms, errors, clock, forced devices."""
        registers, numbers = self.memory.lists[self.model.special_words], self.model.registers

        def shown(meaning: str) -> int:
            return registers[numbers[meaning]]

        def ms(meaning: str) -> float:
            return shown(meaning) * self.model.scan_time_us / 1000

        return {
            "model": self.model.name,
            **({"firmware": shown("version") / 100} if "version" in numbers else {}),
            "state": "RUN" if self.running else "STOP",
            "steps": self.program.steps,
            "capacity": self.model.limits["steps"],
            "scan_ms": ms("scan time"),
            "least_scan_ms": ms("least scan time"),
            "greatest_scan_ms": ms("greatest scan time"),
            "constant_scan_ms": shown("constant scan"),
            "watchdog_ms": shown("watchdog"),
            "errors": [str(error) for error in self.errors],
            "clock": self.clock_time,
            "forced": len(self.forced),
        }


def _driven_timers(program: Program) -> set[int]:
    written = (i.operands[0] for i in program.instructions if i.definition.form == "always" and i.operands)
    return {device.number for device in written if getattr(device, "area", "") == "T"}
