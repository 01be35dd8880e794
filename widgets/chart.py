"""The sequential function chart: active steps, what each waits for in words, and the steps taken."""

from __future__ import annotations

from ecsim.views.sfc import chart

from .conditions import Contact, phrases, sections, sentence
from .panel import Part
from .rig import PREFIX, Rig

LOG_LENGTH = 8


class Chart(Part):
    """The chart as a drawing; `<step>.now` says of an active step what it does and waits for."""

    key = "chart"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self.drawing = chart(rig.program)
        self.svg = self.drawing.svg(PREFIX)
        self.sections = sections(rig.program)
        self._logged: tuple[int, int] = (-1, -1)
        self._log: list[list] = []

    def layout(self):
        steps = {
            device: {"name": self.rig.step_name(device), "outputs": self._outputs(device), "then": self.sections[device].targets}
            for device in self.rig.charted
        }
        return {"svg": self.svg, "steps": steps}

    def frame(self):
        rig = self.rig
        active = rig.active()
        entries = {"active": active, "log": self._steps_taken(), **self.drawing.state(rig.plc)}
        for device in active:
            elapsed_us, scans = rig.since(device)
            entries[f"{device}.now"] = {
                "elapsed_us": elapsed_us,
                "scans": scans,
                "outputs": [[name, output, rig.bit(output)] for name, output in self._outputs(device)],
                "waits": [phrases(transition, rig.name, self._met) for transition in self.sections[device].transitions],
            }
        entries.update((f"{device}.usual", [round(mean_us), count]) for device, (mean_us, count) in rig.times.usual.items())
        return entries

    def _outputs(self, device: str) -> list[list[str]]:
        return [[self.rig.name(output), output] for output in self.sections[device].actions]

    def _met(self, contact: Contact) -> bool:
        trace = self.rig.plc.trace
        if trace is None:
            return False
        return bool(trace.closed[contact.position] if contact.edge is None else trace.flow[contact.edge])

    def _steps_taken(self) -> list[list]:
        changes = self.rig.times.changes
        key = len(changes), changes[0].time_us if changes else -1
        if key != self._logged:
            self._logged = key
            self._log = [
                [change.time_us, " ".join(change.left), " ".join(change.entered) or "none", self._why(change)]
                for change in changes[:LOG_LENGTH]
            ]
        return self._log

    def _why(self, change) -> str:
        for step in change.left:
            for transition in self.sections[step].transitions if step in self.sections else ():
                if set(transition.targets) & set(change.entered):
                    return sentence(phrases(transition, self.rig.name))
        return ""
