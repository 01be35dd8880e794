"""6.1: program flow."""

from .define import command, emitted


@emitted("FOR", "S:INT", steps=3, section="6.1.1")
def for_(code, count):
    """Execute what follows, up to NEXT, S times; not at all while the flow is OFF or S is 0 or less."""
    code.repeat(count)


@emitted("NEXT", "", steps=1, section="6.1.2", bus=True)
def next_(code):
    """End a FOR."""
    code.close()


@emitted("LBL", "S:LABEL", steps=3, section="6.1.3", bus=True)
def lbl(code, label):
    """Mark the place that CJ jumps to; as a pointer (P) behind FEND it begins a subroutine."""
    code.label(label.value)


@emitted("CJ", "S:LABEL", steps=3, section="6.1.4", pulsed=True)
def cj(code, label):
    """Jump to the label S while the flow is ON."""
    code.jump(label.value)


@emitted("CFEND", "", steps=1, section="6.1.5")
def cfend(code):
    """Leave the main program for this scan while the flow is ON."""
    code.leave()


@command("WDT", "", steps=1, section="6.1.6")
def wdt(machine):
    """Start the watchdog's time again."""
    machine.watchdog_reset()


@command("EI", "", steps=1, section="6.1.7", pulsed=False)
def ei(machine):
    """Let events ask for their interrupt programs."""
    machine.interrupts.enabled = True


@command("DI", "", steps=1, section="6.1.8", pulsed=False)
def di(machine):
    """Let no event ask for its interrupt program; what is waiting already is still served."""
    machine.interrupts.enabled = False


@emitted("CIRET", "", steps=1, section="6.1.9")
def ciret(code):
    """Leave the interrupt program while the flow is ON."""
    code.leave()


@emitted("STOP", "", steps=1, section="6.1.10")
def stop(code):
    """Put the PLC into STOP at once while the flow is ON."""
    code.halt()


@emitted("CALL", "S:ROUTINE", steps=None, section="6.1.11", pulsed=True)
def call(code, routine, *arguments):
    """Execute a subroutine, with values for its variables where it has some, while the flow is ON."""
    code.call(routine.text, arguments)


@emitted("CSRET", "", steps=1, section="6.1.12")
def csret(code):
    """Leave the subroutine while the flow is ON."""
    code.leave()
