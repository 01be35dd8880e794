"""FNC 52, 70 to 79, 85, 86 of H1U and H2U: keys, switches, displays, a printer, special modules and potentiometers at the terminals.

What is scanned takes its time in scans or, where that is said, in milliseconds; outputs that lead one digit or row after the
other are part of the output image, and the answer at the inputs is seen in the scan after it, behind the filter later.
"""

from ..devices import Device
from ..errors import NO_ANSWER, NO_BUFFER, NO_MODULE, OPERAND, Fault
from ..values import join, split
from .conversion import SEGMENTS
from .define import FX, H2U, command, value

ROW_US = 20_000  # MTR
DIGIT_US = 100_000  # DSW
_NUMBER = "KnY KnM KnS T C D V Z"
_MODULE = {"models": FX, "faults": (NO_MODULE, NO_ANSWER, NO_BUFFER)}


def _apart(target):
    """How far the rows stand apart."""
    return 8 if target.area == "Y" else 10


def _rows(model, source, strobes, target, count):
    wrong = next((each for each in (source, strobes, target) if each.number % (10 if each.area in "MS" else 8)), None)
    if wrong is not None:
        return f"{wrong} does not end in 0"
    kept = model.read_only_relays if target.area == model.special_bits else ()
    taken = [target.number + _apart(target) * row + column for row in range(count) for column in range(8)]
    gone = next((number for number in taken if not model.areas[target.area].has(number) or number in kept), None)
    return f"{count} rows from {target} on need {Device(target.area, gone)}, which no program can write" if gone is not None else None


@command(
    "FX:MTR", "S:BOOL[X]*8 >D1:BOOL[Y]*N >D2:POINT[Y M S] N:INT[const]=2..8 machine now state -> complete state",
    steps=9, section="FNC 52", models=FX, cleared=True, check=_rows,
)  # fmt: skip
def mtr(flow, s, target, n, machine, now, state):
    """Read N rows of eight switches: each output from D1 on is ON for 20 ms, then the inputs from S on go to the bits of its row.

    The rows stand ten bits apart from D2 on (D2, D2+10 ...; eight among Y, which is 10 in octal). M8029 tells of the last row.
    An output is ON for two scans at least: the inputs answer after the first one, and the filter needs its time.
    """
    if not flow:
        return [False] * n, False, False
    row, since, put_out = state or (0, now, False)
    done, waited = False, bool(state)
    if put_out and now - since >= ROW_US:
        first = target.number + _apart(target) * row
        machine.memory.bits(target.area)[first : first + 8] = s
        row, since, waited, done = (row + 1) % n, now, False, row + 1 == n
    return [each == row for each in range(n)], done, (row, since, waited)


def _typed(number, key, digits):
    return (number * 10 + key) % 10**digits


def _ten_keys(flow, s, d1, state, digits):
    held, latched = state or (None, None)
    if not flow:
        return d1, [False] * 11, False
    if held is None or not s[held]:
        held = s.index(True) if True in s else None
        if held is not None:
            latched, d1 = held, _typed(d1, held, digits)
    return d1, [*(key == latched for key in range(10)), held is not None], (held, latched)


@command(
    "FX:TKY", f"S:BOOL[X Y M S]*10 D1:INT[{_NUMBER}] >D2:BOOL[Y M S]*11 state -> D1 state",
    steps=7, section="FNC 70", models=H2U, cleared=True,
)  # fmt: skip
def tky(flow, s, d1, state):
    """Type a number of up to four digits on the ten keys from S on: it stands in D1, the last key among the bits D2 to D2+9.

    D2+10 is ON while a key is pressed; of several the first one counts. A fifth digit pushes the first one out.
    """
    return _ten_keys(flow, s, d1, state, 4)


@command(
    "FX:DTKY", "S:BOOL[X Y M S]*10 D1:DINT[KnY KnM KnS C D V] >D2:BOOL[Y M S]*11 state -> D1 state",
    steps=13, section="FNC 70", models=H2U, cleared=True,
)  # fmt: skip
def dtky(flow, s, d1, state):
    """As TKY, for a number of up to eight digits."""
    return _ten_keys(flow, s, d1, state, 8)


def _sixteen_keys(flow, s, d2, d3, hexadecimal, state, digits):
    """One scan of HKY: `state` is the scan of eight, the keys found so far in this round, the key held in the last one.

    A row is led for two scans and read in the scan after them, which leads the next one: the filter has a whole scan.
    """
    if not flow:
        return [False] * 4, d2, [False] * 8, False, False
    scan, found, held = state or (0, (), None)
    row, waiting = divmod(scan, 2)
    done = False
    if state and not waiting:
        found += tuple(4 * ((row - 1) % 4) + column for column in range(4) if s[column])
        done = row == 0
    if done:
        key = held if held in found else min(found, default=None)
        letters = d3[:6]
        if key is not None and key != held:
            if hexadecimal:
                d2 = d2 << 4 | key  # what is above the bits of D2 falls away
            elif key < 10:
                d2 = _typed(d2, key, digits)
            if key >= 10:
                letters = [each == key for each in range(10, 16)]
        d3 = [*letters, key is not None and key >= 10, key is not None and key < 10]
        found, held = (), key
    return [each == row for each in range(4)], d2, d3, done, ((scan + 1) % 8, found, held)


