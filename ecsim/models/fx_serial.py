"""The serial ports of H1U and H2U as data: protocols, special devices, Modbus addresses."""

RELAYS: dict[str, int] = {}
REGISTERS: dict[str, int] = {}
READ_ONLY_RELAYS: tuple[int, ...] = ()
H2U: dict = {}
