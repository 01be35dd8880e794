"""How H2U and H1U write their instructions: the name in a program -> TABLE's key, in the order of the function numbers.

An instruction that means the same as one of EC is that row of TABLE under its own name; one that differs, or that EC
does not have, has a row of its own, whose key begins with "FX:". The 32-bit forms stand beside the 16-bit ones.
"""

from .model import By

END_LABEL = 63  # P63 stands for END (manual 3.8)
POINTERS = {"LABEL": "P", "NEST": "N", "EVENT": "I"}  # kind of operand -> its letter
_COMPARISONS = {
    f"{join}{wide}{relation}" for join in ("LD", "AND", "OR") for wide in ("", "D") for relation in ("=", ">", "<", "<>", "<=", ">=")
}

ALL = (0, 0xFFFF)


def _into(word: str, bits: str) -> By:
    """A choice by the second operand: a word, or a run of bits."""
    return By(word, *((area, *ALL, bits) for area in "YMS"))


H2U: dict[str, str | By] = {
    # basic instructions
    **{name: name for name in "LD LDI AND ANI OR ORI ANB ORB MPS MRD MPP INV NOP STL RET".split()},
    **{name: f"FX:{name}" for name in "LDP LDF ANDP ANDF ORP ORF PLS PLF MC MCR END I".split()},
    "OUT": By(
        "OUT",
        ("T", 0, 245, By("FX:OUT T", ("D", *ALL, "FX:OUT T D"))),
        ("T", 246, 255, By("FX:OUT T246", ("D", *ALL, "FX:OUT T246 D"))),
        ("C", 0, 199, "FX:OUT C"),
        ("C", 200, 234, "FX:OUT C200"),
        ("C", 235, 255, "FX:OUT C235"),
    ),
    "SET": By("SET", ("T", 0, 255, "FX:SET"), ("C", 0, 255, "FX:SET")),
    "RST": By("RST", ("D", *ALL, "FX:RST D"), ("V", 0, 7, "FX:RST D"), ("Z", 0, 7, "FX:RST D")),
    "P": "LBL",
    # FNC 00 to 09: program flow
    "CJ": By("CJ", ("P", END_LABEL, END_LABEL, "FX:CJ END")),
    "CALL": "CALL",
    "SRET": "FX:SRET",
    "IRET": "FX:IRET",
    "EI": "EI",
    "DI": "DI",
    "FEND": "FX:FEND",
    "WDT": "WDT",
    "FOR": "FX:FOR",
    "NEXT": "NEXT",
    # FNC 10 to 19: comparing and moving
    "CMP": "FX:CMP",
    "DCMP": "FX:DCMP",
    "ZCP": "FX:ZCP",
    "DZCP": "FX:DZCP",
    "MOV": "MOV",
    "DMOV": "DMOV",
    "SMOV": "FX:SMOV",
    "CML": "WINV",
    "DCML": "DWINV",
    "BMOV": "FX:BMOV",
    "FMOV": "FX:FMOV",
    "DFMOV": "FX:DFMOV",
    "XCH": "FX:XCH",
    "DXCH": "FX:DXCH",
    "BCD": "FX:BCD",
    "DBCD": "FX:DBCD",
    "BIN": "FX:BIN",
    "DBIN": "FX:DBIN",
    # FNC 20 to 29: arithmetic and logic
    "ADD": "FX:ADD",
    "DADD": "FX:DADD",
    "SUB": "FX:SUB",
    "DSUB": "FX:DSUB",
    "MUL": "MUL",
    "DMUL": "FX:DMUL",
    "DIV": "FX:DIV",
    "DDIV": "FX:DDIV",
    "INC": "INC",
    "DINC": "DINC",
    "DEC": "DEC",
    "DDEC": "DDEC",
    "WAND": "WAND",
    "DAND": "DWAND",
    "DWAND": "DWAND",
    "WOR": "WOR",
    "DOR": "DWOR",
    "DWOR": "DWOR",
    "WXOR": "WXOR",
    "DXOR": "DWXOR",
    "DWXOR": "DWXOR",
    "NEG": "FX:NEG",
    "DNEG": "FX:DNEG",
    # FNC 30 to 39: rotating and shifting
    "ROR": "FX:ROR",
    "DROR": "FX:DROR",
    "ROL": "FX:ROL",
    "DROL": "FX:DROL",
    "RCR": "FX:RCR",
    "DRCR": "FX:DRCR",
    "RCL": "FX:RCL",
    "DRCL": "FX:DRCL",
    "SFTR": "FX:SFTR",
    "SFTL": "FX:SFTL",
    "WSFR": "FX:WSFR",
    "WSFL": "FX:WSFL",
    "SFWR": "FX:SFWR",
    "SFRD": "FX:SFRD",
    # FNC 40 to 49: data
    "ZRST": By("FX:ZRST", ("D", *ALL, "FX:ZRST D")),
    "DECO": By(_into("FX:DECO", "FX:DECO to bits"), *((area, *ALL, _into("FX:DECO bits", "FX:DECO bits to bits")) for area in "XYMS")),
    "ENCO": By("FX:ENCO", *((area, *ALL, "FX:ENCO bits") for area in "XYMS")),
    "SUM": "FX:SUM",
    "DSUM": "FX:DSUM",
    "BON": "FX:BON",
    "DBON": "FX:DBON",
    "MEAN": "FX:MEAN",
    "DMEAN": "FX:DMEAN",
    "ANS": "FX:ANS",
    "ANR": "FX:ANR",
    "SQR": "FX:SQR",
    "DSQR": "FX:DSQR",
    "FLT": "FX:FLT",
    "DFLT": "FX:DFLT",
    # FNC 50 to 59: high-speed processing
    "REF": "REF",
    "REFF": "FX:REFF",
    "MTR": "FX:MTR",
    "DHSCS": By(By(By("FX:DHSCS", ("I", *ALL, "FX:DHSCS I")))),
    "DHSCR": "FX:DHSCR",
    "DHSZ": "FX:DHSZ",
    "SPD": "FX:SPD",
    "PLSY": "FX:PLSY",
    "DPLSY": "FX:DPLSY",
    "PWM": "PWM",
    "PLSR": "FX:PLSR",
    "DPLSR": "FX:DPLSR",
    # FNC 60 to 69: convenient instructions
    "IST": "FX:IST",
    "SER": "FX:SER",
    "DSER": "FX:DSER",
    "ABSD": "FX:ABSD",
    "DABSD": "FX:DABSD",
    "INCD": "FX:INCD",
    "TTMR": "FX:TTMR",
    "STMR": "FX:STMR",
    "ALT": "FX:ALT",
    "RAMP": "FX:RAMP",
    "ROTC": "FX:ROTC",
    "SORT": "FX:SORT",
    # FNC 70 to 79: external devices
    "TKY": "FX:TKY",
    "DTKY": "FX:DTKY",
    "HKY": "FX:HKY",
    "DHKY": "FX:DHKY",
    "DSW": "FX:DSW",
    "SEGD": "FX:SEGD",
    "SEGL": "FX:SEGL",
    "ARWS": "FX:ARWS",
    "ASC": "ASC",
    "PR": "FX:PR",
    "FROM": "FX:FROM",
    "DFROM": "FX:DFROM",
    "TO": "FX:TO",
    "DTO": "FX:DTO",
    # FNC 80 to 88: serial devices
    "RS": "FX:RS",
    "PRUN": By("FX:PRUN", ("KnM", *ALL, "FX:PRUN M")),
    "DPRUN": By("FX:DPRUN", ("KnM", *ALL, "FX:DPRUN M")),
    "ASCI": "FX:ASCI",
    "HEX": "FX:HEX",
    "CCD": "FX:CCD",
    "VRRD": "FX:VRRD",
    "VRSC": "FX:VRSC",
    "PID": "FX:PID",
    # FNC 110 to 132: floating point, whose names are written with D in front
    "DECMP": "FX:ECMP",
    "DEZCP": "FX:EZCP",
    "DEBCD": "FX:EBCD",
    "DEBIN": "FX:EBIN",
    "DEADD": "RADD",
    "DESUB": "RSUB",
    "DEMUL": "RMUL",
    "DEDIV": "RDIV",
    "DESQR": "RSQT",
    "INT": "FX:INT",
    "DINT": "FX:DINT",
    "DSIN": "FX:SIN",
    "DCOS": "FX:COS",
    "DTAN": "FX:TAN",
    # FNC 147: swapping bytes
    "SWAP": "SWAP",
    "DSWAP": "FX:DSWAP",
    # FNC 155 to 159: positioning
    "DABS": "FX:DABS",
    "ZRN": "FX:ZRN",
    "DZRN": "FX:DZRN",
    "PLSV": "FX:PLSV",
    "DPLSV": "FX:DPLSV",
    "DRVI": "FX:DRVI",
    "DDRVI": "FX:DDRVI",
    "DRVA": "FX:DRVA",
    "DDRVA": "FX:DDRVA",
    # FNC 160 to 169: clock
    "TCMP": "FX:TCMP",
    "TZCP": "FX:TZCP",
    "TADD": "FX:TADD",
    "TSUB": "FX:TSUB",
    "TRD": "FX:TRD",
    "TWR": "FX:TWR",
    "HOUR": "FX:HOUR",
    "DHOUR": "FX:DHOUR",
    # FNC 170 and 171: Gray code
    "GRY": "GRY",
    "DGRY": "DGRY",
    "GBIN": "GBIN",
    "DGBIN": "DGBIN",
    # FNC 224 to 246: compare contacts
    **{name: name for name in sorted(_COMPARISONS)},
}  # fmt: skip

