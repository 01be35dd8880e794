"""Inovance H1U and H2U, compatible with Mitsubishi's FX. What is not in their manual is a row in docs/decisions.md."""

import re
from dataclasses import replace

from ..devices import Constant, OperandError, Syntax
from . import ec_modules, fx_fast, fx_pulses, fx_serial, fx_spelling
from .model import Area, Model

_CONSTANT = re.compile(
    r"K(?P<decimal>[+-]?\d+)|H(?P<hex>[0-9A-F]+)|E(?P<real>[+-]?(?:\d+\.?\d*|\.\d+))(?:E?(?P<exponent>[+-]\d+|(?<=E)\d+))?", re.IGNORECASE
)
LONGEST = 24  # characters of a constant


def fx_constant(text: str) -> Constant | None:
    """A constant with its letter: K10, K-5, H1F, E3.14, E1.5+3 for 1500; None when `text` is none."""
    match = _CONSTANT.fullmatch(text)
    if match is None:
        return None
    if len(text) > LONGEST:
        raise OperandError(f"the constant {text[:12]}... is too long", "at most 32 bits fit")
    if match["decimal"]:
        return Constant(int(match["decimal"]), text)
    if match["hex"]:
        return Constant(int(match["hex"], 16), text, unsigned=True)
    return Constant(float(f"{match['real']}e{match['exponent'] or 0}"), text)


def _areas(m: int) -> dict[str, Area]:
    """Special M and D stand behind the others, from 8000 on; no M lies between."""
    rows = (
        Area("X", 0o400, "bit"), Area("Y", 0o400, "bit"), Area("M", 8256, "bit", hole=range(m, 8000)), Area("S", 1000, "bit"),
        Area("T", 256, "timer"), Area("C", 256, "counter"), Area("D", 8256, "word"), Area("V", 8, "word"), Area("Z", 8, "word"),
    )  # fmt: skip
    return {area.name: area for area in rows}


_BITS = frozenset("XYMS")
_RELAYS = {
    "running": 8000, "not running": 8001, "first scan": 8002, "not first scan": 8003, "error": 8004, "battery low": 8005,
    "clock 10 ms": 8011, "clock 100 ms": 8012, "clock 1 s": 8013, "clock 1 min": 8014,
    "zero": 8020, "borrow": 8021, "carry": 8022, "backwards": 8024, "hold": 8026, "sixteen": 8027, "complete": 8029,
    "battery lamp off": 8030, "hold memory": 8033, "outputs off": 8034, "constant scan": 8039,
    "hold transitions": 8040, "transfer start": 8041, "start pulse": 8042, "outputs kept": 8045, "hexadecimal": 8167,
    "step active": 8046, "monitor steps": 8047, "annunciator": 8048, "monitor annunciators": 8049,
    "fault": 8067, "fault latch": 8068, "exchange": 8160, "bytewise": 8161, "unconverted": 8168,
    "counter direction": 8000,  # M(8000 + n) for C(n)
    **fx_fast.RELAYS, **fx_pulses.RELAYS,
}  # fmt: skip
_REGISTERS = {
    "watchdog": 8000, "capacity": 8002, "scan time": 8010, "least scan time": 8011, "greatest scan time": 8012, "clock": 8013,
    "input filter": 8020, "constant scan": 8039, "active steps": 8040, "annunciator": 8049,
    "error": 8004, "faults": 8067, **fx_pulses.REGISTERS,
}  # fmt: skip
# What the system alone writes.
_READ_ONLY_RELAYS = {
    *range(8000, 8006), *range(8011, 8015), 8046, 8048, *range(8060, 8068), *range(8246, 8256), *fx_pulses.BUSY
}  # fmt: skip
_READ_ONLY_REGISTERS = {8002, 8004, *range(8010, 8020), *range(8040, 8048), 8049, *range(8060, 8070)}

