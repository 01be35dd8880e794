"""5.4: timers. A timer's value counts whole time units; `due` is the moment of its next one, 0 while it does not run."""

from .define import always


@always("TON", "D:TIMER S:INT", steps=5, section="5.4.1", cleared=True)
def ton(flow, timer, preset):
    """On-delay: counts while the flow is ON, contact ON from the preset; flow OFF clears both."""
    if flow:
        if timer.now >= timer.due:
            timer.begin()
        if timer.value >= preset:
            timer.contact = True
        else:
            timer.contact = False
        timer.watch(preset, None)
    else:
        timer.contact = False
        timer.value = timer.due = 0


@always("TONR", "D:TIMER S:INT", steps=5, section="5.4.2")
def tonr(flow, timer, preset):
    """Retentive on-delay: counts while the flow is ON; flow OFF keeps value and contact, RST clears them."""
    if flow:
        if timer.now >= timer.due:
            timer.resume()
        timer.rest = timer.base - timer.due + timer.now
        timer.contact = timer.value >= preset
        timer.watch(preset, None)
    else:
        timer.due = 0


@always("TOF", "D:TIMER S:INT", steps=5, section="5.4.3", cleared=True)
def tof(flow, timer, preset):
    """Off-delay: contact ON with the flow; after the flow has gone OFF it stays ON for the preset."""
    if flow:
        timer.value = timer.due = 0
        timer.contact = True
    elif timer.contact:
        if timer.now >= timer.due:
            timer.tick()
        if timer.value >= preset:
            timer.value = preset
            timer.contact = False
            timer.due = 0
        else:
            timer.watch(preset, preset)


@always("TMON", "D:TIMER S:INT", steps=5, section="5.4.4")
def tmon(flow, timer, preset, state):
    """Monostable: a rising flow turns the contact ON for the preset; it cannot be started again meanwhile."""
    if flow and not state.was and not timer.contact:
        timer.contact = True
        timer.due = 0
    state.was = flow
    if timer.contact:
        if timer.now >= timer.due:
            timer.tick()
        if timer.value >= preset:
            timer.contact = False
            timer.value = timer.due = 0
        else:
            timer.watch(preset, 0)