# What H1U lacks, by the 16-bit name where there is one.
_H2U_ONLY = frozenset(
    "SMOV CML FMOV XCH NEG ROR ROL RCR RCL WSFR WSFL SUM BON MEAN ANS ANR SQR FLT REFF HSZ SER TTMR STMR ROTC SORT TKY HKY SEGD ARWS ASC PR "
    "ECMP EZCP EBCD EBIN EADD ESUB EMUL EDIV ESQR INT SIN COS TAN SWAP GRY GBIN".split()
)
H1U: dict[str, str | By] = {
    name: key for name, key in H2U.items() if name not in _H2U_ONLY and (name[:1] != "D" or name[1:] not in _H2U_ONLY)
}

# The function numbers, ten in a row of the manual; a dot stands for a number without an instruction.
_NUMBERS = {
    0: "CJ CALL SRET IRET EI DI FEND WDT FOR NEXT",
    10: "CMP ZCP MOV SMOV CML BMOV FMOV XCH BCD BIN",
    20: "ADD SUB MUL DIV INC DEC WAND WOR WXOR NEG",
    30: "ROR ROL RCR RCL SFTR SFTL WSFR WSFL SFWR SFRD",
    40: "ZRST DECO ENCO SUM BON MEAN ANS ANR SQR FLT",
    50: "REF REFF MTR HSCS HSCR HSZ SPD PLSY PWM PLSR",
    60: "IST SER ABSD INCD TTMR STMR ALT RAMP ROTC SORT",
    70: "TKY HKY DSW SEGD SEGL ARWS ASC PR FROM TO",
    80: "RS PRUN ASCI HEX CCD VRRD VRSC . PID",
    110: "ECMP EZCP . . . . . . EBCD EBIN",
    120: "EADD ESUB EMUL EDIV . . . ESQR . INT",
    130: "SIN COS TAN",
    147: "SWAP",
    155: "ABS ZRN PLSV DRVI DRVA",
    160: "TCMP TZCP TADD TSUB . . TRD TWR . HOUR",
    170: "GRY GBIN",
    224: "LD= LD> LD< . LD<> LD<= LD>=",
    232: "AND= AND> AND< . AND<> AND<= AND>=",
    240: "OR= OR> OR< . OR<> OR<= OR>=",
}
_FUNCTIONS = {name: first + place for first, row in _NUMBERS.items() for place, name in enumerate(row.split()) if name != "."}
_WIDE = {"DAND": "WAND", "DOR": "WOR", "DXOR": "WXOR"}  # 32-bit forms that are not D and the name
# What is not in the manual by name, but in every list of the family's instructions.
REFERENCE = frozenset(
    [
        *"NEXT CMP CML BMOV ADD MUL DIV DEC WAND NEG CCD VRRD VRSC".split(),
        *(
            f"{join}{relation}"
            for join in ("LD", "AND", "OR")
            for relation in ("=", ">", "<", "<>", "<=", ">=")
            if join + relation != "OR>="
        ),
    ]
)

