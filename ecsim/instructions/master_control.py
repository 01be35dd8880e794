"""5.2: master control."""

from .define import emitted


@emitted("MC", "S:NEST", steps=3, section="5.2.1")
def mc(code, nest):
    """Open a structure that is skipped, its coils and timers cleared, while the flow before it is OFF."""
    code.guard()


@emitted("MCR", "S:NEST", steps=1, section="5.2.2", bus=True)
def mcr(code, nest):
    """End the structure of the same number."""
    code.close()
