"""The I/O of EC10 and EC20 as data: base units, limits of the extension bus, special modules, EC10's own analog channels.

Base units and limits stand in tables 1-1, 2-1 and 2-2. The modules' own manuals are not part of the programming manual: modes and
buffers are those of docs/modules.md.
"""

from .model import AnalogMode, AnalogPort, ModuleKind

BASE_UNITS_EC20 = ((10, 6), (14, 10), (20, 12), (24, 16), (32, 32), (40, 40))
BASE_UNITS_EC10 = ((10, 6), (14, 10), (16, 14), (24, 16), (36, 24))
ANALOG_BASE_EC10 = (16, 14)  # EC10-1614BRA1 (3.1.9)

LIMITS_EC20 = {"modules": 8, "points": 512}
LIMITS_EC10 = {"modules": 4, "points": 128}


def _volts(most: float) -> AnalogMode:
    return AnalogMode("V", -most, 0, most, 0, 10_000)


def _milliamperes(low: float, origin: float) -> AnalogMode:
    return AnalogMode("mA", low, origin, 20, 0, 10_000)


def _sensor(low: int, high: int) -> AnalogMode:
    """A sensor of temperature, read in tenths of a degree."""
    return AnalogMode("C", low, 0, high, 0, 10 * high)


_INPUTS = {0: _volts(10), 1: _volts(5), 2: _milliamperes(-20, 0), 3: _milliamperes(4, 4)}
_OUTPUTS = {0: _volts(10), 1: _milliamperes(0, 0), 2: _milliamperes(4, 4)}
_RESISTORS = {0: _sensor(-150, 600), 1: _sensor(-30, 120), 2: _sensor(-30, 120)}  # Pt100, Cu100, Cu50
_THERMOCOUPLES = {  # K, J, E, N, T, R, S
    0: _sensor(-100, 1200), 1: _sensor(-100, 1000), 2: _sensor(-100, 1000), 3: _sensor(-100, 1200),
    4: _sensor(-200, 400), 5: _sensor(0, 1600), 6: _sensor(0, 1600),
}  # fmt: skip

_KINDS = (
    ModuleKind("4AD", 1, 4, _INPUTS),
    ModuleKind("4DA", 2, 4, _OUTPUTS, output=True),
    ModuleKind("4PT", 3, 4, _RESISTORS),
    ModuleKind("4TC", 4, 4, _THERMOCOUPLES),
)
MODULES_EC10 = {kind.name: kind for kind in _KINDS}
MODULES_EC20 = MODULES_EC10 | {kind.name: kind for kind in (ModuleKind("8AD", 5, 8, _INPUTS), ModuleKind("8TC", 6, 8, _THERMOCOUPLES))}

_EITHER = (_volts(10), _milliamperes(-20, 0))  # SM174 and SM175 choose
ANALOG_EC10 = {
    "analog_inputs": (AnalogPort(172, 172, _EITHER, 174, 173), AnalogPort(173, 174, _EITHER, 175, 175)),
    "analog_outputs": (AnalogPort(178, 178, (_volts(10),)),),
}

RELAYS = {"bus error": 190, "module error": 191, "special module error": 192}
REGISTERS = {"modules": 7, "special modules": 8, "base points": 10, "extension points": 11, "analog points": 12, "faulty group": 26}
REGISTERS_EC10 = {"silent module": 191, "silent special module": 192}
INITIAL_EC10 = {173: 8, 175: 8}
