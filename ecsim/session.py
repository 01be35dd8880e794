"""Session: a Plc, its plant and those who look on, as fast as possible or paced. The only module that reads the wall clock."""

import contextlib
import copy
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import takewhile
from operator import itemgetter
from typing import Any, Protocol

from .breakpoints import Breakpoint, Breakpoints
from .conditions import condition
from .errors import EcsimError
from .hardware.wire import Outlet
from .history import History
from .outside import OutsideLine
from .plc import Plc
from .record import Recording
from .sensors import ALL, Sensors
from .system import within
from .views.flows import Flow, Step, Transition, parts

FRAME_S = 1 / 30  # observers are called at most this often
SLICE_S = 0.02  # at full speed, how long scans run before actions and observers get their turn
LATE_S = 0.25  # a delay beyond this is given up instead of being made up for
LOG = 500
QUIET_S = 0.02  # an operating system hands characters over in lumps; a message has ended when none has come for so long


class Plant(Protocol):
    """What a session needs of a machine. `state()` and `restore(state)` may be there too, for the way back; else its attributes are copied."""

    wiring: Any

    def step(self, seconds: float, outputs: dict[str, int]) -> dict[str, int]: ...


@dataclass(frozen=True, slots=True)
class StepChange:
    """A step began or ended: simulated time in us, scan, step ("S20"), active or not."""

    time_us: int
    scan: int
    step: str
    active: bool


@dataclass(frozen=True, slots=True)
class Mark:
    """Something to be found again in the past of a run: before which scan, "breakpoint" or "fault", and what it was in words."""

    scan: int
    kind: str
    words: str


@dataclass(frozen=True, slots=True)
class Tip:
    """The newest moment of a run whose past is shown: its scan, its time in us, its log."""

    scan: int
    time_us: int
    log: tuple[StepChange, ...]


_sessions: dict[str, "Session"] = {}
_registry = threading.Lock()


@dataclass
class _Connection:
    """A port's way to a real line: what has come and is not yet a whole message, and when the last of it came."""

    outlet: Outlet
    line: OutsideLine
    heard: bytearray = field(default_factory=bytearray)
    since: float = 0.0