H2U = Model(
    name="H2U",
    family="FX",
    areas=_areas(m=3072),
    syntax=Syntax(
        areas=_BITS | set("TCDVZ"), bit_areas=_BITS, index_areas=frozenset("VZ"), constant=fx_constant,
        pointers=fx_spelling.POINTERS, end_label=fx_spelling.END_LABEL, indexed_constants=True, signed_decimals=True,
    ),
    timer_bases=((0, 199, 100_000), (200, 245, 10_000), (246, 249, 1_000), (250, 255, 100_000)),
    fast_timers=(246, 249),
    wide_counters=200,
    initial_steps=10,
    relays=_RELAYS,
    registers=_REGISTERS,
    read_only_relays=frozenset(_READ_ONLY_RELAYS),
    read_only_registers=frozenset(_READ_ONLY_REGISTERS),
    limits={
        "steps": 24_000, "MC nesting": 8, "FOR nesting": 5, "CALL nesting": 5, "subroutines": 128, "joined steps": 8, "flows": 160,
        "ways": 8, "ways of an initial step": 16,
        "bit variables": 0, "word variables": 0, "global variables": 500, "stack": 11, "exchanges": 128,
        "run inputs": 16, "modules": 8, "points": 256,
    },
    filter_inputs=8,
    filter_ms=10,
    filter_choices=tuple(range(61)),
    reff_ms=tuple(range(61)),
    instruction_ns=260,
    retained=("M", "S", "T", "C", "D"),
    special_bits="M",
    special_words="D",
    first_special=8000,
    local_areas=(),
    index_pairs={"Z": "V"},
    least_wide_digits=1,
    annunciators=range(900, 1000),
    high_word_first=False,
    operand_ranges={"DCOUNTER": (200, 234), "HCOUNTER": (235, 255), "PULSE": (0, 4)},
    spelling=fx_spelling.H2U,
    functions=fx_spelling.FUNCTIONS,
    sections=fx_spelling.SECTIONS,
    foreign=fx_spelling.FOREIGN,
    levels=True,
    strict_steps=True,
    unconditional=frozenset({"EI", "DI", "NOP"}),
    overlap=True,
    pulse_suffix="P",
    clears_at_stop=True,
    latched_relays=frozenset({8068}),
    scan_time_us=100,
    clock_order=(5, 4, 3, 2, 1, 0, 6),
    fault_codes={
        40: 6401, 61: 6105, 64: 6706, 65: 6706, 66: 6702, 67: 6703, 68: 6701, 69: 6706, 70: 6706, 72: 6701, 73: 6708, 74: 6708,
        75: 6706, 76: 6706, 77: 6706, 78: 6708, 79: 6760, 80: 6760,
    },
    fault_groups=8000,
    retention_limits={"ranges": 2},
    usual_retention={"M": ((500, 1023),), "S": ((500, 999),), "C": ((100, 199), (220, 255)), "D": ((200, 511),)},
    fixed_retention={"M": ((1024, 3071),), "T": ((246, 255),), "D": ((512, 7999),)},
    unset={
        "hold_values": "M8033 does that",
        "stop_outputs": "outputs go OFF, or stay with M8033 ON",
        "stop_output_table": "outputs go OFF, or stay with M8033 ON",
        "constant_scan_ms": "set M8039 and write the time into D8039",
        "no_battery": "M8030 switches its lamp off",
        "interrupt_priority": "all interrupts have the same",
        "format_lock": "leave it out",
        "modules": "set modules up with TO",
    },
    fault_record=1,
    module_kinds=ec_modules.MODULES_EC10,
    base_units=((10, 10), (16, 16), (24, 16), (32, 32), (36, 24), (40, 40), (64, 64)),
    initial_registers=fx_pulses.INITIAL | fx_serial.INITIAL,
    **fx_fast.H2U,
    **fx_pulses.H2U,
    **fx_serial.H2U,
)  # fmt: skip

H1U = replace(
    H2U,
    name="H1U",
    areas=_areas(m=1536),
    spelling=fx_spelling.H1U,
    operand_ranges=H2U.operand_ranges | {"PULSE": (0, 1)},
    **fx_pulses.H1U,
    **fx_fast.H1U,
    **fx_serial.H1U,
    retention_limits={"ranges": 0},
    usual_retention={},
    fixed_retention={
        "M": ((384, 1535),),
        "S": ((128, 999),),
        "T": ((246, 255),),
        "C": ((16, 199), (220, 255)),
        "D": ((128, 7999),),
    },
    base_units=((8, 6), (14, 10), (16, 14), (24, 16), (36, 24), (40, 40)),
)
