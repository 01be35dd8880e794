"""Plc: one machine with its program, in exact simulated time."""

import copy
from collections.abc import Iterable
from dataclasses import replace
from datetime import datetime
from numbers import Integral
from operator import itemgetter
from pathlib import Path
from typing import Any

from . import saved
from .assembler import assemble
from .comms.protocols import PROTOCOLS
from .devices import Bits, Device
from .engines import CompiledEngine, SteppingEngine, Trace
from .engines.access import functions
from .errors import WATCHDOG, EcsimError
from .hardware.analog import AnalogPoint, BaseAnalog, Channel, analog_channels, analog_point
from .hardware.clocks import Clocks
from .hardware.counters import Counters
from .hardware.eeprom import Eeprom
from .hardware.faults import Faults, SystemErrors
from .hardware.inputs import Inputs
from .hardware.interrupts import Interrupts
from .hardware.limits import FrequencyLimits
from .hardware.meters import Meters
from .hardware.modules import Rack
from .hardware.pots import Potentiometers
from .hardware.pulses import PulseOutputs, Wired
from .hardware.rtc import RealTimeClock
from .hardware.serial import Port
from .hardware.servo import ServoReader
from .hardware.signals import PARTS, Signal, Train, bouncing, changes, quadrature
from .hardware.steps import Steps
from .hardware.supply import Supply
from .hardware.timers import Timers
from .hardware.unit import Unit
from .memory import Memory
from .models import Model, get_model
from .programming import Programming
from .states import States, alone
from .system import SystemBlock, within
from .values import BOOL, DataType

# What changes while a Plc runs and is neither memory nor unit.
STATE = ("scans", "running", "_switch", "_halted", "_run_level", "_first", "_asked", "_took_ns", "_limit_ns", "_noted_us")
LONGEST_NS = 5_000_000_000  # a program that takes longer is stopped (61) even where WDT or a watchdog of 0 would let it run


class Overrun(Exception):
    """The user program took longer than the watchdog allows."""


