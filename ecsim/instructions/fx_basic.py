"""4.1: basic instructions of the FX family that EC does not have, or not so: edges, coils of timers and counters, master control."""

from ..errors import OPERAND
from .contacts import set_
from .define import FX, always, command, contact, emitted, value
from .highspeed import counter_inputs, hcnt

for _join in ("LD", "AND", "OR"):

    @contact(f"FX:{_join}P", "S:BOOL state -> state", join=_join, steps=2, section="4.1", models=FX)
    def rising(s, state):
        """A contact that is closed for one scan when its device turns ON."""
        return s and not state, s

    @contact(f"FX:{_join}F", "S:BOOL state -> state", join=_join, steps=2, section="4.1", models=FX)
    def falling(s, state):
        """A contact that is closed for one scan when its device turns OFF."""
        return state and not s, s


@emitted("FX:PLS", "state -> D:BOOL[Y M]", steps=2, section="4.1", models=FX, cleared=True)
def pls(code, d):
    """A coil that is ON for one scan when the flow turns ON."""
    code.pulse(d, rising=True)


@emitted("FX:PLF", "state -> D:BOOL[Y M]", steps=2, section="4.1", models=FX, cleared=True)
def plf(code, d):
    """A coil that is ON for one scan when the flow turns OFF."""
    code.pulse(d, rising=False)


emitted("FX:SET", "-> D:BOOL[Y M S]", steps=1, section="4.1", models=FX)(set_)


@value("FX:RST D", "-> D:INT[D V Z]!", steps=3, section="4.1", models=FX, pulsed=False)
def clear():
    """Set a register to 0 while the flow is ON."""
    return 0


def _preset(device, preset):
    if isinstance(preset, int) and not 0 <= preset <= 32767:
        return f"the preset {preset} is out of range: a preset goes from 1 to 32767"
    return None


@always("FX:OUT T", "D:TIMER S:INT[const]!", steps=3, section="3.5", models=FX, cleared=True, check=_preset)
def timer_coil(flow, timer, preset):
    """On-delay: counts while the flow is ON, contact ON at the preset, where it stops; flow OFF clears both."""
    if flow:
        if timer.now >= timer.due:
            timer.begin()
        if timer.value >= preset:
            timer.value = preset
            timer.contact = True
    else:
        timer.contact = False
        timer.value = timer.due = 0


@always("FX:OUT T D", "D:TIMER S:INT[D]! state", steps=3, section="3.5", models=FX, cleared=True)
def timer_coil_with_register(flow, timer, preset, state):
    """The same with the preset in a register, which is read when the timer starts."""
    if flow:
        if not (timer.due and state.was):
            state.was = preset
        if timer.now >= timer.due:
            timer.begin()
        if timer.value >= state.was:
            timer.value = state.was
            timer.contact = True
    else:
        timer.contact = False
        timer.value = timer.due = 0


@always("FX:OUT T246", "D:TIMER S:INT[const]!", steps=3, section="3.5", models=FX, check=_preset)
def retentive_timer_coil(flow, timer, preset):
    """Retentive on-delay: counts while the flow is ON, contact ON at the preset, where it stops; flow OFF keeps both, RST clears them."""
    if flow:
        if timer.now >= timer.due:
            timer.resume()
        timer.rest = timer.base - timer.due + timer.now
        if timer.value >= preset:
            timer.value = preset
            timer.contact = True
        timer.watch(preset, None)
    else:
        timer.due = 0


@always("FX:OUT T246 D", "D:TIMER S:INT[D]! state", steps=3, section="3.5", models=FX)
def retentive_timer_coil_with_register(flow, timer, preset, state):
    """The same with the preset in a register, which is read when the timer starts from 0."""
    if flow:
        if not (state.was and timer.value):
            state.was = preset
        if timer.now >= timer.due:
            timer.resume()
        timer.rest = timer.base - timer.due + timer.now
        if timer.value >= state.was:
            timer.value = state.was
            timer.contact = True
        timer.watch(state.was, None)
    else:
        timer.due = 0


@always("FX:OUT C", "D:COUNTER S:INT[const D]!", steps=3, section="3.6", models=FX, check=_preset)
def counter_coil(flow, counter, preset, state):
    """Count the flow's changes from OFF to ON up to the preset; contact ON there, and no further until RST."""
    if flow:
        if not state.was:
            state.was = True
            if not counter.contact:
                counter.value = counter.value + 1 if counter.value < preset else max(preset, 1)
                counter.contact = counter.value >= preset
    elif state.was:
        state.was = False


@always("FX:OUT C200", "D:DCOUNTER S:DINT[const D]!", steps=5, section="3.6", models=FX)
def double_counter_coil(flow, counter, preset, state):
    """Count up, or down while M8(C) is ON, round and round; contact ON on reaching the preset upward, OFF on leaving it downward."""
    if flow:
        if not state.was:
            state.was = True
            if counter.down:
                if counter.value == preset:
                    counter.contact = False
                counter.value = counter.value - 1 if counter.value > -2147483648 else 2147483647
            else:
                counter.value = counter.value + 1 if counter.value < 2147483647 else -2147483648
                if counter.value == preset:
                    counter.contact = True
    elif state.was:
        state.was = False


command(
    "FX:OUT C235", "claim >D:HCOUNTER S:DINT[const D]!", steps=5, section="3.6", models=FX, released=True,
    faults=(OPERAND,), occupies=counter_inputs,
)(hcnt)  # fmt: skip


@emitted("FX:MC", "N:NEST -> D:BOOL[M]", steps=3, section="4.1", models=FX, cleared=True)
def mc(code, nest, d):
    """Open a structure that is skipped, its coils and timers cleared, while the flow before it is OFF; D is ON with the flow."""
    code.guard(d)


@emitted("FX:MCR", "N:NEST", steps=2, section="4.1", models=FX, bus=True)
def mcr(code, nest):
    """End the structure of that level and those inside it."""
    code.close()
