"""The serial ports of H1U and H2U as data: protocols, special devices, Modbus addresses (docs/decisions.md: hardly any of it is in the manual)."""

from .model import ModbusRange, PortMap

RATES = (300, 600, 1200, 2400, 4800, 9600, 19200, 38400)
BAUDS = dict.fromkeys(("programming", "none", "rs", "modbus slave"), RATES)
BAUD_CODES = {baud: code for code, baud in enumerate(RATES, 3)}  # D8120.4 to D8120.7
MODE_BITS = {"eight bits": 0, "parity": 1, "even": 2, "two stop bits": 3, "baud": 4, "start character": 8, "end character": 9}
PROTOCOL_CODES = {0x02: ("modbus slave", "rtu"), 0x03: ("modbus slave", "ascii"), 0x10: ("rs", "rtu")}  # D8126

PORTS = (
    PortMap(("programming", "modbus slave"), {}, {}),
    PortMap(
        ("rs", "none", "modbus slave"),
        relays={"send request": 8122, "received": 8123, "timed out": 8129},
        registers={
            "mode": 8120, "station": 8121, "to send": 8122, "characters": 8123, "start character": 8124, "end character": 8125,
            "protocol": 8126, "tens of ms": 8129,
        },
    ),
)  # fmt: skip
INITIAL = {8124: 0x02, 8125: 0x03}  # STX and ETX

_BIT, _WORD = (1, 2, 5, 15), (3, 6, 16)
# Special M and D stand behind the others, at their own numbers.
RANGES = (
    ModbusRange("M", 0, 3072, _BIT),
    ModbusRange("M", 8000, 256, _BIT, first=8000),
    ModbusRange("S", 0xE000, 1000, _BIT),
    ModbusRange("TB", 0xF000, 256, _BIT),
    ModbusRange("CB", 0xF400, 256, _BIT),
    ModbusRange("X", 0xF800, 256, _BIT),
    ModbusRange("Y", 0xFC00, 256, _BIT),
    ModbusRange("D", 0, 8256, _WORD),
    ModbusRange("T", 0xF000, 256, _WORD),
    ModbusRange("C", 0xF400, 200, _WORD),
    ModbusRange("C", 0xF700, 56, (3, 16), first=200, words=2),
)
MOST = {1: 2000, 2: 2000, 3: 125, 15: 1968, 16: 123}

H2U = {
    "ports": PORTS, "bauds": BAUDS, "baud_codes": BAUD_CODES, "mode_bits": MODE_BITS, "protocol_codes": PROTOCOL_CODES,
    "modbus": RANGES, "modbus_most": MOST,
}  # fmt: skip
H1U = {"modbus": (ModbusRange("M", 0, 1536, _BIT), *RANGES[1:])}
