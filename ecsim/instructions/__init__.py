"""The instructions of the manual, a module a section; importing this package fills TABLE."""

from . import (  # noqa: F401
    arithmetic,
    bits,
    checksums,
    compare,
    contacts,
    conversion,
    counters,
    flow,
    master_control,
    sfc,
    shifts,
    timers,
    transfer,
    word_bits,
)
from .define import TABLE, Definition

__all__ = ["TABLE", "Definition"]
