"""The serial ports of EC10 and EC20 as data (chapter 10, appendices 1 and 2): protocols, baud rates, special devices, events."""

from dataclasses import replace

from .model import PortMap, SharedArea

SLOW = (38400, 19200, 9600, 4800, 2400, 1200)
# Protocol -> its baud rates (10.1). 1.3.2 and the special devices give ECbus to EC10 alone.
BAUDS = {
    "programming": SLOW, "none": SLOW, "freeport": SLOW, "modbus slave": SLOW, "modbus master": SLOW,
    "ecbus": (115200, 57600, *SLOW),
}  # fmt: skip
STOP_BITS = {"none": (2,), "odd": (1,), "even": (1,)}  # 10.4.13
MODE_BITS = {
    "baud": 0, "two stop bits": 3, "odd": 4, "parity": 5, "seven bits": 6, "start character": 7, "end character": 8,
    "gap timeout": 9, "frame timeout": 10,
}  # fmt: skip
BAUD_CODES = {38400: 0, 19200: 1, 9600: 2, 4800: 3, 2400: 4, 1200: 5, 57600: 6, 115200: 7}  # SD110.0 to SD110.2

_RELAYS = {"sending": 0, "receiving": 1, "sent": 2, "received": 3, "idle": 4}
_REGISTERS = {
    "mode": 0, "start character": 1, "end character": 2, "gap timeout": 3, "frame timeout": 4,
    "completion": 5, "character": 6, "characters": 7,
}  # fmt: skip


def _port(protocols: tuple[str, ...], first: int, settings: dict[str, int]) -> PortMap:
    return PortMap(
        protocols,
        relays={meaning: first + place for meaning, place in _RELAYS.items()},
        registers={meaning: first + place for meaning, place in _REGISTERS.items()} | settings,
    )


PORTS_EC20 = (
    _port(("programming", "freeport", "modbus slave"), 110, {"station": 130}),
    _port(
        ("none", "freeport", "modbus slave", "modbus master"),
        120,
        {"station": 135, "timeout": 136, "retries": 137, "sent character": 128},
    ),
)
_MORE_EC10 = (
    {"timeout": 131, "retries": 132, "refresh mode": 133, "sent character": 118},
    {"refresh mode": 138},
)
# 9.1: the interrupt events of a port
_EVENTS = ("character sent", "character received", "frame sent", "frame received")
PORTS_EC10 = tuple(
    replace(
        port,
        protocols=(*port.protocols, "ecbus"),
        registers=port.registers | more,
        events={meaning: 30 + 4 * number + place for place, meaning in enumerate(_EVENTS)},
    )
    for number, (port, more) in enumerate(zip(PORTS_EC20, _MORE_EC10, strict=True))
)
RELAYS = {"exchange done": 135, "exchange failed": 136}
REGISTERS = {"exchange error": 139}
BUFFERS = {"inverter request": ("D", 7940, 30), "inverter answer": ("D", 7970, 30)}  # appendix 3: area, first, count
LIMITS = {"exchanges": 128}  # 6.12.2: MODBUS and inverter instructions in a program

# 10.5.3: what the stations of an ECbus share in each refresh mode: one layer, then two layers with half of it each.
SHARED = {
    **{mode: SharedArea(stations, 7700, 64, 1400, 512, 140) for mode, stations in enumerate((32, 16, 8, 4, 2), 1)},
    **{mode: SharedArea(stations, 7700, 32, 1400, 256, 140) for mode, stations in enumerate((16, 8, 4, 2), 6)},
    **{mode: SharedArea(stations, 7732, 32, 1656, 256, 156) for mode, stations in enumerate((16, 8, 4, 2), 10)},
}
