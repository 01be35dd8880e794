"""What the inverter instructions say to an EV inverter (6.12.2 to 6.12.10): its Modbus registers and the words in them.

The manual names what each instruction does and prints no frame. The parameters of the inverter lie where 6.12.8 and 6.12.10
have them: group in the high byte, number in the low byte. The registers that command it and tell its state are those below.
"""

CONTROL, SETTING = 0x6400, 0x6401  # the control word, the main setting in 0.01 Hz
STATUS = 0x6500  # from here on the seven words that EVRDST can ask for
STATUS_WORDS = ("status", "actual value", "type", "current", "voltage", "speed", "fault")

# The control word: bits 0 to 2 are the command, bit 3 reverses it, bits 4 and 5 jog, bit 6 lets the ramp go on, bit 7 makes the word valid.
VALID, RAMP, REVERSE = 0x80, 0x40, 0x08
RUN, STOP_COMMANDS = 0b111, (0b110, 0b101, 0b100)  # stop with the ramp, by coasting, with the fastest ramp
JOG_FORWARD, JOG_REVERSE = 0x10, 0x20
FAULT_RESET = 0x200

READ, WRITE = 3, 6
HUNDREDTHS = 100  # of a hertz


def command(word: int) -> bytes:
    """The message that gives the inverter a control word."""
    return write(CONTROL, VALID | RAMP | word)


def write(register: int, value: int) -> bytes:
    """The message that writes one register."""
    return bytes((WRITE,)) + register.to_bytes(2) + value.to_bytes(2)


def read(register: int) -> bytes:
    """The message that reads one register."""
    return bytes((READ,)) + register.to_bytes(2) + (1).to_bytes(2)