# Where what an instruction does is known from; most of what is in neither is general knowledge of the family.
STATED = frozenset("LD LDP LDF ANB ORB MPS OUT RST MC P I STL RET CJ IRET EI FEND WDT MOV ZRST HSCS IST FROM RS".split())
LOOKED_UP = frozenset("MC CJ BCD ADD SUB DIV ROR ROL RCR RCL ENCO ASCI HEX EADD ESUB EMUL EDIV".split())
ALL_KNOWN = frozenset(  # nothing of these is general knowledge
    "LD LDF ANB ORB P I STL RET CJ IRET EI FEND WDT MOV BCD ADD SUB ZRST ENCO HSCS IST FROM ASCI HEX EADD ESUB EMUL EDIV".split()
)


def plain(name: str) -> str:
    """The name of an instruction by which the manual lists it: of a 32-bit form that of the 16-bit one."""
    if name in _FUNCTIONS:
        return name
    narrow = next((join + name[len(join) + 1 :] for join in ("LD", "AND", "OR") if name.startswith(f"{join}D")), name.removeprefix("D"))
    return _WIDE.get(name) or (narrow if narrow in _FUNCTIONS else name)


def _section(name: str) -> str:
    number = _FUNCTIONS.get(plain(name))
    if number is not None:
        return f"FNC {number:02d}"
    return {"STL": "4.1.1", "RET": "4.1.1", "P": "3.8", "I": "3.8"}.get(name, "4.1")


