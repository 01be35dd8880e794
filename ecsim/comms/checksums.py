"""The checksums of 6.13 and of Modbus frames, over octets."""


def _reflected(octet: int, polynomial: int) -> int:
    """An octet worked into an empty CRC register, its lowest bit first."""
    for _ in range(8):
        octet = octet >> 1 ^ (polynomial if octet & 1 else 0)
    return octet


_CRC16 = tuple(_reflected(octet, 0xA001) for octet in range(256))  # x^16 + x^15 + x^2 + 1, mirrored


def crc16(octets: bytes, start: int = 0xFFFF) -> int:
    """The CRC with x^16 + x^15 + x^2 + 1, the lowest bit first (6.13.2); begun with 16#FFFF it is that of Modbus, sent low byte first."""
    for octet in octets:
        start = start >> 8 ^ _CRC16[(start ^ octet) & 255]
    return start


def lrc(octets: bytes, start: int = 0) -> int:
    """What is missing from the sum of the octets to a multiple of 256, begun with `start` (6.13.3)."""
    return start - sum(octets) & 255
