"""What one model of PLC is, as data: its devices, relays, registers, limits and the spelling of its programs."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from ..devices import Bits, Device, Operand, Pointer, Syntax, number_text


@dataclass(frozen=True, slots=True)
class Area:
    """A kind of device: `count` of them, `kind` is bit, word, timer or counter."""

    name: str
    count: int
    kind: str
    hole: range = range(0)  # numbers that do not exist, between the others and the special ones

    @property
    def span(self) -> str:
        """The range in words: "X0 to X377"."""
        runs = ((0, self.hole.start), (self.hole.stop, self.count)) if self.hole else ((0, self.count),)
        return " and ".join(
            f"{self.name}{number_text(self.name, first)} to {self.name}{number_text(self.name, end - 1)}" for first, end in runs
        )

    def end(self, number: int) -> int:
        """The number behind the last device of the run that a device lies in."""
        return self.hole.start if self.hole and number < self.hole.start else self.count

    def has(self, number: int) -> bool:
        """Whether there is a device with this number."""
        return 0 <= number < self.count and number not in self.hole


@dataclass(frozen=True, slots=True)
class FastCounter:
    """A high-speed counter (8.1.1): "single", "up/down" or "phases", the inputs that it counts, its reset and start input."""

    mode: str
    inputs: tuple[int, ...]
    reset: int | None
    start: int | None
    khz: int  # the greatest frequency
    hardware: bool  # whether it can count in hardware, without a comparison

    @property
    def needs(self) -> tuple[int, ...]:
        """All inputs that it has for itself."""
        return (*self.inputs, *(n for n in (self.reset, self.start) if n is not None))


@dataclass(frozen=True, slots=True)
class PulseOutput:
    """The relays, registers and event of one pulse output, Y0 or one of those that follow: 32-bit registers by their first number.

    Where `pulses` and `position` are one register it counts up and down while positioning, and up otherwise.
    """

    stop: int  # ON: no pulses
    busy: int  # ON while pulses come
    pulses: int
    position: int
    event: int  # its pulses are complete
    clear: int | None = None  # the output that ZRN's clear signal goes to
    segment: int | None = None  # the register that tells the step of an envelope


@dataclass(frozen=True, slots=True)
class PortMap:
    """A serial port: what it can speak, the usual protocol first, and its special devices and interrupt events by meaning."""

    protocols: tuple[str, ...]
    relays: dict[str, int]
    registers: dict[str, int]
    events: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ModbusRange:
    """A run of Modbus addresses: `count` devices of the list `name` from number `first` on, `words` registers each (10.4.6)."""

    name: str
    address: int  # the protocol's, which counts from 0
    count: int
    functions: tuple[int, ...]
    first: int = 0
    words: int = 1


@dataclass(frozen=True, slots=True)
class AnalogMode:
    """What an analog channel measures or gives: V, mA or C (degrees) from `low` to `high`; `origin` is the number `zero`, `high` is `full`."""

    unit: str
    low: float
    origin: float
    high: float
    zero: int
    full: int


@dataclass(frozen=True, slots=True)
class AnalogPort:
    """An analog channel of the base unit: the relay that enables it, its register, its modes, the relay that takes the second, the samples."""

    enable: int
    register: int
    modes: tuple[AnalogMode, ...]
    second: int | None = None
    samples: int | None = None


@dataclass(frozen=True)
class ModuleKind:
    """A kind of special module by name: its code, its channels, the modes that they can have by number, and whether it gives signals out."""

    name: str
    code: int
    channels: int
    modes: dict[int, AnalogMode]
    output: bool = False


@dataclass(frozen=True, slots=True)
class SharedArea:
    """What the stations of an ECbus share in one refresh mode: D and M from a number on, evenly divided, and the first error flag."""

    stations: int
    first_word: int
    all_words: int
    first_bit: int
    all_bits: int
    first_flag: int

    @property
    def words(self) -> int:
        """The registers of one station."""
        return self.all_words // self.stations

    @property
    def bits(self) -> int:
        """The relays of one station."""
        return self.all_bits // self.stations


class By:
    """A name whose meaning depends on its first operand: (area, first number, last number, key of TABLE) and the usual key.

    The area of a group of bits is KnM and so on. Instead of a key another By looks at the next operand.
    """

    def __init__(self, usual: "str | By", *cases: "tuple[str, int, int, str | By]"):
        self.usual, self.cases = usual, cases

    def of(self, area: str, number: int) -> "str | By":
        """What the name stands for with this device."""
        return next((key for name, first, last, key in self.cases if name == area and first <= number <= last), self.usual)

    def behind(self, operands: Iterable[Operand | None]) -> tuple[str, ...]:
        """What the name may still stand for behind these operands, the usual first; None is an operand that nothing is known of."""
        choice: str | By = self
        for operand in operands:
            if not isinstance(choice, By):
                break
            if isinstance(operand, Pointer):
                choice = choice.of(operand.letter, operand.value)
            elif isinstance(operand, Device | Bits):
                choice = choice.of(f"Kn{operand.area}" if isinstance(operand, Bits) else operand.area, operand.number)
            else:
                choice = choice.usual
        return choice.keys if isinstance(choice, By) else (choice,)

    @property
    def keys(self) -> tuple[str, ...]:
        """All that it can stand for, the usual one first."""
        meant = (self.usual, *(key for *_, key in self.cases))
        return tuple(key for each in meant for key in (each.keys if isinstance(each, By) else (each,)))


@dataclass(frozen=True)
class Model:
    """One PLC model. Meanings ("carry") are keys, devices are values, so that another family is another table."""

    name: str
    family: str
    areas: dict[str, Area]
    syntax: Syntax
    timer_bases: tuple[tuple[int, int, int], ...]  # first, last, time unit in us
    fast_timers: tuple[int, int]  # counted by interrupt, not by the scan (3.1.6)
    wide_counters: int  # from this number on counters have 32 bits
    initial_steps: int
    relays: dict[str, int]  # meaning -> number of the special relay
    registers: dict[str, int]  # meaning -> number of the special register
    read_only_relays: frozenset[int]
    read_only_registers: frozenset[int]
    limits: dict[str, int]
    filter_inputs: int
    filter_ms: int
    filter_choices: tuple[int, ...]
    instruction_ns: int
    retained: tuple[str, ...]
    special_bits: str = "SM"
    special_words: str = "SD"
    first_special: int = 0  # where special devices share an area with others, they are those from this number on
    index_pairs: dict[str, str] = field(default_factory=dict)  # where the high word of a 32-bit number in an index register lies
    least_wide_digits: int = 5  # of a Kn string that holds a 32-bit number
    annunciators: range = range(0)  # steps that tell of faults of the machine
    clears_at_stop: bool = False  # what is not retained is cleared when RUN ends, not when it begins, unless "hold memory" is ON
    latched_relays: frozenset[int] = frozenset()  # special relays that keep what they are then
    scan_time_us: int = 1000  # the unit in which scan times are noted
    clock_order: tuple[int, ...] = (0, 1, 2, 3, 4, 5, 6)  # of year, month, day, hour, minute, second, weekday in their registers
    local_areas: tuple[str, ...] = ("LM", "V")  # bits and words of the unit that is executed: put aside by a call and an interrupt
    high_word_first: bool = True
    type_code: int = 0
    step_surcharge: tuple[str, int] | None = None  # contacts on this area from this number on are one step longer
    spelling: dict[str, str | By] = field(default_factory=dict)  # the family's name of each instruction -> TABLE's; empty: TABLE's own
    operand_ranges: dict[str, tuple[int, int]] = field(default_factory=dict)  # kind of operand -> its numbers, where they differ
    functions: dict[str, str] = field(default_factory=dict)  # name of an instruction -> where the family's manual has it
    foreign: dict[str, str] = field(default_factory=dict)  # a word of others -> what to write here
    sections: dict[str, str] = field(default_factory=dict)  # section of EC's manual -> the family's on the same; empty: the same manual
    levels: bool = False  # MC has a level: the end of one ends those inside it
    unconditional: frozenset[str] = frozenset()  # stand on the left bus, each a rung of its own, unless contacts are right before
    strict_steps: bool = False  # what may stand in the conditions of transitions where ways part or join is limited
    overlap: bool = False  # in the scan of a transition the step that is left stays ON beside the one that begins
    pulse_suffix: str = ""  # behind a mnemonic: executed only in the scan in which its flow rises
    fault_record: int = 5  # so many registers from "faults" on keep the codes of the last errors
    fault_codes: dict[int, int] = field(default_factory=dict)  # code of appendix 6 -> the family's own
    fault_groups: int | None = None  # where each hundred of codes has a relay and a register of its own: the one of code 0
    initial_registers: dict[int, int] = field(default_factory=dict)
    retention_limits: dict[str, int] = field(default_factory=dict)
    usual_retention: dict[str, tuple[tuple[int, int], ...]] = field(default_factory=dict)  # of areas whose ranges are not named
    fixed_retention: dict[str, tuple[tuple[int, int], ...]] = field(default_factory=dict)  # whatever it names
    unset: dict[str, str] = field(default_factory=dict)  # settings that the system block does not have -> what to do instead
    fast_counters: dict[int, FastCounter] = field(default_factory=dict)
    events: dict[int, int] = field(default_factory=dict)  # interrupt event -> the special relay that enables it (9.1)
    masked_events: frozenset[int] = frozenset()  # those whose relay forbids them instead
    edge_events: dict[int, tuple[int, bool]] = field(default_factory=dict)  # event -> its input, whether it is the rising edge
    timed_registers: dict[int, int] = field(default_factory=dict)  # event -> the register with its period in ms
    timed_ms: dict[int, int] = field(default_factory=dict)  # event -> its period, where that is fixed
    power_loss_event: int | None = None
    captures: int = 8  # so many inputs from X0 on have a relay that catches their pulses
    captures_when_enabled: bool = False  # they do so only after EI
    least_ramp_ms: int = 0  # of PLSR
    pulse_outputs: tuple[PulseOutput, ...] = ()
    battery: bool = True  # whether a battery keeps the retained devices (2.1.10)
    reff_ms: tuple[int, ...] = (0,)  # what REFF may set the input filter to
    modbus: tuple[ModbusRange, ...] = ()
    modbus_most: dict[int, int] = field(default_factory=dict)  # function -> the most devices or registers of one request
    modbus_modes: tuple[str, ...] = ("rtu", "ascii")
    modbus_stop_bits: dict[str, tuple[int, ...]] = field(default_factory=dict)  # parity -> what goes with it; one that is not named: 1 or 2
    ports: tuple[PortMap, ...] = ()
    base_units: tuple[tuple[int, int], ...] = ()  # inputs and outputs of the units to choose from
    module_kinds: dict[str, ModuleKind] = field(default_factory=dict)
    analog_inputs: tuple[AnalogPort, ...] = ()
    analog_outputs: tuple[AnalogPort, ...] = ()
    analog_base: tuple[int, int] | None = None  # the base unit that has them
    bauds: dict[str, tuple[int, ...]] = field(default_factory=dict)  # protocol -> its baud rates
    shared: dict[int, SharedArea] = field(default_factory=dict)  # refresh mode of ECbus -> what is shared
    buffers: dict[str, tuple[str, int, int]] = field(default_factory=dict)  # meaning -> area, first and count of what the system uses
    baud_codes: dict[int, int] = field(default_factory=dict)  # baud rate -> what the mode word of a port says for it
    mode_bits: dict[str, int] = field(default_factory=dict)  # what else it says -> its bit; "baud" is the lowest of the code
    protocol_codes: dict[int, tuple[str, str]] = field(default_factory=dict)  # code in a port's register -> protocol, Modbus mode

    def spelled(self, key: str) -> list[str]:
        """The names that this model has for an instruction of TABLE."""
        return [name for name, meant in self.spelling.items() if key in (meant.keys if isinstance(meant, By) else (meant,))]

    def section(self, section: str) -> str:
        """Where this family's manual has what EC's has in a section; "" where it has nothing."""
        if not self.sections or not section[:1].isdigit() or section in self.functions.values() or section in self.sections.values():
            return section
        found = max((known for known in self.sections if section == known or section.startswith(f"{known}.")), key=len, default="")
        return self.sections.get(found, "")

    def fault_code(self, code: int) -> int:
        """How this family numbers an error of appendix 6."""
        return self.fault_codes.get(code, code)

    def ordinary(self, area: str) -> int:
        """How many devices of an area are not special, from 0 on."""
        special = self.special(area)
        return min(self.areas[area].end(0), special.start or self.areas[area].count)

    def timer_base_us(self, number: int) -> int:
        """The time unit of a timer in microseconds."""
        return next(base for first, last, base in self.timer_bases if first <= number <= last)

    def special(self, area: str) -> range:
        """The numbers of an area's special devices; none in most areas."""
        return range(self.first_special, self.areas[area].count) if area in (self.special_bits, self.special_words) else range(0)

    def read_only(self, area: str) -> frozenset[int]:
        """The numbers of an area's devices that only the system writes (3.1.9, 3.1.10)."""
        return {self.special_bits: self.read_only_relays, self.special_words: self.read_only_registers}.get(area, frozenset())

    def flag(self, meaning: str) -> tuple[str, int]:
        """Area and number of a special relay by meaning."""
        return self.special_bits, self.relays[meaning]