class Session:
    """Runs a Plc with its plant in one daemon thread; a new session of the same name takes the place of the former one.

    `speed` is simulated seconds for each real second, None as fast as it goes. Every method may be called from any
    thread; what changes the simulation waits until the scan in progress has ended.
    """

    def __init__(self, plc: Plc, plant: Plant | None = None, name: str = "lab", speed: float | None = 1.0, record: Recording | None = None):
        if plant is not None and (isinstance(plant, type) or not hasattr(plant, "wiring") or not callable(getattr(plant, "step", None))):
            raise EcsimError(f"{plant!r:.60} is no machine; give an object with `wiring` and `step(seconds, outputs)`, or None")
        self.plc, self.plant, self.name = plc, plant, name
        self.recording = record
        carried = getattr(plant, "sensors", None)
        self.sensors = carried if isinstance(carried, Sensors) else Sensors(plc, plant)
        self.trace_frames = False  # whether the last scan before observers are called is traced; the others run at full speed
        self.refused = ""  # why the last action was not done
        self.breakpoints = Breakpoints(plc, self._arm)
        self.hit: Breakpoint | None = None  # the breakpoint that has stopped the run
        self.marks: deque[Mark] = deque(maxlen=LOG)
        self._armed: tuple[Breakpoint, ...] = ()
        self._hooks: list[Callable[[], Any]] = []
        self._tip: Tip | None = None  # not None while the past is shown
        self._goal: int | None = None  # the scan before which a way through the past ends
        self._flows: tuple[Any, list[Step]] = (None, [])
        self._speed = _fitting_speed(speed)
        self._plant_on = plant is not None
        self.state = "stopped"
        self.error: Exception | None = None
        self.late = 0  # how often the wall clock ran away
        self.log: deque[StepChange] = deque(maxlen=LOG)
        self._steps: list[int] = []
        self._last_steps: tuple | None = None  # their values after the last scan
        self.step_since: dict[str, int] = {}  # active step -> simulated time in us at which it began
        self._lock = plc.lock  # what a cell does to the Plc itself waits for the scan, too
        self._wake = threading.Event()
        self._actions: deque[Callable[[Plc], Any]] = deque()
        self._observers: list[Callable[[Session], Any]] = []
        self._thread: threading.Thread | None = None
        self._task: Any = None  # keeps the loop alive where there are no threads
        self._loop: object | None = None  # the loop that may go on; any other one ends at its next turn
        self._connections: dict[int, _Connection] = {}
        self._asked = False  # observers are to be called by the loop
        self._showing = False
        self._bind()
        self._ask_plant()
        self._initial = self._take()
        self.history = History(self._take, self._put)

    # -- the simulation -----------------------------------------------------------------------------------------

    def _bind(self) -> None:
        """Look up once what each scan needs."""
        plc = self.plc
        self._program, self._downloads = plc.program, plc.downloads
        self._generation = plc.memory.generation
        wiring = list(self.plant.wiring) if self.plant is not None else []
        self._signals = {name: point for name in wiring if (point := plc.analog_point(name)) is not None}
        self._analog_outputs = [name for name, point in self._signals.items() if point.face.startswith("output")]
        places = [(name, plc.memory.parse(name)[0]) for name in wiring if name not in self._signals]
        for _, device in places:
            plc.modules.check(device.area, range(device.number, device.number + 1))
        outputs = [(name, device.number) for name, device in places if device.area == "Y"]
        self._output_names = [name for name, _ in outputs]
        self._driven = itemgetter(*(number for _, number in outputs), 0) if outputs else lambda image: ()
        counted = getattr(self.plant, "counted", frozenset())  # outputs of which the plant gets the number of pulses, not the level
        self._counted = {name: plc.outputs.axes[number] for name, number in outputs if name in counted}
        self._sent = {name: axis.total for name, axis in self._counted.items()}
        self._last_driven: tuple | None = None
        self._last_sensors: dict[str, int] | None = None
        self._inputs = {name: device.number for name, device in places if device.area == "X"}
        self._registers = {name: plc.memory.parse(name) for name, device in places if device.area not in "XY"}
        steps = [device.number for device in plc.in_use(("S",))]
        if steps != self._steps:
            self._steps, self._last_steps = steps, None
        self._step_values = itemgetter(*steps, steps[0]) if steps else None
        area, self._fault_number = plc.model.flag("fault")
        self._fault_list = plc.memory.lists[area]
        self._fault = bool(self._fault_list[self._fault_number])

    def _ask_plant(self) -> None:
        """What the plant's sensors say before any time passes."""
        self._first_answers: dict[str, int] = {}
        if self.plant is None:
            return
        plc = self.plc
        outputs = dict(zip(self._output_names, map(int, self._driven(plc.driven)), strict=False)) | dict.fromkeys(self._counted, 0)
        outputs |= {name: self._signals[name].get() for name in self._analog_outputs}
        self._first_answers = dict(self.plant.step(0.0, outputs))
        self._answer_first()

    def _answer_first(self) -> None:
        """Put the first answers on the inputs. The plant has stood there all along: no input filter delays them."""
        self._enter(self._first_answers, self.plc.clock[0])
        for number in self._inputs.values():
            self.plc.inputs.waiting.pop(number, None)

    def _enter(self, sensors: dict[str, int], now: int, last: dict[str, int] | None = None) -> None:
        """Put what the plant says on the inputs, and into the registers that it writes; where it said the same the last time, that stands."""
        plc, said = self.plc, self.sensors.pass_on(sensors, now)
        last = last if last and said is sensors else {}
        for name, level in said.items():
            if last.get(name) == level:
                continue
            if name in self._inputs:
                plc.inputs.set(self._inputs[name], level, now)
            elif name in self._signals:
                self._signals[name].put(level)
            else:  # a value that comes over a line, as from a scale or a touch screen
                plc.memory.set(*self._registers[name], level)

    def _scan(self, traced: bool = False) -> None:
        """The PLC scans once, then the plant moves under its outputs for the time of that scan."""
        plc = self.plc
        if self._tip is not None:
            self._fork()
        if self.trace_frames and plc.tracing is not traced:
            plc.tracing = traced
        if plc.program is not self._program or plc.memory.generation != self._generation:
            self._look()
        if self._connections:
            self._listen()
        self.history.tick(plc.scans)
        self._step()
        for connection in self._connections.values():
            connection.line.write(connection.outlet.outbox)
            connection.outlet.outbox.clear()

    def connect(self, port: int, where: str) -> None:
        """Connect a serial port of the PLC to a real line, in real time: a serial device's path or "tcp://host:port".

        It stays connected until `disconnect` or the end of the session. Raises EcsimError for a line that cannot be opened.
        """
        if not isinstance(port, int) or not 0 <= port < len(self.plc.ports):
            raise EcsimError(f"there is no port {port!r}; the PLC has {', '.join(str(each.number) for each in self.plc.ports)}")
        if port in self._connections:
            raise EcsimError(f"port {port} is connected to {self._connections[port].line.where}; disconnect({port}) first")
        line = OutsideLine(where, self.plc.ports[port].framing)
        with self._lock:
            outlet = Outlet(self.plc.ports[port].framing)
            self.plc.ports[port].connect(outlet)
            self._connections[port] = _Connection(outlet, line)

    def disconnect(self, port: int) -> None:
        """Take a port off its real line, and close the line."""
        with self._lock:
            connection = self._connections.pop(port, None)
            if connection is None:
                raise EcsimError(f"port {port!r} is connected to no line")
            connection.outlet.wire.leave(connection.outlet)
            connection.line.close()

    def _listen(self) -> None:
        """Whole messages of the real lines go to the ports; a step back repeats them as an action."""
        now = time.perf_counter()
        for number, connection in self._connections.items():
            octets = connection.line.read()
            if octets:
                connection.heard += octets
                connection.since = now
            elif connection.heard and now - connection.since >= QUIET_S:
                message = bytes(connection.heard)
                connection.heard.clear()

                def enter(number=number, outlet=connection.outlet, message=message) -> None:
                    outlet.enter(message, self.plc.ports[number].wire_time())
                    self.plc.ports[number].stirred()

                self.history.note(self.plc.scans, enter)
                enter()

    def _look(self) -> None:
        """Find things again after another program was loaded (there is no way back across that) or a device was forced."""
        if self.plc.downloads != self._downloads:
            self.history.clear()
            self.step_since.clear()
            self.marks.clear()
            self._tip = None
            self._bind()
            self.breakpoints.follow()
        else:
            self._bind()

    def _step(self) -> None:
        plc = self.plc
        before = plc.clock[0]
        plc.turn()
        if self._plant_on:
            now = plc.clock[0]
            driven = self._driven(plc.driven)
            if driven != self._last_driven:
                self._last_driven = driven
                self._outputs = dict(zip(self._output_names, map(int, driven), strict=False))
            if self._counted:
                self._outputs = self._outputs | self._new_pulses()
            if self._analog_outputs:
                self._outputs = self._outputs | {name: self._signals[name].get() for name in self._analog_outputs}
            sensors = self.plant.step((now - before) / 1e6, self._outputs)
            if sensors != self._last_sensors:
                last, self._last_sensors = self._last_sensors, sensors
                self._enter(sensors, now, last)
        self._look_at_steps()
        if self._fault_list[self._fault_number] is not self._fault:
            self._note_fault()
        if self.recording is not None:
            self.recording.sample()
        for hook in self._hooks:
            hook()
        if self._armed:
            self._check_breakpoints()

    def _look_at_steps(self) -> None:
        if self._step_values is not None:
            steps = self._step_values(self.plc.memory.lists["S"])
            if steps != self._last_steps:
                self._note_steps(steps)

    def _note_fault(self) -> None:
        """An execution error has come, or gone."""
        self._fault = bool(self._fault_list[self._fault_number])
        errors = self.plc.errors
        if self._fault and errors:
            self._mark("fault", f"Error {errors[0].code}, {errors[0].meaning}")

    def _mark(self, kind: str, words: str) -> None:
        mark = Mark(self.plc.scans, kind, words)
        if mark not in self.marks:  # it is met again on the way through the past
            self.marks.append(mark)

    def _arm(self) -> None:
        self._armed = self.breakpoints.armed

    def _check_breakpoints(self) -> None:
        for each in self._armed:
            if each.rises() and self.hit is None and self._goal is None:
                each.hits += 1
                self.hit = each
                self._mark("breakpoint", each.text)
                if self.state == "running":
                    self.state = "paused"

    def _new_pulses(self) -> dict[str, int]:
        """The pulses of each counted output since the last look."""
        sent, self._sent = self._sent, {name: axis.total for name, axis in self._counted.items()}
        return {name: total - sent[name] for name, total in self._sent.items()}

    def _note_steps(self, values: tuple) -> None:
        """Write down which steps began and ended."""
        before = self._last_steps or (False,) * len(values)
        self._last_steps = values
        now, scan = self.plc.clock[0], self.plc.scans
        for number, old, new in zip(self._steps, before, values, strict=False):
            if bool(old) != bool(new):
                self.log.append(StepChange(now, scan, f"S{number}", bool(new)))
                if new:
                    self.step_since[f"S{number}"] = now
                else:
                    self.step_since.pop(f"S{number}", None)

    def _take(self) -> tuple:
        plant = plant_state(self.plant), self.sensors.state()
        return self.plc.snapshot(), plant, self._plant_on, dict(self.step_since), list(self.log), self.plc.transitions_held

    def _put(self, frame: tuple) -> None:
        snapshot, plant, on, since, log, held = frame
        self.plc.restore(snapshot)
        self._bind()
        restore_plant(self.plant, plant[0])
        self.sensors.restore(plant[1])
        self._plant_on, self.plc.transitions_held = on, held
        self.sensors.connected = on
        self._last_driven = self._last_sensors = None
        self.step_since = dict(since)
        self.log = deque(log, maxlen=LOG)
        self._last_steps = None if not self._steps else self._step_values(self.plc.memory.lists["S"])
        if self.recording is not None:
            self.recording.forget(self.plc.clock[0])
        self.breakpoints.look()

    # -- the past -----------------------------------------------------------------------------------------------

    @property
    def tip(self) -> Tip:
        """The newest moment of the run; while the past is shown it lies ahead."""
        return self._tip or Tip(self.plc.scans, self.plc.clock[0], tuple(self.log))

    @property
    def in_past(self) -> bool:
        """Whether an earlier moment than the newest is shown."""
        return self._tip is not None

    def seek(self, scan: int) -> bool:
        """Pause, and show the moment before scan number `scan`, between the first one remembered and the newest; false beyond these.

        What came later stays until something happens: a scan, a write, a run from here on take another way.
        """
        self.pause()
        with self._lock:
            self._drain()
            self._look()
            tip = self.tip
            done = scan <= tip.scan and self._travel(scan)
            if done:
                self._tip = tip if self.plc.scans < tip.scan else None
                self.hit = None
        self._show()
        return done

    def _travel(self, scan: int) -> bool:
        """Go to the moment before a scan; the scan that leads there is traced where frames are."""
        self._goal = scan
        try:
            return self.history.go(scan, self._again)
        finally:
            self._goal = None
            for connection in self._connections.values():
                connection.outlet.outbox.clear()  # what is repeated has been said

    def _again(self) -> None:
        if self.trace_frames:
            self.plc.tracing = self.plc.scans + 1 == self._goal
        self._step()

    def _fork(self) -> None:
        """Something happens in the past: from here on it is the present."""
        self._tip = None
        self.history.fork(self.plc.scans)
        while self.marks and self.marks[-1].scan > self.plc.scans:
            self.marks.pop()

    def _retrace(self) -> None:
        """Do the last scan again, traced, where the run has ended with one that was not."""
        if self.trace_frames and not self.plc.tracing and self.history.first is not None and self.history.first < self.plc.scans:
            self._look()
            if self.history.first is not None:
                self._travel(self.plc.scans)

    # -- control ------------------------------------------------------------------------------------------------

    def start(self) -> "Session":
        """Begin to run in a thread of its own (where there are no threads, as a task of the event loop); a session of the same name ends first."""
        with _registry:
            former, _sessions[self.name] = _sessions.get(self.name), self
        if former is not None and former is not self:
            former._end()
        with self._lock:
            if self._loop is not None:
                return self
            self.error, self.state = None, "running"
            loop = self._loop = object()
        thread = threading.Thread(target=self._drive, args=(loop,), name=f"ecsim {self.name}", daemon=True)
        self._thread = thread
        try:
            thread.start()
        except RuntimeError:  # Pyodide has no threads
            import asyncio

            self._thread = None
            self._task = asyncio.ensure_future(self._drive_task(loop))
        return self

    def stop(self) -> None:
        """End the session; raises what went wrong inside, if anything did."""
        self._end()
        with _registry:
            if _sessions.get(self.name) is self:
                del _sessions[self.name]
        if self.error is not None:
            raise self.error

    def _end(self) -> None:
        self._loop = None
        self._wake.set()
        if self.state != "failed":
            self.state = "stopped"
        thread, self._thread = self._thread, None
        if thread is not None and thread is not threading.current_thread():
            thread.join(timeout=5)
        for port in list(self._connections):
            self.disconnect(port)
        self._show()

    def run(self) -> None:
        """Go on after a pause; a PLC in STOP is put into RUN."""
        if self.state == "failed":
            raise EcsimError(f"the session {self.name!r} has failed: {self.error}; reset() begins anew")
        self._do(lambda plc: plc.run())
        self.hit = None
        self.start()
        self.state = "running"
        self._wake.set()

    def pause(self) -> None:
        """Hold simulated time."""
        if self.state == "running":
            with self._lock:
                self.state = "paused"
                self._retrace()
            self._wake.set()
            self._show()

    def scan(self, count: int = 1) -> None:
        """Pause, and do so many scans, fewer when a breakpoint is met."""
        self.pause()
        with self._lock:
            self._drain()
            self.hit = None
            for number in range(count):
                self._scan(number == count - 1)
                if self.hit is not None:
                    self._retrace()
                    break
        self._show()

    def until(self, text: str, timeout_ms: float = 10_000) -> float:
        """Pause, and scan with the plant until a condition holds ("Y0", "D0 > 100 and not X1"); the simulated ms that it took.

        Raises EcsimError for what is no condition, and when it does not come true in time or a breakpoint is met before.
        """
        test = condition(self.plc, text)
        within("timeout_ms", timeout_ms, 0, 1e12)
        self.pause()
        with self._lock:
            self._drain()
            self.hit = None
            began = self.plc.clock[0]
            while not (done := test()) and self.hit is None and self.plc.clock[0] - began < timeout_ms * 1000:
                self._scan()
            self._retrace()
            took_ms = (self.plc.clock[0] - began) / 1000
        self._show()
        if done:
            return took_ms
        if self.hit is not None:
            raise EcsimError(f"{text} has not come true: the breakpoint {self.hit.text} stopped the run after {took_ms:g} ms")
        hint = "" if self.plc.running else "; the PLC is in STOP, run() starts it"
        raise EcsimError(f"{text} did not come true within {timeout_ms:g} ms of simulated time{hint}")

    def next_step(self, limit_ms: float = 600_000) -> str | None:
        """Pause, and scan until a step begins or ends: the step that began, or else the one that ended.

        None when none does within the limit, when the program has no steps and when the PLC is in STOP.
        """
        self.pause()
        changes: list[StepChange] = []
        with self._lock:
            self._drain()
            self.hit = None
            end = self.plc.clock[0] + limit_ms * 1000
            while not changes and self.hit is None and self.plc.clock[0] < end:
                self._scan()
                changes = list(takewhile(lambda change: change.scan == self.plc.scans, reversed(self.log)))
                if not (self._steps and self.plc.running):
                    break
            self._retrace()
        self._show()
        return max(changes, key=lambda change: change.active).step if changes else None

    def back(self, scans: int = 1) -> bool:
        """Pause, and go back by so many scans; false when that is further than is remembered. See `seek`."""
        if scans < 1:
            raise EcsimError(f"back by {scans!r} scans; give a number from 1 on")
        self.pause()
        return self.seek(self.plc.scans - scans)

    def reset(self) -> None:
        """Time, inputs and plant as they were when the session was made; the PLC is switched off and on, and begins in RUN."""
        with self._lock:
            self._actions.clear()
            self.history.clear()
            self.marks.clear()
            self._tip = self.hit = None
            self.refused = ""
            self._bind()
            snapshot, plant, on, *_ = self._initial
            program = self.plc.program
            if not self.plc.has_been(snapshot["program"]):
                snapshot = self.plc.snapshot()  # the time of another program does not come back
            self._put((snapshot, plant, on, {}, [], False))
            if on:
                self._answer_first()
            if self.plc.program is not program:
                self.plc.return_to(program)  # what was changed in RUN stays changed
            if self.recording is not None:
                self.recording.forget(-1)
            self.plc.power_cycle()
            if self.state == "failed":
                self.state, self.error = "stopped", None
        self._show()

    @property
    def speed(self) -> float | None:
        """Simulated seconds for each real one; None is as fast as it goes."""
        return self._speed

    @speed.setter
    def speed(self, value: float | None) -> None:
        self._speed = _fitting_speed(value)
        self._wake.set()

    @property
    def plant_on(self) -> bool:
        """Whether the plant drives the inputs; switched off, they are all in the hand of the user."""
        return self._plant_on

    @plant_on.setter
    def plant_on(self, on: bool) -> None:
        if self.plant is not None:
            self._do(lambda plc: self._switch_plant(bool(on)))

    def _switch_plant(self, on: bool) -> None:
        self._plant_on = on
        self._last_sensors = None
        self.sensors.connected = on
        self.sensors.renew()  # a sensor that was overridden by hand is driven again

    @property
    def faults(self) -> list[str]:
        """The faults of machine and sensors that are switched in, as `fail` takes them."""
        return self.sensors.active

    def fail(self, fault: str) -> None:
        """Switch a fault in before the next scan: one of the machine's own ("jammed"), or of a sensor, by device or name.

        "X1 stuck 0", "X1 inverted", "X1 delayed 0.5" (seconds), "X1 bounces 30" (ms; a second number is the seed). A sensor has one
        fault at a time. Raises EcsimError for one that there is not.
        """
        self.sensors.read(fault)
        self.post(lambda plc: self.sensors.fail(fault))

    def mend(self, fault: str = ALL) -> None:
        """Switch out before the next scan a fault of the machine's own, that of a sensor ("X1", "InLift"), or all of them."""
        self.post(lambda plc: self.sensors.mend(fault))

    # -- actions and observers ------------------------------------------------------------------------------------

    def post(self, action: Callable[[Plc], Any]) -> None:
        """Have `action(plc)` done before the next scan; it is remembered, so that a step back repeats it.

        What the Plc refuses (EcsimError) stands in `refused`, and the session goes on; while nothing runs it is raised here too.
        """
        self._actions.append(action)
        self._wake.set()
        if self.state != "running":
            with self._lock:
                self.refused = ""
                self._drain()
                refused = self.refused
            self._show()
            if refused:
                raise EcsimError(refused)

    def set(self, device: str, value: Any) -> None:
        """Write a device, or put a level on an input, before the next scan. A bad name or value raises here."""
        self.plc._check_write(device, value)
        self.post(lambda plc: plc.__setitem__(device, value))

    def receive(self, name: str, first: int, values: list) -> None:
        """Write devices as `Memory.receive` does, between two scans; a step back repeats it. It is for communication partners, who hold the Plc's lock."""
        receive = self.plc.memory.receive
        if self._tip is not None:
            self._fork()
        self.history.overwrite(self.plc.scans, (name, first, len(values)), lambda: receive(name, first, values))
        receive(name, first, values)
        if self.state != "running":
            self._asked = True  # observers see it soon, however many writes come

    def edit(self, program: Any) -> None:
        """Change the program in RUN before the next scan, as `Plc.edit` does; what that would refuse is refused here, and a step back stays possible."""
        with self._lock:
            self.plc.check_edit(program)
        self.post(lambda plc: plc.edit(program))

    def _do(self, action: Callable[[Plc], Any]) -> None:
        with self._lock:
            self._drain()
            self._note(lambda: action(self.plc))
            action(self.plc)
        self._show()

    def _note(self, action: Callable[[], Any]) -> None:
        """An action is remembered; in the past it begins another way."""
        if self._tip is not None:
            self._fork()
        self.history.note(self.plc.scans, action)

    def _drain(self) -> None:
        while self._actions:
            action = self._actions.popleft()
            self._note(lambda action=action: self._attempt(action))
            self._attempt(action)

    def _attempt(self, action: Callable[[Plc], Any]) -> None:
        """Do an action; one that is refused is told, and nothing fails."""
        try:
            action(self.plc)
            self.refused = ""
        except EcsimError as error:
            self.refused = str(error)
        self._look_at_steps()

    # -- the chart by hand ----------------------------------------------------------------------------------------

    @property
    def transitions_held(self) -> bool:
        """Whether the steps stay as they are though conditions are met: a transition that would fire does nothing."""
        return self.plc.transitions_held

    @transitions_held.setter
    def transitions_held(self, on: bool) -> None:
        self._do(lambda plc: setattr(plc, "transitions_held", bool(on)))

    def set_step(self, step: str, on: bool = True) -> None:
        """Begin a step, or end it, before the next scan, whatever led there; raises EcsimError for what is no step of the program."""
        device, _ = self.plc.memory.parse(step, self.plc._names)
        if device.area != "S":
            raise EcsimError(f"{step} is no step; steps are S devices")
        self.set(str(device), int(bool(on)))

    def transitions(self, step: str) -> list[tuple[Step, Transition]]:
        """The transitions that lead out of a step, in the program's order, each with its STL: of a join it takes several steps."""
        if self._flows[0] is not self.plc.program:
            steps = [each for part in parts(self.plc.program.main) if isinstance(part, Flow) for each in part.steps]
            self._flows = self.plc.program, steps
        return [(each, way) for each in self._flows[1] if step in map(str, each.devices) for way in each.transitions]

    def fire(self, step: str, to: str | None = None) -> None:
        """Take a transition out of an active step by hand before the next scan, whether its condition holds or not.

        `to` is a step that it leads to, needed where there is a choice. Raises EcsimError where none can be taken.
        """
        step = str(self.plc.memory.parse(step, self.plc._names)[0])
        to = None if to is None else str(self.plc.memory.parse(to, self.plc._names)[0])
        ways = self.transitions(step)
        if not ways:
            raise EcsimError(f"no transition leads out of {step}")
        chosen = [(each, way) for each, way in ways if to is None or to in map(str, way.steps)]
        targets = ", ".join(" and ".join(map(str, way.steps)) or "its end" for _, way in ways)
        if not chosen:
            raise EcsimError(f"no transition leads from {step} to {to}; it leads to {targets}")
        if len(chosen) > 1:
            raise EcsimError(f"{len(chosen)} transitions lead out of {step}, to {targets}; say which with to=")
        each, way = chosen[0]
        self.post(lambda plc: self._fire(each, way))

    def _fire(self, step: Step, way: Transition) -> None:
        missing = [str(device) for device in step.devices if not self.plc[str(device)]]
        if missing:
            raise EcsimError(f"{' and '.join(missing)} {'is' if len(missing) == 1 else 'are'} not active, so the transition cannot fire")
        self.plc.set({str(device): 0 for device in step.devices} | {str(target): 1 for target in way.steps})

    def each_scan(self, callback: Callable[[], Any]) -> Callable[[], None]:
        """Have `callback()` called after every scan, in the thread that scans and between two scans; returns what ends it.

        It must be quick, and look only. On the way through the past the scans that are done again call it too.
        """
        self._hooks.append(callback)

        def end() -> None:
            with contextlib.suppress(ValueError):
                self._hooks.remove(callback)

        return end

    def observe(self, callback: "Callable[[Session], Any]") -> Callable[[], None]:
        """Have `callback(session)` called after changes; returns what ends it.

        While scans run that is at most 30 times a second; it happens in the session's thread, or in the caller's where none runs.
        A callback may use every method of the session; it is not called again for what it does itself.
        """
        self._observers.append(callback)

        def end() -> None:
            with contextlib.suppress(ValueError):
                self._observers.remove(callback)

        return end

    def _show(self) -> None:
        """Call the observers, or have the session's thread do it."""
        thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            self._asked = True
            self._wake.set()
        elif not self._showing:
            self._asked, self._showing = False, True
            try:
                for callback in list(self._observers):
                    callback(self)
            finally:
                self._showing = False

    @contextlib.contextmanager
    def held(self) -> Iterator[Plc]:
        """The Plc between two scans, for as long as the `with` lasts."""
        with self._lock:
            yield self.plc

    # -- the loop -----------------------------------------------------------------------------------------------

    def _drive(self, loop: object) -> None:
        for wait in self._turns(loop):
            if wait:
                self._wake.wait(wait)
                self._wake.clear()

    async def _drive_task(self, loop: object) -> None:
        import asyncio

        for wait in self._turns(loop):
            await asyncio.sleep(wait)

    def _turns(self, loop: object) -> Iterator[float]:
        """One turn a frame: actions, the scans that are due, observers; yields how long to wait."""
        try:
            deadline, shown = time.perf_counter(), 0.0
            debt = 0.0  # simulated us that are due
            while self._loop is loop:
                now = time.perf_counter()
                running = self.state == "running"
                if running:
                    with self._lock:
                        self._drain()
                        debt = self._catch_up(loop, now, deadline, debt, shown + FRAME_S)
                        if self.hit is not None:
                            self._retrace()
                            self._asked = True
                else:
                    debt = 0.0
                deadline = now
                fresh = self.plc.tracing or not self.trace_frames  # else the next scan is the one to be shown
                if self._asked or (running and fresh and time.perf_counter() - shown >= FRAME_S):
                    shown = time.perf_counter()
                    self._show()
                yield self._pause_s(debt) if running else 0.25
            if self._loop is None:  # an observer may have ended it
                self._show()
        except Exception as error:
            if self._loop is loop:
                self._loop = None
                self.error, self.state = error, "failed"
                with contextlib.suppress(Exception):
                    self._show()

    def _catch_up(self, loop: object, now: float, deadline: float, debt: float, frame_due: float) -> float:
        """Do the scans that are due; what cannot be made up for is given up. The last one before a frame is due is traced."""
        speed = self._speed
        if speed is None:
            while time.perf_counter() - now < SLICE_S and self.state == "running" and self._loop is loop:
                self._scan()
            if self.state == "running" and self._loop is loop and time.perf_counter() >= frame_due:
                self._scan(True)
            return 0.0
        debt += (now - deadline) * 1e6 * speed
        if debt > LATE_S * 1e6 * speed:
            self.late += 1
            debt = min(debt, LATE_S * 1e6 * speed)
        while debt >= (period_us := self.plc.period_us):
            debt -= period_us
            last = debt < period_us
            self._scan(last and now + (period_us - debt) / 1e6 / speed >= frame_due)
            if self.state != "running" or self._loop is not loop:
                break
            if time.perf_counter() - now > LATE_S:
                self.late += 1
                return 0.0
        return debt

    def _pause_s(self, debt: float) -> float:
        if self._speed is None:
            return 0.0005
        due = (self.plc.period_us - debt) / 1e6 / self._speed
        return min(max(due, 0.001), FRAME_S)

    def __repr__(self) -> str:
        return f"<Session {self.name!r} {self.state}>"


def _fitting_speed(speed: float | None) -> float | None:
    if speed is not None and not (isinstance(speed, (int, float)) and 0 < speed <= 1_000_000):
        raise EcsimError(f"the speed is {speed!r}; it is a factor above 0, or None for as fast as it goes")
    return speed


def plant_state(plant: Any) -> Any:
    """What a plant remembers: its own `state()`, or a copy of its attributes."""
    if plant is None:
        return None
    return plant.state() if callable(getattr(plant, "state", None)) else copy.deepcopy(vars(plant))


def restore_plant(plant: Any, state: Any) -> None:
    """Give a plant back what `plant_state` got from it."""
    if plant is None:
        return
    if callable(getattr(plant, "restore", None)):
        plant.restore(state)
    else:
        vars(plant).clear()
        vars(plant).update(copy.deepcopy(state))
