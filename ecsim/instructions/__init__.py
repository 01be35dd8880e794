"""The instructions of the manual, a module a section; importing this package fills TABLE."""

from . import (  # noqa: F401
    arithmetic,
    bits,
    checksums,
    compare,
    contacts,
    control,
    conversion,
    counters,
    floating_point,
    flow,
    highspeed,
    master_control,
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
