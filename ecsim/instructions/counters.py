"""5.5: counters. They count the flow's changes from OFF to ON."""

from .define import always


@always("CTU", "D:COUNTER S:INT", steps=5, section="5.5.1")
def ctu(flow, counter, preset, state):
    """Count up to 32767; contact ON from the preset."""
    if flow:
        if not state.was:
            state.was = True
            if counter.value < 32767:
                counter.value += 1
    elif state.was:
        state.was = False
    if counter.value >= preset:
        counter.contact = True
    else:
        counter.contact = False


@always("CTR", "D:COUNTER S:INT", steps=5, section="5.5.2")
def ctr(flow, counter, preset, state):
    """Count up to the preset, contact ON there; the next one begins again at 1."""
    if flow:
        if not state.was:
            state.was = True
            if preset > 0:
                if counter.value >= preset:
                    counter.value = 1
                    counter.contact = False
                else:
                    counter.value += 1
                    counter.contact = counter.value == preset
    else:
        state.was = False


@always("DCNT", "D:DCOUNTER S:DINT+T+Z", steps=7, section="5.5.3")
def dcnt(flow, counter, preset, state):
    """Count up, or down while the counter's direction relay is ON; contact ON on reaching the preset upward, OFF downward."""
    if flow:
        if not state.was:
            state.was = True
            if counter.down:
                counter.value = counter.value - 1 if counter.value > -2147483648 else 2147483647
                if counter.value <= preset:
                    counter.contact = False
            else:
                counter.value = counter.value + 1 if counter.value < 2147483647 else -2147483648
                if counter.value >= preset:
                    counter.contact = True
    else:
        state.was = False
