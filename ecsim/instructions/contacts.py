"""5.1: contacts, coils and the logic of a rung."""

from .define import always, contact, emitted

for _join, _open, _closed, _at in (("LD", "LD", "LDI", 1), ("AND", "AND", "ANI", 3), ("OR", "OR", "ORI", 5)):

    @contact(_open, "S:BOOL", join=_join, steps=1, section=f"5.1.{_at}")
    def normally_open(s):
        """A contact that is closed while its device is ON."""
        return s

    @contact(_closed, "S:BOOL", join=_join, steps=1, section=f"5.1.{_at + 1}")
    def normally_closed(s):
        """A contact that is closed while its device is OFF."""
        return not s


@emitted("OUT", "-> D:BOOL+SM", steps=1, section="5.1.7", cleared=True, transition_steps=3)
def out(code, d):
    """A coil: takes the state of the flow in every scan; in a step, `OUT S` is the jump to another step (5.3.3)."""
    if code.in_step and d.area == "S":
        code.transfer(d)
    else:
        code.assign(d)


@emitted("ANB", "", steps=1, section="5.1.8")
def anb(code):
    """Two blocks in series."""
    code.combine("and")


@emitted("ORB", "", steps=1, section="5.1.9")
def orb(code):
    """Two blocks in parallel."""
    code.combine("or")


@emitted("MPS", "", steps=1, section="5.1.10")
def mps(code):
    """Keep the flow for the output branches that follow."""
    code.push()


@emitted("MRD", "", steps=1, section="5.1.11")
def mrd(code):
    """Go on from the flow kept last; it stays kept."""
    code.read()


@emitted("MPP", "", steps=1, section="5.1.12")
def mpp(code):
    """Go on from the flow kept last; it is kept no longer."""
    code.pop()


@always("EU", "", steps=2, section="5.1.13")
def eu(flow, state):
    """ON for one scan when the flow turns from OFF to ON."""
    rises = flow and not state.was
    state.was = flow
    return rises


@always("ED", "", steps=2, section="5.1.14")
def ed(flow, state):
    """ON for one scan when the flow turns from ON to OFF."""
    falls = state.was and not flow
    state.was = flow
    return falls


@always("INV", "", steps=1, section="5.1.15")
def inv(flow):
    """Turn the flow round."""
    return not flow


@emitted("SET", "-> D:BOOL+SM", steps=1, section="5.1.16", transition_steps=3)
def set_(code, d):
    """Turn a bit ON while the flow is ON, and leave it so; in a step, `SET S` is the transition to the next step (5.3.2)."""
    if code.in_step and d.area == "S":
        code.transfer(d)
    else:
        code.turn(d, on=True)


@emitted("RST", "-> D:BOOL+SM", steps=1, section="5.1.17", resets=True, transition_steps=3)
def rst(code, d):
    """Turn a bit OFF while the flow is ON; of a timer or counter the value is cleared too."""
    code.turn(d, on=False)


@emitted("NOP", "", steps=1, section="5.1.18")
def nop(code):
    """Do nothing."""
