"""The instructions of the manual, a module a section; importing this package fills TABLE."""

from . import (  # noqa: F401
    arithmetic,
    bits,
    checksums,
    clock,
    communication,
    compare,
    contacts,
    control,
    conversion,
    counters,
    floating_point,
    flow,
    fx_basic,
    fx_control,
    fx_external,
    fx_flow,
    fx_handy,
    highspeed,
    master_control,
    peripherals,
    positioning,
    sfc,
    shifts,
    timers,
    transfer,
    word_bits,
    word_logic,
)
from .define import TABLE, Definition

__all__ = ["TABLE", "Definition"]
