"""6.7: rotate and shift. Left is the side of the higher bit, and of the higher device number in a string of bits."""

from .define import value


def rotated_right(word, bits, count):
    """A number of `bits` bits rotated right by `count`."""
    count %= bits
    return (word >> count | word << bits - count) & (1 << bits) - 1


def out_at_right(word, bits, count, carry):
    """Rotated right, and the bit that moved last; when none moves the carry stays."""
    word = rotated_right(word, bits, count)
    return word, word >> bits - 1 == 1 if count else carry


def out_at_left(word, bits, count, carry):
    """Rotated left, and the bit that moved last; when none moves the carry stays."""
    word = rotated_right(word, bits, -count)
    return word, word & 1 == 1 if count else carry


def through_carry(word, bits, count, carry):
    """Rotated right in a ring with the carry, which stands left of the highest bit."""
    ring = rotated_right(carry << bits | word, bits + 1, count)
    return ring, ring >> bits == 1


@value("ROR", "S1:WORD^ >D:WORD S2:INT=0..32767 carry -> carry", steps=7, section="6.7.1")
def ror(s1, s2, carry):
    """D becomes S1 rotated right by S2 bits; the carry flag is the bit that moved last."""
    return out_at_right(s1, 16, s2, carry)


@value("DROR", "S1:DWORD^ >D:DWORD S2:INT=0..32767 carry -> carry", steps=9, section="6.7.5")
def dror(s1, s2, carry):
    """D becomes S1, 32 bits, rotated right by S2 bits; the carry flag is the bit that moved last."""
    return out_at_right(s1, 32, s2, carry)


@value("ROL", "S1:WORD^ >D:WORD S2:INT=0..32767 carry -> carry", steps=7, section="6.7.2")
def rol(s1, s2, carry):
    """D becomes S1 rotated left by S2 bits; the carry flag is the bit that moved last."""
    return out_at_left(s1, 16, s2, carry)


@value("DROL", "S1:DWORD^ >D:DWORD S2:INT=0..32767 carry -> carry", steps=9, section="6.7.6")
def drol(s1, s2, carry):
    """D becomes S1, 32 bits, rotated left by S2 bits; the carry flag is the bit that moved last."""
    return out_at_left(s1, 32, s2, carry)


@value("RCR", "S1:WORD^ >D:WORD S2:INT=0..32767 carry -> carry", steps=7, section="6.7.3")
def rcr(s1, s2, carry):
    """D and the carry flag become S1 and the carry flag, a ring of 17 bits, rotated right by S2 bits."""
    return through_carry(s1, 16, s2, carry)


@value("DRCR", "S1:DWORD^ >D:DWORD S2:INT=0..32767 carry -> carry", steps=9, section="6.7.7")
def drcr(s1, s2, carry):
    """D and the carry flag become S1 and the carry flag, a ring of 33 bits, rotated right by S2 bits."""
    return through_carry(s1, 32, s2, carry)


@value("RCL", "S1:WORD^ >D:WORD S2:INT=0..32767 carry -> carry", steps=7, section="6.7.4")
def rcl(s1, s2, carry):
    """D and the carry flag become S1 and the carry flag, a ring of 17 bits, rotated left by S2 bits."""
    return through_carry(s1, 16, -s2, carry)


@value("DRCL", "S1:DWORD^ >D:DWORD S2:INT=0..32767 carry -> carry", steps=9, section="6.7.8")
def drcl(s1, s2, carry):
    """D and the carry flag become S1 and the carry flag, a ring of 33 bits, rotated left by S2 bits."""
    return through_carry(s1, 32, -s2, carry)


@value("SHR", "S1:WORD^ >D:WORD S2:INT=0..32767", steps=7, section="6.7.9")
@value("DSHR", "S1:DWORD^ >D:DWORD S2:INT=0..32767", steps=9, section="6.7.11")
def shr(s1, s2):
    """D becomes S1 shifted right by S2 bits; zeros come in at the left."""
    return s1 >> s2


@value("SHL", "S1:WORD^ >D:WORD S2:INT=0..32767", steps=7, section="6.7.10")
@value("DSHL", "S1:DWORD^ >D:DWORD S2:INT=0..32767", steps=9, section="6.7.12")
def shl(s1, s2):
    """D becomes S1 shifted left by S2 bits; zeros come in at the right."""
    return s1 << s2 if s2 < 32 else 0


@value("SFTR", "S1:BOOL*S3~ D:BOOL*S2~ S2:INT=0..32767 S3:INT=0..32767 -> D", steps=9, section="6.7.13")
def sftr(s1, d, s2, s3):
    """The S2 bits from D on move S3 places to lower numbers; the S3 bits from S1 on come in at the top."""
    return (d + s1)[s3:]


@value("SFTL", "S1:BOOL*S3~ D:BOOL*S2~ S2:INT=0..32767 S3:INT=0..32767 -> D", steps=9, section="6.7.14")
def sftl(s1, d, s2, s3):
    """The S2 bits from D on move S3 places to higher numbers; the S3 bits from S1 on come in at the bottom."""
    return (s1 + d)[:s2]
