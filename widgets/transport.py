"""Run control: run or pause, one scan, next step, back, reset, the speed, the machine's connection."""

from .panel import Part


class Transport(Part):
    """The row of keys, the clock and the speed. What it shows is the state of the run, which every panel gets."""

    key = "transport"

    def layout(self):
        return {"watchdog_ms": self.rig.watchdog_ms, "plant": self.rig.terminals is not None}

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
