"""6.2: data transfer."""

from ..devices import Bits
from ..errors import OPERAND, STACK, Fault
from .define import value


def same_digits(first: int, second: int):
    """The check that two operands, by their places, are no Kn strings of different length."""

    def check(*operands) -> str | None:
        strings = [operand for operand in (operands[first], operands[second]) if isinstance(operand, Bits)]
        if len(strings) == 2 and strings[0].digits != strings[1].digits:
            return f"{strings[0]} and {strings[1]} differ in length; both have the same n in Kn"
        return None

    return check


@value("MOV", "S:INT -> D:INT+SD", steps=5, section="6.2.1", as_stored=True)
@value("DMOV", "S:DINT -> D:DINT+SD", steps=7, section="6.2.2", as_stored=True)
@value("RMOV", "S:REAL -> D:REAL", steps=7, section="6.2.3", as_stored=True)
def mov(s):
    """D = S."""
    return s


@value("BMOV", "S1:INT-const-KnSM-Z*S2 >D:INT-Z*S2 S2:INT", steps=7, section="6.2.4", as_stored=True)
def bmov(s1, s2):
    """The S2 elements from D on become those from S1 on; the two blocks may overlap."""
    return s1


@value("FMOV", "S1:INT >D:INT-Z*S2 S2:INT=0..32767", steps=7, section="6.2.5", as_stored=True, check=same_digits(0, 1))
@value("DFMOV", "S1:DINT >D:DINT*S2 S2:INT=0..32767", steps=9, section="6.2.6", as_stored=True, check=same_digits(0, 1))
def fmov(s1, s2):
    """Each of the S2 elements from D on becomes S1."""
    return [s1] * s2


@value("SWAP", "D:INT -> D", steps=3, section="6.2.7")
def swap(d):
    """The two bytes of D change places."""
    return (d & 255) << 8 | d >> 8 & 255


@value("XCH", "D1:INT D2:INT -> D1 D2", steps=5, section="6.2.8", as_stored=True, check=same_digits(0, 1))
@value("DXCH", "D1:DINT D2:DINT -> D1 D2", steps=7, section="6.2.9", as_stored=True, check=same_digits(0, 1))
def xch(d1, d2):
    """D1 and D2 change places."""
    return d2, d1


# A stack is a count, D or D1, and as many elements behind it as its size says.


def _check_stack(count: int, size: int) -> None:
    """A stack without size, or whose count is none of 0 to the size, is error 70."""
    if size <= 0 or not 0 <= count <= size:
        raise Fault(STACK)


@value("PUSH", "S1:INT D:INT[D V]*{max(S2,0)+1} S2:INT -> D carry", steps=7, section="6.2.10", as_stored=True, faults=(STACK,))
def push(s1, d, s2):
    """S1 becomes the top of the stack at D, whose count grows by 1; carry tells that it was full already."""
    count = d[0]
    _check_stack(count, s2)
    if count == s2:
        return d, True
    d[0] = count + 1
    d[count + 1] = s1
    return d, False


@value("FIFO", "D1:INT[D V]*{max(S,0)+1} D2:INT S:INT -> D1 D2 zero", steps=7, section="6.2.11", as_stored=True, faults=(STACK,))
def fifo(d1, d2, s):
    """D2 becomes the first element of the queue at D1, the others move up and the last becomes 0; zero tells that the queue is empty."""
    count = d1[0]
    _check_stack(count, s)
    if count == 0:
        return d1, d2, True
    return [count - 1, *d1[2:], 0], d1[1], count == 1


@value("LIFO", "D1:INT[D V]*{max(S,0)+1} D2:INT S:INT -> D1 D2 zero", steps=7, section="6.2.12", as_stored=True, faults=(STACK,))
def lifo(d1, d2, s):
    """D2 becomes the top of the stack at D1, whose count shrinks by 1; zero tells that the stack is empty."""
    count = d1[0]
    _check_stack(count, s)
    if count == 0:
        return d1, d2, True
    d1[0] = count - 1
    return d1, d1[count], count == 1


_STRING = "S1:INT-const-KnSM-Z*S3 D:INT-Z*S2 S2:INT=0..32767 S3:INT=0..32767 -> D"


@value("WSFR", _STRING, steps=9, section="6.2.13", as_stored=True, check=same_digits(0, 1), faults=(OPERAND,))
def wsfr(s1, d, s2, s3):
    """The S2 elements from D on move down by S3 places, and the S3 elements from S1 on enter at the upper end."""
    if s3 > s2:
        raise Fault(OPERAND)
    return d[s3:] + s1


@value("WSFL", _STRING, steps=9, section="6.2.14", as_stored=True, check=same_digits(0, 1), faults=(OPERAND,))
def wsfl(s1, d, s2, s3):
    """The S2 elements from D on move up by S3 places, and the S3 elements from S1 on enter at the lower end."""
    if s3 > s2:
        raise Fault(OPERAND)
    return s1 + d[: s2 - s3]
