"""The Modbus addresses of EC10 and EC20 as data (10.4.6, appendix 7)."""

from .model import ModbusRange

BIT, WORD = (1, 5, 15), (3, 6, 16)

# T and C stand twice: their contacts (TB, CB) as bits, their values as words.
RANGES = (
    ModbusRange("Y", 0, 256, BIT),
    ModbusRange("X", 1200, 256, BIT),
    ModbusRange("X", 0, 256, (2,)),
    ModbusRange("M", 2000, 2000, BIT),
    ModbusRange("SM", 4400, 256, BIT),
    ModbusRange("S", 6000, 992, BIT),
    ModbusRange("TB", 8000, 256, BIT),
    ModbusRange("CB", 9200, 256, BIT),
    ModbusRange("D", 0, 8000, WORD),
    ModbusRange("SD", 8000, 256, WORD),
    ModbusRange("Z", 8500, 16, WORD),
    ModbusRange("T", 9000, 256, WORD),
    ModbusRange("C", 9500, 200, WORD),
    ModbusRange("C", 9700, 56, (3, 16), first=200, words=2),
)
# Function -> the most devices (bits) or registers of one request (10.4.8).
MOST = {1: 2000, 2: 2000, 3: 125, 15: 1968, 16: 120}
