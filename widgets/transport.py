"""Run control: run or pause, one scan, next step, back, reset, the speed, the history, breakpoints, the machine's connection."""

from ecsim.errors import EcsimError

from .panel import Part


class Transport(Part):
    """The row of keys, the clock, the speed and the bar of the past. The state of the run itself is told to every panel."""

    key = "transport"

    def __init__(self, rig):
        super().__init__(rig)
        self._problem = ""  # why the last breakpoint that was written could not be set
        self._events_of: tuple = ()
        self._events: list[list] = []

    def layout(self):
        return {"watchdog_ms": self.rig.watchdog_ms, "plant": self.rig.session.plant is not None}

    def frame(self):
        session = self.rig.session
        return {
            "first": session.history.first if session.history.first is not None else self.rig.plc.scans,
            "events": self._marks(),
            "breaks": [[point.text, int(point.enabled), point.hits, point.problem] for point in session.breakpoints],
            "problem": self._problem,
        }

    def _marks(self) -> list[list]:
        """What the bar of the past shows: [scan, "step" or "breakpoint" or "fault", words], in order of the scans."""
        session = self.rig.session
        log, marks = session.tip.log, session.marks
        now = len(log), log[-1] if log else None, len(marks), marks[-1] if marks else None
        if now != self._events_of:
            self._events_of = now
            began: dict[int, list[str]] = {}
            for change in log:
                if change.active:
                    began.setdefault(change.scan, []).append(change.step)
            events = [[scan, "step", " ".join(steps)] for scan, steps in began.items()]
            self._events = sorted(events + [[mark.scan, mark.kind, mark.words] for mark in marks])
        first = session.history.first or 0
        return [event for event in self._events if event[0] >= first]

    def on_run(self):
        self.rig.call(self.rig.session.run)

    def on_pause(self):
        self.rig.session.pause()

    def on_scan(self):
        self.rig.session.scan()

    def on_next_step(self):
        self.rig.session.next_step()

    def on_back(self):
        self.rig.session.back()

    def on_reset(self):
        self.rig.session.reset()

    def on_speed(self, value):
        """`value` times real time; None is as fast as possible."""
        self.rig.session.speed = value

    def on_plant(self, on):
        """Connect the machine to the terminals, or leave them to the hand."""
        self.rig.connect(bool(on))

    def on_seek(self, scan):
        """Show the moment before a scan, as near as the past reaches."""
        session = self.rig.session
        first = session.history.first
        if first is not None:
            session.seek(min(max(int(scan), first), session.tip.scan))

    def on_break_add(self, text):
        """Set a breakpoint; what cannot be read is refused in words."""
        try:
            self.rig.session.breakpoints.add(text)
            self._problem = ""
        except EcsimError as error:
            self._problem = str(error)

    def on_break_remove(self, text):
        """Take a breakpoint away."""
        self.rig.call(lambda: self.rig.session.breakpoints.remove(text))

    def on_break_enable(self, text, on):
        """Switch a breakpoint on or off."""
        self.rig.call(lambda: self.rig.session.breakpoints.enable(text, bool(on)))
