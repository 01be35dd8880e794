"""FNC 00 to 09: program flow of the FX family where it is not that of EC."""

from .define import FX, emitted


@emitted("FX:CJ END", "S:LABEL", steps=3, section="FNC 00", models=FX, pulsed=True)
def jump_to_the_end(code, label):
    """Jump to the end of the program while the flow is ON."""
    code.leave()


@emitted("FX:I", "S:EVENT", steps=1, section="3.8", models=FX, bus=True)
def i(code, event):
    """Begin the interrupt program of an event."""


@emitted("FX:SRET", "", steps=1, section="FNC 02", models=FX, bus=True)
def sret(code):
    """End a subroutine."""


@emitted("FX:IRET", "", steps=1, section="FNC 03", models=FX, bus=True)
def iret(code):
    """End an interrupt program."""


@emitted("FX:FEND", "", steps=1, section="FNC 06", models=FX, bus=True)
def fend(code):
    """End the main program, or a part of it that a jump leads to; subroutines and interrupt programs follow."""
    code.leave()


@emitted("FX:END", "", steps=1, section="4.1", models=FX, bus=True)
def end(code):
    """End the program text."""


@emitted("FX:FOR", "S:INT", steps=3, section="FNC 08", models=FX, bus=True)
def for_(code, count):
    """Execute what follows, up to NEXT, S times; once where S is below 1."""
    code.repeat(count, least=1)