@command(
    "FX:HKY", "S:BOOL[X]*4 >D1:BOOL[Y]*4 D2:INT[T C D V Z] D3:BOOL[Y M S]*8 hexadecimal state -> D2 D3 complete state",
    steps=9, section="FNC 71", models=H2U, cleared=True,
)  # fmt: skip
def hky(flow, s, d2, d3, hexadecimal, state):
    """Read a keypad of sixteen keys, four rows led by the outputs from D1 on, four columns at the inputs from S on, in eight scans.

    Digits make a number of up to four in D2; A to F turn one of D3 to D3+5 ON. D3+6 is ON while one of A to F is pressed, D3+7
    while a digit is. With M8167 ON all sixteen keys are hexadecimal digits. M8029 tells of the end of each round.
    """
    return _sixteen_keys(flow, s, d2, d3, hexadecimal, state, 4)


@command(
    "FX:DHKY", "S:BOOL[X]*4 >D1:BOOL[Y]*4 D2:DINT[C D V] D3:BOOL[Y M S]*8 hexadecimal state -> D2 D3 complete state",
    steps=17, section="FNC 71", models=H2U, cleared=True,
)  # fmt: skip
def dhky(flow, s, d2, d3, hexadecimal, state):
    """As HKY, for a number of up to eight digits."""
    return _sixteen_keys(flow, s, d2, d3, hexadecimal, state, 8)


@command(
    "FX:DSW", "S:BOOL[X]*{4*N} >D1:BOOL[Y]*4 D2:INT[T C D V Z]*N N:INT[const]=1..2 now state -> D2 complete state",
    steps=9, section="FNC 72", models=FX, cleared=True, faults=(OPERAND,),
)  # fmt: skip
def dsw(flow, s, d2, n, now, state):
    """Read N sets of four digit switches at the inputs from S on into D2 and D2+1, a digit in each tenth of a second.

    The outputs from D1 on lead the digits, the units first; each answers with its digit in four bits, the lowest first.
    M8029 tells of the fourth one. As with MTR an output is ON for two scans at least.
    """
    if not flow:
        return [False] * 4, d2, False, False
    digit, since, numbers, put_out = state or (0, now, (0,) * n, False)
    done, waited = False, bool(state)
    if put_out and now - since >= DIGIT_US:
        found = [sum(bit << place for place, bit in enumerate(s[4 * each : 4 * each + 4])) for each in range(n)]
        if max(found) > 9:
            raise Fault(OPERAND)
        numbers = tuple(number + 10**digit * each for number, each in zip(numbers, found, strict=True))
        digit, since, waited = digit + 1, now, False
        if digit == 4:
            d2, digit, numbers, done = list(numbers), 0, (0,) * n, True
    return [each == digit for each in range(4)], d2, done, (digit, since, numbers, waited)


@value("FX:SEGD", f"S:INT D:WORD[{_NUMBER}] -> D", steps=5, section="FNC 73", models=H2U)
def segd(s, d):
    """The low eight bits of D become the seven segments that show the low digit of S, 0 to F: bit 0 is segment a, bit 6 segment g."""
    return d & 0xFF00 | SEGMENTS[s & 15]


