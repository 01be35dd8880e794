"""Emerson EC10 and EC20 (chapters 1 to 3, appendices 1 and 2)."""

from dataclasses import replace

from ..devices import Syntax
from . import ec_fast, ec_modbus, ec_modules, ec_serial
from .model import Area, Model


def _areas(x: int, y: int, m: int, s: int) -> dict[str, Area]:
    rows = (
        ("X", x, "bit"), ("Y", y, "bit"), ("M", m, "bit"), ("S", s, "bit"), ("LM", 64, "bit"), ("SM", 256, "bit"),
        ("T", 256, "timer"), ("C", 256, "counter"),
        ("D", 8000, "word"), ("SD", 256, "word"), ("V", 64, "word"), ("Z", 16, "word"),
    )  # fmt: skip
    return {name: Area(name, count, kind) for name, count, kind in rows}


def _numbers(*runs: int | tuple[int, int]) -> frozenset[int]:
    """Single numbers and inclusive runs as one set."""
    return frozenset(n for run in runs for n in (range(run[0], run[1] + 1) if isinstance(run, tuple) else (run,)))


def _others(writable: frozenset[int]) -> frozenset[int]:
    """The special devices that only the system writes: all that the appendices do not tell to be written, the reserved ones too."""
    return frozenset(range(256)) - writable


def _without(devices: dict[str, int], *meanings: str) -> dict[str, int]:
    """Special devices by meaning but for those that a model does not have."""
    return {meaning: number for meaning, number in devices.items() if meaning not in meanings}


# Appendices 1 and 2: what programs and tools may write.
_RELAYS = _numbers((40, 47), (65, 68), 80, 81, (90, 97), (110, 113), (120, 123), 135, 136, (180, 182), 185, (200, 255))
_RELAYS_EC10 = _RELAYS | _numbers((48, 56), 63, 64, 85, (172, 175), 178, 186)
_REGISTERS = _numbers((50, 55), (66, 68), (80, 89), (111, 114), (121, 124), 130, (135, 137), (180, 184))
_REGISTERS_EC10 = _REGISTERS | _numbers((131, 133), 138, 173, 175, 178)
_BITS = frozenset({"X", "Y", "M", "S", "LM", "SM"})

EC20 = Model(
    name="EC20",
    family="EC",
    areas=_areas(x=0o400, y=0o400, m=2000, s=992),
    syntax=Syntax(areas=_BITS | {"T", "C", "D", "SD", "V", "Z"}, bit_areas=_BITS),
    timer_bases=((0, 209, 100_000), (210, 251, 10_000), (252, 255, 1_000)),
    fast_timers=(252, 255),
    wide_counters=200,
    initial_steps=20,
    relays={
        "running": 0, "first scan": 1, "power up": 2, "system error": 3, "constant scan": 8,
        "clock 10 ms": 10, "clock 100 ms": 11, "clock 1 s": 12, "clock 1 min": 13, "clock 1 h": 14, "scan toggle": 15,
        "fault": 20, "fault range": 21, "fault operand": 22, "zero": 180, "carry": 181, "borrow": 182, "bytewise": 186,
        "counter direction": 0,  # SM(n) for C(n): appendix 1, section 17
        "battery low": 4, "power lost": 5, "24 V lost": 6, "no battery": 7, "run input": 9, "clock error": 193,
        **ec_fast.RELAYS, **ec_serial.RELAYS, **ec_modules.RELAYS,
    },
    registers={
        "type": 0, "version": 1, "capacity": 2, "system error": 3, "faults": 20,
        "scan time": 30, "least scan time": 31, "greatest scan time": 32, "constant scan": 33, "watchdog": 34, "input filter": 35,
        "battery": 4, "power loss delay": 5, "run input": 9, "faulty module": 25, "clock": 100,
        **ec_fast.REGISTERS, **ec_serial.REGISTERS, **ec_modules.REGISTERS,
    },
    read_only_relays=_others(_RELAYS),
    read_only_registers=_others(_REGISTERS),
    limits={
        "steps": 12_000, "MC nesting": 7, "FOR nesting": 8, "CALL nesting": 6, "subroutines": 64, "joined steps": 16,
        "flows": 20, "bit variables": 16, "word variables": 16, "global variables": 500, "stack": 8, "waveforms": 100, "potentiometers": 2,
        **ec_fast.LIMITS, **ec_serial.LIMITS,
        "run inputs": 16, "power loss ms": 100, **ec_modules.LIMITS_EC20,
    },
    filter_inputs=0o20,
    filter_ms=10,
    filter_choices=tuple(range(61)),
    reff_ms=tuple(range(65)),
    instruction_ns=90,
    retained=("D", "M", "S", "T", "C"),
    type_code=20,
    initial_registers={25: 255, 26: 255, **ec_fast.INITIAL},
    retention_limits={"ranges": 2, "counters": 200},
    base_units=ec_modules.BASE_UNITS_EC20,
    module_kinds=ec_modules.MODULES_EC20,
    ports=ec_serial.PORTS_EC20,
    bauds=ec_serial.BAUDS,
    baud_codes=ec_serial.BAUD_CODES,
    mode_bits=ec_serial.MODE_BITS,
    modbus_stop_bits=ec_serial.STOP_BITS,
    buffers=ec_serial.BUFFERS,
    modbus=ec_modbus.RANGES,
    modbus_most=ec_modbus.MOST,
    **ec_fast.EC20,
)  # fmt: skip

EC10 = replace(
    EC20,
    name="EC10",
    areas=_areas(x=0o200, y=0o200, m=2048, s=1024),
    limits=EC20.limits | {"global variables": 140, "power loss ms": 0, "modules set up": 4, "clock hours": 100} | ec_modules.LIMITS_EC10,
    battery=False,
    filter_inputs=0o10,
    filter_ms=8,
    filter_choices=(0, 8, 16, 32, 64),
    reff_ms=(0, 8, 16, 32, 64),
    instruction_ns=300,
    retained=("D", "M", "S", "C"),
    read_only_relays=_others(_RELAYS_EC10),
    read_only_registers=_others(_REGISTERS_EC10),
    type_code=10,
    step_surcharge=("M", 1536),  # 5.1.1: a contact on M1536 to M2047 is one step longer
    retention_limits={"ranges": 1, "bits": 320, "words": 180},
    relays=_without(EC20.relays, "battery low", "no battery") | {"eeprom idle": 196} | ec_fast.RELAYS_EC10,
    registers=_without(EC20.registers, "battery", "power loss delay") | ec_modules.REGISTERS_EC10,
    initial_registers=EC20.initial_registers | ec_modules.INITIAL_EC10,
    base_units=ec_modules.BASE_UNITS_EC10,
    analog_base=ec_modules.ANALOG_BASE_EC10,
    module_kinds=ec_modules.MODULES_EC10,
    **ec_modules.ANALOG_EC10,
    ports=ec_serial.PORTS_EC10,
    shared=ec_serial.SHARED,
    modbus_modes=("rtu",),  # 10.4.1
    **ec_fast.EC10,
)  # fmt: skip
