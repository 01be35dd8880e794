"""An inverter with its motor as a station on a Modbus line: the machine of the inverter instructions (manual 6.12.2 to 6.12.10)."""

from .plant import Inverter

__all__ = ["Inverter"]