def _display(numbers, n, scan):
    """The outputs of a display with latches in one scan of twelve: a digit of each number as four bits, then the four strobes."""
    digit, phase = divmod(scan, 3)
    sets = [[number // 10**digit % 10 >> place & 1 == 1 for place in range(4)] for number in numbers]
    strobes = [each == digit and phase == 1 for each in range(4)]
    if n & 2:
        sets = [[not bit for bit in bits] for bits in sets]
    if n & 1:
        strobes = [not bit for bit in strobes]
    return [*sets[0], *strobes, *(sets[1] if len(sets) > 1 else [])]


@command(
    "FX:SEGL", "S:INT*{2 if N>3 else 1} >D:BOOL[Y]*{12 if N>3 else 8} N:INT[const]=0..7 state -> complete state",
    steps=7, section="FNC 74", models=FX, cleared=True, faults=(OPERAND,),
)  # fmt: skip
def segl(flow, s, n, state):
    """Show S, 0 to 9999, on a display of four digits with latches: four bits of a digit from D on, its strobe from D+4 on, in twelve scans.

    With N from 4 on S+1 goes to a second display, whose bits follow the strobes. N tells besides which logic the display wants:
    an odd N turns the strobes round, N = 2, 3, 6, 7 the bits. M8029 tells of the end of each round.
    """
    if not flow:
        return [False] * (12 if n > 3 else 8), False, False
    if not all(0 <= number <= 9999 for number in s):
        raise Fault(OPERAND)
    scan = (state or 0) % 12
    return _display(s, n, scan), scan == 11, scan + 1


@command(
    "FX:ARWS", "S:BOOL[X Y M S]*4 D1:INT[T C D V Z] >D2:BOOL[Y]*8 N:INT[const]=0..3 state -> D1 state",
    steps=9, section="FNC 75", models=H2U, cleared=True, faults=(OPERAND,),
)  # fmt: skip
def arws(flow, s, d1, n, state):
    """Set the four digits of D1 with four keys from S on (down, up, to the right, to the left), and show them as SEGL does.

    Each press of up or down changes the chosen digit, from 9 to 0 and back; it is the highest one at first.
    """
    if not flow:
        return d1, [False] * 8, False
    if not 0 <= d1 <= 9999:
        raise Fault(OPERAND)
    scan, digit, before = state or (0, 3, (True,) * 4)
    down, up, right, left = (now and not was for now, was in zip(s, before, strict=True))
    if down or up:
        shown = d1 // 10**digit % 10
        d1 += ((shown + (1 if up else -1)) % 10 - shown) * 10**digit
    if right or left:
        digit = (digit + (1 if left else -1)) % 4
    return d1, _display([d1], n, scan % 12), (scan + 1, digit, tuple(s))


@command(
    "FX:PR", "S:WORD[T C D]*{8 if sixteen else 4} >D:BOOL[Y]*10 sixteen state -> complete state",
    steps=5, section="FNC 77", models=H2U, cleared=True,
)  # fmt: skip
def pr(flow, s, sixteen, state):
    """Print eight characters, two in each word from S on: eight bits from D on, then the strobe, and D+9 while it is at work.

    Each character takes three scans, its strobe is ON in the second one. With M8027 ON up to sixteen are printed, until a
    character 0, and to the end though the flow goes. M8029 tells of the end; a new rise of the flow begins again.
    """
    scan, codes = state or (0, bytes(code for word in s for code in (word & 255, word >> 8)))
    if sixteen and not state:
        codes = codes.partition(b"\0")[0]
    if not flow and not (sixteen and scan < 3 * len(codes)):
        return [False] * 10, False, False
    if scan >= 3 * len(codes):
        return [False] * 10, True, (scan, codes)
    character, phase = divmod(scan, 3)
    bits = [codes[character] >> place & 1 == 1 for place in range(8)]
    return [*bits, phase == 1, True], False, (scan + 1, codes)


@command(
    "FX:FROM", f"M1:INT[const]=0..7 M2:INT[const]=0..32767 >D:INT[{_NUMBER}]*N N:INT[const]=1..32767", steps=9, section="FNC 78", **_MODULE
)
def from_(machine, m1, m2, n):
    """The N registers from D on = the buffers of special module M1 from number M2 on."""
    return machine.modules.read(m1, m2, n)


@command(
    "FX:DFROM",
    "M1:INT[const]=0..7 M2:INT[const]=0..32767 >D:DINT[KnY KnM KnS C D V]*N N:INT[const]=1..16383",
    steps=17,
    section="FNC 78",
    **_MODULE,
)
def dfrom(machine, m1, m2, n):
    """The N double words from D on = pairs of buffers of special module M1 from number M2 on, the low word in the lower number."""
    words = machine.modules.read(m1, m2, 2 * n)
    return [join(words[place + 1], words[place]) for place in range(0, 2 * n, 2)]


@command("FX:TO", "M1:INT[const]=0..7 M2:INT[const]=0..32767 S:INT*N N:INT[const]=1..32767", steps=9, section="FNC 79", **_MODULE)
def to(machine, m1, m2, s, n):
    """The buffers of special module M1 from number M2 on = the N words from S on; a constant goes into all of them."""
    machine.modules.write(m1, m2, s * n if len(s) < n else s)


@command("FX:DTO", "M1:INT[const]=0..7 M2:INT[const]=0..32767 S:DINT*N N:INT[const]=1..16383", steps=17, section="FNC 79", **_MODULE)
def dto(machine, m1, m2, s, n):
    """Pairs of buffers of special module M1 from number M2 on = the N double words from S on, the low word in the lower number."""
    values = s * n if len(s) < n else s
    machine.modules.write(m1, m2, [word for each in values for word in reversed(split(each))])


@command("FX:VRRD", f"S:INT[const]=0..7 -> D:WORD[{_NUMBER}]", steps=5, section="FNC 85", models=FX)
def vrrd(machine, s):
    """D = the value of potentiometer S, 0 to 255; it is 0 where there is no such potentiometer."""
    return machine.pots.read(s)


@command("FX:VRSC", f"S:INT[const]=0..7 -> D:WORD[{_NUMBER}]", steps=5, section="FNC 86", models=FX)
def vrsc(machine, s):
    """D = the value of potentiometer S as a scale of 0 to 10, the nearest mark."""
    return (20 * machine.pots.read(s) + 255) // 510