class Plc(Programming, States):
    """A PLC that is powered and in STOP. `scan_ms` is the fixed scan period, None models it from the steps that are gone through.

    `input_filter_ms` overrides the model's filter (10 ms EC20, 8 ms EC10); `system` is the whole system block. `io` names the
    base unit and its modules, (24, 16) or [(24, 16), (8, 8), "4AD"]; without it every X and Y has a terminal.
    """

    def __init__(
        self,
        model: str | Model = "EC20",
        scan_ms: float | None = 10,
        input_filter_ms: float | None = None,
        system: SystemBlock | None = None,
        io: tuple | list | None = None,
    ):
        super().__init__()
        self.model = get_model(model)
        self.scan_ms = scan_ms
        self.system = replace(system or SystemBlock(), **({} if input_filter_ms is None else {"input_filter_ms": input_filter_ms}))
        self._check_settings(scan_ms, self.system)
        input_filter_ms = self.model.filter_ms if self.system.input_filter_ms is None else self.system.input_filter_ms
        self.memory = Memory(self.model)
        self.faults = Faults(self.memory)
        self.clock = [0]
        self._awake: list[Unit] = []  # the units that time has to ask
        self.health = SystemErrors(self.memory, self._awake)
        self.supply = Supply(self.memory, self._awake)
        watchers: list[Unit] = []
        self.inputs = Inputs(self.memory, input_filter_ms, self._awake, watchers)
        self.interrupts = Interrupts(self.memory, self.faults, self._awake)
        self.interrupts.inputs = self.inputs
        self.counters = Counters(self.memory, self.inputs, self.interrupts, self.faults, self._awake)
        self.meters = Meters(self.memory, self.inputs, self._awake)
        self.outputs = PulseOutputs(self.memory, self.inputs, self.interrupts, lambda: self.period_us, self._awake)
        self.servo = ServoReader(self.memory, self._awake)
        watchers += (self.counters, self.meters, self.interrupts, self.outputs)
        self.limits = FrequencyLimits(self.inputs, self.counters, self.meters, self.interrupts, self._awake)
        self.inputs.check = self.limits.check
        if self.model.captures_when_enabled:
            self.inputs.may_catch = lambda: self.interrupts.enabled
        self.rtc = RealTimeClock(self.memory, self._awake)
        self.eeprom = Eeprom(self.memory, self._awake)
        self.pots = Potentiometers(self.model.limits.get("potentiometers", 0), self._awake)
        self.modules = Rack(self.memory, self.health, self.supply, self._awake, self.clock)
        if io is not None:
            self.modules.configure(io)
        self.analog = BaseAnalog(self.memory, self.supply, lambda: self.modules.analog_points, self._awake, self.clock)
        self.units: dict[str, Unit] = {
            "counters": self.counters, "meters": self.meters, "inputs": self.inputs, "interrupts": self.interrupts,
            "outputs": self.outputs, "servo": self.servo, "limits": self.limits,
            "rtc": self.rtc, "eeprom": self.eeprom, "pots": self.pots, "modules": self.modules, "analog": self.analog,
            "health": self.health, "supply": self.supply,
        }  # fmt: skip
        self.ports = [
            Port(number, self.memory, self.interrupts, self.clock, self._awake, PROTOCOLS) for number in range(len(self.model.ports))
        ]
        self.units |= {port.name: port for port in self.ports}
        self.timers = Timers(self.memory, self.clock)
        self._transitions = [False]  # whether those of the charts are held
        self.steps = Steps(self.memory, self._transitions) if self.model.overlap else None
        self.clocks = Clocks(self.memory)
        self.running = False
        self.scans = 0
        self._switch = "ON"
        self._halted = 0  # the serious execution error that has stopped the PLC
        self._run_level = False  # of the run input, when it was looked at last
        self._engines: dict[type, CompiledEngine | SteppingEngine] = {}
        self._tracing = self._stepping = False
        self._asked = 0
        self._spent = [0]  # ns that program and interrupt programs have taken since the main program ended the last time
        self._took_ns = self._program_ns = 0  # what that came to when it ended; what it takes without loops and calls
        self._limit_ns = 0  # what they may take
        self._noted_us = 0
        self._first = True
        self._names: dict[str, Device] = {}
        self._special = self.memory.lists[self.model.special_bits], self.memory.lists[self.model.special_words]
        self._constant_relay = self.model.relays.get("constant scan")
        self._governed = self._constant_relay not in (None, *self.model.read_only_relays)  # programs govern the machine
        numbers = self.model.registers
        by_ports = [number for port in self.ports for meaning, number in port.map.registers.items() if meaning in ("mode", "protocol")]
        if self._governed:
            self._orders = itemgetter(numbers["constant scan"], numbers["watchdog"], *by_ports)  # the registers that they do it by
        self._told = None, ()  # what they held when they were looked at last
        self._services = {
            **functions(self.memory),
            "CLOCK": self.clock,
            "FRAMES": [],
            "tick": self.timers.tick,
            "begin": self.timers.begin,
            "resume": self.timers.resume,
            "watch": self.timers.watch,
            "fault": self.faults.note,
            "executed": self.faults.executed,
            "spend": self._spend,
            "SPENT": self._spent,
            "HELD": self._transitions,
            **({"ENDING": self.steps.ending, "hand_over": self.steps.hand_over} if self.steps else {}),
            "release": self.release,
            "placed": self.memory.placed,
            "machine": self,
        }
        self._settle(scan_ms, self.system)
        self._init_special(power_up=True)
        self._restart_units()
        self.load("")

    def _check_settings(self, scan_ms: float | None, system: SystemBlock) -> None:
        """Raise EcsimError for what this model cannot be set to."""
        if scan_ms is not None:
            within("scan_ms (None to model it)", scan_ms, 0.001, 60_000)
        system.check(self.model)

    def _settle(self, scan_ms: float | None, system: SystemBlock) -> None:
        """Take over the period of a scan and the system block."""
        self.scan_ms, self.system = scan_ms, system
        self.supply.loss_ms, self.supply.no_battery = system.power_loss_ms, system.no_battery
        self._set_constant_scan(system.constant_scan_ms)
        self._watchdog_ns = system.watchdog_ms * 1_000_000
        self.inputs.usual_us = round(1000 * (self.model.filter_ms if system.input_filter_ms is None else system.input_filter_ms))
        self.inputs.set_filter(self.inputs.usual_us)
        self.interrupts.first = frozenset(event for event, level in system.interrupt_priority.items() if level == "high")
        for port, settings in zip(self.ports, (system.port0, system.port1), strict=False):
            port.set_up(settings)

    # -- engines ------------------------------------------------------------------------------------------------

    @property
    def tracing(self) -> bool:
        """Whether scans run on the stepping engine and are recorded in `trace`."""
        return self._tracing

    @tracing.setter
    @alone
    def tracing(self, on: bool) -> None:
        self._tracing = bool(on)
        self._choose_engine()

    @property
    def engine(self) -> str:
        """The engine that runs the program: "compiled", or "stepping" (always so while tracing). It may be changed between any two scans."""
        return "stepping" if isinstance(self._engine, SteppingEngine) else "compiled"

    @engine.setter
    @alone
    def engine(self, name: str) -> None:
        if name not in ("compiled", "stepping"):
            raise EcsimError(f"there is no engine {name!r}; choose compiled or stepping")
        self._stepping = name == "stepping"
        self._choose_engine()

    @property
    def trace(self) -> Trace | None:
        """What happened in the last traced scan, None before the first one."""
        engine = self._engines.get(SteppingEngine)
        return engine.trace if engine is not None else None

    def _choose_engine(self) -> None:
        kind = SteppingEngine if self._tracing or self._stepping else CompiledEngine
        if kind not in self._engines:
            self._engines[kind] = kind(self.program, self.memory, self._services)
        self._engine = self._engines[kind]
        if kind is SteppingEngine:
            self._engine.recording = self._tracing
        self._rebind()

    def _rebind(self) -> None:
        """After a change of what is forced: the code holds the memory's lists."""
        if self._engine.generation != self.memory.generation:
            self._engine.bind()
        self._run_program = self._meet if self.health.met else self._engine.scan
        self._special = self.memory.lists[self.model.special_bits], self.memory.lists[self.model.special_words]

    # -- time ---------------------------------------------------------------------------------------------------

    def scan(self, count: int = 1) -> None:
        """`count` whole scans: input refresh, user program, housekeeping, then the time to the next scan goes by.

        In STOP the program rests, inputs and time go on.
        """
        if (type(count) is not int and not isinstance(count, Integral)) or count < 0:  # the first test is the quick one
            raise EcsimError(f"{count!r} scans; give a whole number from 0 on")
        with self.lock:
            for _ in range(count):
                self.turn()

    def turn(self) -> None:
        """One whole scan, for those who hold `lock` already."""
        self._one_scan()
        self._asked = self.clock[0]

    @alone
    def advance(self, ms: float) -> None:
        """Simulated time goes on by `ms` milliseconds: as many scans as begin in it."""
        within("ms", ms, 0, 1e12)
        self._asked = self.clock[0] + round(1000 * self.left(ms))
        while self.clock[0] < self._asked:
            self._one_scan()

    def left(self, ms: float) -> float:
        """How much of the next `ms` milliseconds lies ahead: an `advance` before may have ended in the middle of a scan."""
        return ms - (self.clock[0] - max(self._asked, self.clock[0] - self.period_us)) / 1000

    @property
    def period_us(self) -> int:
        """How long the next scan takes."""
        return self._fixed_us or self._modelled_us()

    def _modelled_us(self) -> int:
        """The time that the instructions add up to; a constant scan (SM8) waits for its end."""
        return max(self._constant_us, 1000, -(-self._took_ns // 1000))

    def _set_constant_scan(self, ms: int) -> None:
        self._constant_us, self._told = 1000 * ms, (None, ())
        self._fixed_us = 0 if self.scan_ms is None else max(round(self.scan_ms * 1000), self._constant_us)

    def _obey(self) -> None:
        """Do what the program tells the machine by special relays and registers: the constant scan, the watchdog."""
        (relays, registers), numbers = self._special, self.model.registers
        ms = max(registers[numbers["constant scan"]], 0) if relays[self._constant_relay] else 0
        if 1000 * ms != self._constant_us:
            self._set_constant_scan(ms)
        self._told = relays[self._constant_relay], self._orders(registers)
        self._watchdog_ns = 1_000_000 * max(registers[numbers["watchdog"]], 0)
        for port in self.ports:
            port.obey()

    def _one_scan(self) -> None:
        """One turn of the scan circle (2.1.2), cut before the input refresh."""
        end = self.begin_scan()
        if self._awake:
            self.go_on(end)
        self.end_scan(end)

    def begin_scan(self) -> int:
        """The scan up to its communication, in which no time passes; gives the moment in which it will end."""
        now = self.clock[0]
        if not self.running and not self._rest(now):
            return now + self.period_us
        if self._tracing and self.running:
            self._engine.begin_scan()
        if self.interrupts.queue:
            self._serve_queue()
        if self.inputs.changed:
            self.inputs.refresh(now)
        if now >= self.rtc.due:
            self.rtc.refresh(now)
        if self.running:
            self.clocks.refresh(now, self._first)
            if self.timers.watched:
                self.timers.advance()
            self._execute()
            if self._governed:
                relays, registers = self._special
                if relays[self._constant_relay] is not self._told[0] or self._orders(registers) != self._told[1]:
                    self._obey()
            period = self._fixed_us or self._modelled_us()
            if self._first or period != self._noted_us:
                self._housekeeping(period)
        else:
            period = self.period_us
        if self._awake:
            self._communicate(now)
        return now + period

    def _communicate(self, now: int) -> None:
        """The program has ended: units look at what it did, ports answer to what they were asked."""
        if self.running:
            self.interrupts.ended()
            self.interrupts.time = now
            for unit in tuple(self._awake):
                unit.look(now)
        for unit in tuple(self._awake):
            unit.serve(now)

    def end_scan(self, end: int) -> None:
        """The time of a scan has gone by."""
        self.clock[0] = end
        if self._awake:
            for unit in tuple(self._awake):
                unit.advance(end)
        self.scans += 1

    def _execute(self) -> None:
        """The user program, once. What stops it is state of the machine, not an exception."""
        spent = self._spent
        if self._first:
            spent[0], self._limit_ns = 0, self._watchdog_ns or LONGEST_NS
        spent[0] += self._program_ns
        try:
            if self._run_program():
                self.stop()
            if self.steps and (self.steps.ending or True in self._special[0][self.steps.watched]):
                self.steps.end()
            if spent[0] > self._limit_ns:
                raise Overrun
        except Overrun:
            self._stop_with(WATCHDOG)
        except Exception as error:
            raise self._our_bug(error) from error
        self._took_ns, spent[0] = spent[0], 0
        self._limit_ns = self._watchdog_ns or LONGEST_NS

    def _housekeeping(self, period_us: int) -> None:
        """After the program: first-scan relays go OFF, scan times are noted."""
        registers, numbers = self._special[1], self.model.registers
        if self._first:
            self._first = False
            self._tell("first scan", False)
            self._tell("power up", False)
            self.inputs.catching = False
        self._noted_us = period_us
        unit = self.model.scan_time_us
        period = (period_us + unit // 2) // unit
        registers[numbers["scan time"]] = period
        least = registers[numbers["least scan time"]]
        registers[numbers["least scan time"]] = min(least, period) if least else period
        registers[numbers["greatest scan time"]] = max(registers[numbers["greatest scan time"]], period)

    def _serve_queue(self) -> None:
        """The interrupt programs that the edges of inputs asked for."""
        while self.interrupts.queue and self.running:
            self._interrupt(self.interrupts.routines[self.interrupts.queue.pop(0)])

    def next_event(self, until: int) -> tuple[Unit | None, int]:
        """The unit with the first event up to `until`, and its moment; None without one."""
        first, moment, running = None, until + 1, self.running
        for unit in self._awake:
            if running or unit.in_stop:
                due = unit.next(until)
                if due is not None and due < moment:
                    first, moment = unit, due
        return first, moment

    def go_on(self, until: int) -> None:
        """All events up to `until`, in order of time; interrupt programs run at the time of their event."""
        clock, awake, interrupts = self.clock, self._awake, self.interrupts
        while True:
            first, moment = self.next_event(until)
            if first is None:
                break
            clock[0] = moment
            for unit in tuple(awake):
                unit.advance(moment)
            first.act(moment)
            if interrupts.queue:
                self._serve_queue()
                for unit in tuple(awake):
                    unit.look(moment)

    def _restart_units(self) -> None:
        """STOP or RUN: no command holds anything."""
        for unit in self.units.values():
            unit.restart(self.clock[0])

    def _interrupt(self, routine: str) -> None:
        lists = self.memory.lists
        local = self.model.local_areas if routine in self._with_locals else ()
        frame = [lists[area][:] for area in local]
        for area in local:
            self.memory.clear(area)
        if self.timers.watched:
            self.timers.advance()
        try:
            self._take(self._routine_ns[routine])
            if self._engine.run(routine):
                self.stop()
        except Overrun:
            self._stop_with(WATCHDOG)
        except Exception as error:
            raise self._our_bug(error) from error
        for area, values in zip(local, frame, strict=True):
            lists[area][:] = values

    def _spend(self, steps: int) -> None:
        """A loop or a jump back executes `steps` once more; the watchdog looks at the sum (decision on 2.1.2)."""
        self._take(max(1, steps) * self.model.instruction_ns)

    def _take(self, ns: int) -> None:
        self._spent[0] += ns
        if self._spent[0] > self._limit_ns:
            raise Overrun

    def lengthen(self, us: int) -> None:
        """An instruction takes so much more time than its steps tell."""
        self._take(1000 * us)

    def release(self, claim: int) -> None:
        """The flow of a command has gone, or its MC or step has been left: what it held is given back."""
        for unit in self.units.values():
            unit.release(claim, self.clock[0])

    def watchdog_reset(self) -> None:
        """WDT: the watchdog's time counts from zero again; the scan has taken what it has taken."""
        if self._governed:
            self._obey()
        if self._watchdog_ns:
            self._limit_ns = min(self._spent[0] + self._watchdog_ns, LONGEST_NS)

    def _our_bug(self, error: Exception) -> Exception:
        line, frames = 0, error.__traceback__
        while frames is not None:
            line = self._engine.line_in(frames.tb_frame.f_code, frames.tb_lineno) or line
            frames = frames.tb_next
        return RuntimeError(f"a bug of ecsim met in the program's line {line or 'unknown'}: {type(error).__name__}: {error}")

    @alone
    def until(self, name: str, timeout_ms: float = 10_000, value: Any = 1) -> float:
        """Scan until a device has a value (ON when none is given); the simulated ms it took. Raises EcsimError when it does not happen in time."""
        began = self.clock[0]
        while self[name] != value:
            if self.clock[0] - began >= timeout_ms * 1000:
                hint = "" if self.running else "; the PLC is in STOP, run() starts it"
                raise EcsimError(f"{name} did not become {value} within {timeout_ms:g} ms of simulated time; it is {self[name]}{hint}")
            self._one_scan()
        self._asked = self.clock[0]
        return (self.clock[0] - began) / 1000

    @property
    def clock_time(self) -> datetime:
        """Date and time of the real-time clock, which starts at 2000-01-01 0:00:00 and goes with simulated time; assign a datetime to set it."""
        return self.rtc.moment(self.clock[0])

    @clock_time.setter
    def clock_time(self, moment: datetime) -> None:
        self.rtc.put(moment, self.clock[0])

    @property
    def time_us(self) -> int:
        """Simulated time since power-up in microseconds."""
        return self.clock[0]

    # -- devices ------------------------------------------------------------------------------------------------

    def __getitem__(self, name: str) -> int | float:
        point = self.analog_point(name)
        return self.memory.get(*self.memory.parse(name, self._names)) if point is None else point.get()

    def analog_point(self, name: str) -> AnalogPoint | None:
        """The analog terminal that a name like "AI0:V" or "AO1.3:mA" stands for, None for all other names."""
        return analog_point(name, self.analog, self.modules) if str(name)[:2] in ("AI", "AO") else None

    @property
    def analog_channels(self) -> list[Channel]:
        """The analog channels of the base unit and the special modules, each with the mode that it is in."""
        return analog_channels(self.analog, self.modules)

    def __setitem__(self, name: str, value: Any) -> None:
        device, kind, value = self._check_write(name, value)
        if kind is None:
            device.put(value)
        elif device.area == "X":
            self._set_inputs(device, value)
        else:
            self.memory.set(device, kind, value)

    def _check_write(self, name: str, value: Any) -> tuple[Device | Bits | AnalogPoint, DataType | None, int | float]:
        """What a write from outside means; raises EcsimError when it cannot be done. An analog terminal has no type."""
        point = self.analog_point(name)
        if point is not None:
            point.check(value)
            return point, None, value
        device, kind = self.memory.parse(name, self._names)
        if device.area != "X":
            self._need_power()
        if self._read_only(device, kind):
            raise EcsimError(f"{name} cannot be written: the system writes it")
        if device.area == "X":
            self.modules.check("X", range(device.number, device.number + (4 * device.digits if isinstance(device, Bits) else 1)))
        return device, kind, self.memory.fitting(device, kind, value)

    get = __getitem__

    def _ipython_key_completions_(self) -> list[str]:
        """What Tab offers between the brackets: the program's names and devices."""
        return [*self.program.names().values(), *map(str, self.in_use(tuple(self.model.areas)))]

    def set(self, values: dict[str, Any]) -> None:
        """Write several devices; when one of them refuses, none is written."""
        for name, value in values.items():
            self._check_write(name, value)
        for name, value in values.items():
            self[name] = value

    def _set_inputs(self, device: Device | Bits, value: int) -> None:
        """X is the wiring: the level is held on the terminal."""
        for place in range(4 * device.digits if isinstance(device, Bits) else 1):
            self.inputs.set(device.number + place, value >> place & 1, self.clock[0])

    # -- signals ------------------------------------------------------------------------------------------------

    def pulse(self, name: str, count: int = 1, ms: float = 10, bounce_ms: float = 0) -> None:
        """Give an input `count` equal pulses in the next `ms` milliseconds; it is OFF before, between and after them.

        A later `plc["X0"] = 1` ends the signal. `bounce_ms` lets the contact bounce that long behind each edge.
        """
        self._drive(name, Train(self.clock[0], self._span(count, ms), max(1, count), count), bounce_ms)

    @staticmethod
    def _span(count: int, ms: float) -> int:
        """The us that so many pulses are to take; raises EcsimError for what cannot be."""
        if not isinstance(count, Integral) or count < 0:
            raise EcsimError(f"{count!r} pulses; give a whole number from 0 on")
        within("ms", ms, 0.001, 1e12)
        return round(ms * 1000)

    def square(self, name: str, hz: float, duty: float = 0.5) -> None:
        """Give an input pulses of `hz` without end; `duty` is the share of the period that is ON."""
        if not 0 < hz <= 200_000 or not 0 < duty < 1:
            raise EcsimError(f"{hz!r} Hz with duty {duty!r}: frequencies go up to 200000 Hz, the duty lies between 0 and 1")
        rise = round((1 - duty) * PARTS / 2)
        self._drive(name, Train(self.clock[0], 1_000_000_000, round(hz * 1000), None, rise, PARTS - rise), 0)

    def quadrature(self, a: str, b: str, count: int | None = None, direction: int = 1, ms: float = 10) -> None:
        """Give two inputs the phases of an encoder: `count` cycles in the next `ms` milliseconds, A leading for direction 1, B for -1."""
        if direction not in (1, -1):
            raise EcsimError(f"the direction is 1 or -1, not {direction!r}")
        signals = quadrature(self.clock[0], self._span(count or 0, ms), max(1, count or 1), count, direction)
        for name, signal in zip((a, b), signals, strict=True):
            self._drive(name, signal, 0)

    def signal(self, name: str, points: Iterable[tuple[float, int]], bounce_ms: float = 0) -> None:
        """Give an input a recorded or computed signal: (ms from now, level) in order of time."""
        number = self._input(name)
        self._drive(name, changes(points, self.clock[0], self.inputs.terminals[number]), bounce_ms)

    def wire(self, output: str, name: str) -> None:
        """Connect the pulse output Y0 or Y1 to an input."""
        device, _ = self.memory.parse(output, self._names)
        if not isinstance(device, Device) or device.area != "Y" or device.number >= len(self.outputs.axes):
            raise EcsimError(f"{output} is no pulse output; Y0 and Y1 are")
        self._drive(name, Wired(self.outputs, device.number), 0)

    def _input(self, name: str) -> int:
        device, _ = self.memory.parse(name, self._names)
        if not isinstance(device, Device) or device.area != "X":
            raise EcsimError(f"{name} is no input; signals go to X devices")
        self.modules.check("X", range(device.number, device.number + 1))
        return device.number

    @alone
    def _drive(self, name: str, signal: Signal, bounce_ms: float) -> None:
        number = self._input(name)
        if bounce_ms:
            signal = bouncing(signal, self.clock[0], round(bounce_ms * 1000))
        self.inputs.drive(number, signal, self.clock[0])

    @property
    def warnings(self) -> list[str]:
        """What exceeds the frequencies that counters, SPD, pulse capture and interrupts can follow (8.1.4), in words."""
        return list(self.limits.warnings)

    def _read_only(self, device: Device | Bits, kind: DataType) -> bool:
        """Whether a device lies, with a part at least, where only the system writes (3.1.9)."""
        length = 4 * device.digits if isinstance(device, Bits) else max(1, kind.words)
        return not self.model.read_only(device.area).isdisjoint(range(device.number, device.number + length))

    @alone
    def force(self, name: str, value: int) -> None:
        """Hold a bit or register at a value, whatever program and wiring say, until `unforce`."""
        self._need_power()
        device, kind = self.memory.parse(name, self._names)
        if isinstance(device, Bits) or (kind is not BOOL and kind.words != 1):
            raise EcsimError(f"{name}: one bit or one 16-bit register can be forced")
        if self._read_only(device, kind):
            raise EcsimError(f"{device} cannot be forced: the system writes it")
        self.memory.force(device, kind, self.memory.fitting(device, kind, value))
        self.health.happen("force")
        self._rebind()

    @alone
    def unforce(self, name: str | None = None) -> None:
        """Release a forced device, or all of them."""
        for each in [name] if name is not None else list(self.forced):
            self.memory.unforce(*self.memory.parse(each, self._names))
        self.inputs.changed = True
        self._rebind()

    @property
    def forced(self) -> dict[str, int]:
        """Forced devices and their values."""
        return self.memory.forced()

    @property
    def names(self) -> dict[str, str]:
        """Canonical device -> the name that the program gives it."""
        return self.program.names()

    @property
    def transitions_held(self) -> bool:
        """Whether the transitions of the charts are held: SET S, OUT S and RST S in a step do nothing though power reaches them.

        It is the debugger's, no state of the machine; all else goes on.
        """
        return self._transitions[0]

    @transitions_held.setter
    @alone
    def transitions_held(self, on: bool) -> None:
        self._transitions[0] = bool(on)

    # -- state --------------------------------------------------------------------------------------------------

    @alone
    def snapshot(self) -> dict[str, Any]:
        """Everything that changes while the PLC runs, to be given to `restore` of the same Plc with the same program."""
        return {
            "memory": self.memory.snapshot(),
            "units": {name: unit.snapshot() for name, unit in self.units.items()},
            "clocks": (self.clocks.began, self.clocks.due, self.clocks.slow_due),
            "watched": dict(self.timers.watched),
            "plc": {name: getattr(self, name) for name in STATE},
            "clock": self.clock[0],
            "spent": self._spent[0],
            "forced": self.memory.forces(),
            "program": self.program,
            "trace": copy.copy(self.trace),
        }

    @alone
    def restore(self, snapshot: dict[str, Any]) -> None:
        """Go back to a snapshot, also to what was forced then and to before a change in RUN; raises EcsimError for one of another program."""
        if snapshot["program"] is not self.program:
            self.return_to(snapshot["program"])
        self.memory.hold(snapshot["forced"])
        self.memory.restore(snapshot["memory"])
        for name, state in snapshot["units"].items():
            self.units[name].restore(state)
        self.clocks.began, self.clocks.due, self.clocks.slow_due = snapshot["clocks"]
        self.timers.watched = dict(snapshot["watched"])
        self.clock[0] = snapshot["clock"]
        for name, value in snapshot["plc"].items():
            setattr(self, name, value)
        self._spent[0] = snapshot["spent"]
        self._rebind()
        trace = snapshot["trace"]
        if trace is not None and SteppingEngine in self._engines:
            self._engines[SteppingEngine].trace = trace

    @alone
    def save(self, path: str | Path) -> None:
        """Put the whole PLC into a file, for `Plc.open`: program, system block, devices, clock, hardware, what is forced or damaged.

        The file is replaced as a whole; whatever happens meanwhile, it holds the former state or this one (docs/saving.md).
        """
        state = self.snapshot()
        del state["program"], state["trace"]
        for place, kind, buffers, _ in state["units"]["modules"]["special"]:
            self.modules.built(place, kind, buffers)  # refuses one that could not be opened again
        settings = {"model": self.model.name, "places": saved.places(self.program), "files": list(self._files)}
        settings["passwords of units"] = [(unit.password, unit.opened) for unit in self.program.units]
        settings |= {name: getattr(self, name) for name in ("scan_ms", "system", "protection", "engine", "tracing")}
        texts = {name or "main.il": text for name, text in self._files.items()}
        saved.write(path, texts, {"settings": settings, "state": state})

    @classmethod
    def open(cls, path: str | Path) -> "Plc":
        """The PLC that `save` put into a file, in the same state: it goes on as if it had never stopped.

        Raises EcsimError for a file that is missing, damaged or none of ecsim's, and says what is wrong.
        """
        with saved.reading(path) as (texts, kept):
            settings = saved.decode(kept["settings"])
            plc = cls(settings["model"], settings["scan_ms"], system=settings["system"])
            files = {name: texts[name or "main.il"] for name in settings["files"]}
            program = assemble(files, plc.model)
            saved.put_places(program, settings["places"])
            for unit, (password, opened) in zip(program.units, settings["passwords of units"], strict=True):
                unit.password, unit.opened = password, opened
            plc.load(program)
            plc._files, plc.protection = files, settings["protection"]
            state = saved.decode(kept["state"], lambda number: Wired(plc.outputs, number))
            lengths = {name: len(values) for name, values in plc.memory.lists.items()}
            if {name: len(values) for name, values in state["memory"].items()} != lengths:
                raise ValueError("other numbers of devices")
            plc.restore(state | {"program": plc.program, "trace": None})
            plc.engine, plc.tracing = settings["engine"], settings["tracing"]
        return plc

    def in_use(self, areas: Iterable[str]) -> list[Device]:
        """The devices of some areas that the program names, in order."""
        found = {
            (operand.area, operand.number)
            for instruction in self.program.instructions
            for operand in instruction.operands
            if isinstance(operand, Device) and operand.area in areas and operand.index is None
        }
        return [Device(area, number) for area in areas for _, number in sorted(pair for pair in found if pair[0] == area)]

    def __repr__(self) -> str:
        state = "RUN" if self.running else "STOP"
        return f"<Plc {self.model.name} {state}, {self.program.steps} steps>"
