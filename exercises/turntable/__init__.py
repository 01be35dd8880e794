"""A turntable for the rotary table instruction of H2U, and a shaft with an encoder for its drums of cams."""

from .picture import PICTURE, SHAFT_PICTURE
from .plant import CamShaft, Turntable

__all__ = ["PICTURE", "SHAFT_PICTURE", "CamShaft", "Turntable"]
