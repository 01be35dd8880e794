"""Live panels of a running PLC in a notebook: run control, the unit, the machine, chart, ladder, timers and counters."""

from .lab import Lab
from .panel import Panel

__all__ = ["Lab", "Panel"]
