"""The pulse outputs of H1U and H2U as data: their relays, registers and the events of I502 to I506 (manual 3.8)."""

from .model import PulseOutput

# Y0 and Y1 as FX1N has them, Y2 to Y4 behind them (docs/decisions.md). Count and position are one register.
_Y0_Y1 = tuple(PulseOutput(8145 + n, 8147 + n, 8140 + 2 * n, 8140 + 2 * n, 502 + n, clear=2 + n) for n in range(2))
_Y2_Y4 = tuple(PulseOutput(8152 + n, 8149 + n, 8150 + 2 * n, 8150 + 2 * n, 504 + n) for n in range(3))

RELAYS = {"clear signal": 8140}
REGISTERS = {"pulses of all": 8136, "base frequency": 8145, "top frequency": 8146, "ramp time": 8148}
INITIAL = {8145: 0, 8146: 100_000 % 0x10000 - 0x10000, 8147: 100_000 // 0x10000, 8148: 100}  # 100 kHz, 100 ms
BUSY = frozenset(range(8147, 8152))

H2U = {"pulse_outputs": _Y0_Y1 + _Y2_Y4, "least_ramp_ms": 50}
H1U = {"pulse_outputs": _Y0_Y1}
