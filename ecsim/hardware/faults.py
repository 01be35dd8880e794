"""Errors as the machine reports them: SM3 and SD3, SM20 to SM22 and the record SD20 to SD24 (2.4, appendix 6)."""

from ..errors import OPERAND, RANGE
from ..memory import Memory

KINDS = {RANGE: "fault range", OPERAND: "fault operand"}  # errors with a relay of their own

# Code -> what it means, in words (appendix 6).
MEANINGS = {
    40: "the program file is damaged", 41: "the system block is damaged", 42: "the data block is damaged",
    43: "the retained data are lost", 44: "the force table is lost", 45: "the user information file is damaged",
    60: "the program does not compile", 61: "the program took longer than the watchdog allows", 62: "an illegal instruction was met",
    63: "an operand has an illegal kind of device", 64: "the value of an operand is illegal", 65: "the number of an operand's device is out of range",
    66: "the subroutine stack is full", 67: "the interrupt queue is full", 68: "an illegal jump or call", 69: "division by zero",
    70: "a stack is defined wrongly: its size or count is below zero, or the count above the size", 72: "the subroutine or interrupt program does not exist",
    73: "there is no special module with this address", 74: "the special module did not answer", 75: "an immediate refresh failed",
    76: "the clock was given an illegal time", 77: "a parameter of PLSR is illegal", 78: "the special module has no such buffer",
    79: "the servo did not answer in time", 80: "the servo's answer has a wrong checksum",
}  # fmt: skip
STOPPING = frozenset({40, 41, 42, 60, 61, 62, 63})


class Faults:
    """Notes execution errors; the program reads them in special relays and registers."""

    def __init__(self, memory: Memory):
        self.memory = memory
        model = memory.model
        self.bits, self.words = model.special_bits, model.special_words
        self.flag = model.relays["fault"]
        self.kinds = {code: model.relays[kind] for code, kind in KINDS.items() if kind in model.relays}
        self.cleared = [self.flag, *(number for code, number in self.kinds.items() if code == OPERAND)]
        self.record, self.length = model.registers["faults"], model.fault_record

    def note(self, code: int) -> bool:
        """An instruction failed: set the flags, push the record when the code differs from the newest. Gives False, the flow of a failed contact."""
        relays, registers = self.memory.lists[self.bits], self.memory.lists[self.words]
        relays[self.flag] = True
        if code in self.kinds:
            relays[self.kinds[code]] = True
        first = self.record
        if registers[first] != code:
            registers[first : first + self.length] = [code, *registers[first : first + self.length - 1]]
        return False

    def executed(self) -> None:
        """An application instruction was executed correctly: SM20 and SM22 go OFF, the record stays."""
        relays = self.memory.lists[self.bits]
        for number in self.cleared:
            relays[number] = False

    def codes(self) -> list[int]:
        """The record, newest first."""
        return [code for code in self.memory.lists[self.words][self.record : self.record + self.length] if code]