FUNCTIONS = {name: _section(name) for name in H2U}  # where the manual has each instruction
# What EC's manual has in a section -> where this one has it.
SECTIONS = {
    "1.1": "1", "3.1": "3", "3.2": "3.7", "3.2.1": "3", "3.3": "3.3", "4.1": "1.1", "4.4": "FNC 01", "5.1": "4.1", "5.2": "4.1",
    "5.3": "4.1.1", "5.4": "3.5", "5.5": "3.6", "6.1.1": "FNC 08", "6.1.3": "3.8", "6.1.4": "FNC 00", "6.1.5": "FNC 06",
    "6.1.9": "FNC 03", "6.1.11": "FNC 01", "6.1.12": "FNC 02", "7": "4.1.1", "8": "3.6", "9": "3.8",
}  # fmt: skip

# Words of EC and of other families -> what is written here.
FOREIGN = {
    **dict.fromkeys(("TON", "TMR"), "write OUT T0 K100: the number tells time unit and kind, T0 to T245 without flow begin anew"),
    "TONR": "write OUT T250 K100: T246 to T255 keep their value",
    "TOF": "write OUT with a timer behind the inverted condition",
    "TMON": "write a latch with OUT and a timer",
    **dict.fromkeys(("CTU", "CNT"), "write OUT C0 K10"),
    "CTR": "write OUT C0 K10 and RST C0",
    "DCNT": "write OUT C200 K10; M8200 ON counts down",
    "HCNT": "write OUT C235 K10",
    "EU": "write LDP, ANDP or ORP instead of the contact before, or PLS",
    "ED": "write LDF, ANDF or ORF instead of the contact before, or PLF",
    "LBL": "write the label alone on its line: P1",
    **dict.fromkeys(("CSRET", "CIRET", "CFEND"), "write CJ to a label before SRET, IRET or FEND"),
    "RMOV": "write DMOV",
    **{
        there: f"write {here}"
        for there, here in (
            ("SQT", "SQR"), ("DSQT", "DSQR"), ("SEG", "SEGD"), ("BITS", "SUM"), ("DBITS", "DSUM"), ("ITA", "ASCI"), ("ATI", "HEX"),
            ("PUSH", "SFWR"), ("FIFO", "SFRD"), ("XMT", "RS"), ("RCV", "RS"), ("DHSCI", "DHSCS to I010"),
        )
    },
}  # fmt: skip
FOREIGN |= {
    f"R{name}": f"write DE{there}" for name, there in (("ADD", "ADD"), ("SUB", "SUB"), ("MUL", "MUL"), ("DIV", "DIV"), ("SQT", "SQR"))
}
