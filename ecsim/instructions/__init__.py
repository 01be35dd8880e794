"""The instructions of the manual, a module a section; importing this package fills TABLE."""

from . import arithmetic, bits, compare, contacts, counters, flow, master_control, sfc, timers, transfer  # noqa: F401
from .define import TABLE, Definition

__all__ = ["TABLE", "Definition"]
