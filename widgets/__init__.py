"""Live panels of a running PLC in a notebook: run control, the unit, the machine, chart, ladder, timers and counters, and the editor.

`%load_ext ecsim_widgets` brings the cell magic `%%il`.
"""

from .lab import Lab
from .magic import load_ipython_extension, unload_ipython_extension
from .panel import Panel

__all__ = ["Lab", "Panel", "load_ipython_extension", "unload_ipython_extension"]
