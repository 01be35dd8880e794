"""An operator's panel: keys, a keypad, thumbwheels, a display, switches and a printer, for the instructions that read and lead them."""

from .picture import PICTURE
from .plant import OperatorPanel

__all__ = ["PICTURE", "OperatorPanel"]
