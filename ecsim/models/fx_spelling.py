"""How H2U and H1U write their instructions: the name in a program -> TABLE's key, in the order of the function numbers.

An instruction that means the same as one of EC is that row of TABLE under its own name; one that differs, or that EC
does not have, has a row of its own, whose key begins with "FX:". The 32-bit forms stand beside the 16-bit ones.
"""

from .model import By

_COMPARISONS = {
    f"{join}{wide}{relation}" for join in ("LD", "AND", "OR") for wide in ("", "D") for relation in ("=", ">", "<", "<>", "<=", ">=")
}

ALL = (0, 0xFFFF)


def _into(word: str, bits: str) -> By:
    """A choice by the second operand: a word, or a run of bits."""
    return By(word, *((area, *ALL, bits) for area in "YMS"))


H2U: dict[str, str | By] = {
    # basic instructions
    **{name: name for name in "LD LDI AND ANI OR ORI ANB ORB MPS MRD MPP INV NOP STL RET SET RST MC MCR".split()},
    "OUT": By("OUT", ("T", 0, 245, "TON"), ("T", 246, 255, "TONR"), ("C", 0, 199, "CTU"), ("C", 200, 234, "DCNT"), ("C", 235, 255, "HCNT")),
    # FNC 00 to 09: program flow
    "CJ": "CJ",
    "CALL": "CALL",
    "EI": "EI",
    "DI": "DI",
    "WDT": "WDT",
    "FOR": "FOR",
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
    "MTR": "FX:MTR",
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
