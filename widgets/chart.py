"""The sequential function chart: active steps, what each waits for in words, and the steps taken."""

from __future__ import annotations

from ecsim.devices import Device
from ecsim.errors import EcsimError
from ecsim.views.flows import Transition
from ecsim.views.sfc import Chart as Drawing
from ecsim.views.sfc import chart

from .history import Change
from .panel import Part
from .rig import PREFIX, Rig
from .waiting import phrases, recorded, sentence

LOG_LENGTH = 8
NARROWEST, WIDEST = 300, 1400
MOST_LOOKS = 4  # views at a time


class Chart(Part):
    """The chart as a drawing, laid out for the page's width; `<step>.now` says of an active step what it does and waits for."""

    key = "chart"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self._drawn = self._draw(320)
        drawing = self._drawn[1]
        self.labels = drawing.labels
        self.transitions: dict[str, list[Transition]] = {}
        self.outputs: dict[str, list[str]] = {}
        for step in drawing.steps:
            for device in map(str, step.devices):
                self.transitions.setdefault(device, []).extend(step.transitions)
                shown = self.outputs.setdefault(device, [])
                targets = [action.word.operands[0] for action in step.actions if action.word.operands]
                shown += [str(target) for target in targets if self._is_bit(target) and str(target) not in shown]
        self._looks: dict[str, tuple[float, float]] = {}  # view -> from where to where it looks, in px
        self._state: dict[str, str] = {}
        self._logged: Change | None = None
        self._log: list[list] = []

    def _is_bit(self, operand: object) -> bool:
        return isinstance(operand, Device) and operand.index is None and self.rig.plc.model.areas[operand.area].kind != "word"

    def _draw(self, width: int) -> tuple[int, Drawing, str]:
        drawing = chart(self.rig.program)
        return width, drawing, drawing.svg(PREFIX, width)

    def layout(self):
        return {
            "steps": {
                device: {
                    "name": self.rig.step_name(device),
                    "outputs": [[self.rig.name(output), output] for output in outputs],
                    "ways": [[str(step) for step in transition.steps] for transition in self.transitions[device]],
                    "then": list(dict.fromkeys(str(step) for transition in self.transitions[device] for step in transition.steps)),
                }
                for device, outputs in self.outputs.items()
            }
        }

    def frame(self):
        rig, (_, drawing, svg) = self.rig, self._drawn
        active = [device for device in rig.active() if device in self.outputs]
        met = recorded(rig.plc.trace)
        entries = {"svg": svg, "active": active, "log": self._steps_taken(), "held": int(rig.session.transitions_held)}
        entries["breaks"] = {point.text: int(point.enabled) for point in rig.session.breakpoints if point.text in self.outputs}
        # What nobody looks at keeps its entries as they were.
        self._state |= drawing.state(rig.session, tuple(self._looks.values()) if self._state and self._looks else None)
        entries.update(self._state)
        for device in active:
            elapsed_us, scans = rig.since(device)
            entries[f"{device}.now"] = {
                "elapsed_us": elapsed_us,
                "scans": scans,
                "outputs": [[rig.name(output), output, rig.bit(output)] for output in self.outputs[device]],
                "waits": [phrases(transition, self.labels, met) for transition in self.transitions[device]],
            }
        entries.update((f"{device}.usual", [round(mean_us), count]) for device, (mean_us, count) in rig.times.usual.items())
        return entries

    def on_fit(self, width):
        """Lay the chart out anew for a width in px."""
        width = min(max(int(width), NARROWEST), WIDEST)
        if width != self._drawn[0]:
            self._drawn = self._draw(width)
            self._state = {}

    def on_see(self, view, top, bottom):
        """A view looks at what begins between two heights of the drawing, in px."""
        looks = {name: heights for name, heights in self._looks.items() if name != view}
        while len(looks) >= MOST_LOOKS:  # a page that went away leaves its own behind
            del looks[next(iter(looks))]
        self._looks = looks | {view: (float(top), float(bottom))}

    def on_unsee(self, view):
        """A view is no more."""
        self._looks.pop(view, None)

    def _step(self, device: str) -> str:
        if device not in self.outputs:
            raise EcsimError(f"the chart has no step {device!r}")
        return device

    def on_break(self, step):
        """Set a breakpoint on a step, or take it away."""
        points = self.rig.session.breakpoints
        points.remove(step) if step in points else points.add(self._step(step))

    def on_hold(self, on):
        """Hold all transitions, or let them go."""
        self.rig.session.transitions_held = bool(on)

    def on_fire(self, step, to=None):
        """Take a transition out of an active step; `to` says which where there is a choice."""
        self.rig.call(lambda: self.rig.session.fire(self._step(step), to))

    def on_step(self, step, on):
        """Begin a step or end it by hand."""
        self.rig.call(lambda: self.rig.session.set_step(self._step(step), bool(on)))

    def _steps_taken(self) -> list[list]:
        changes = self.rig.times.changes
        newest = changes[0] if changes else None
        if newest is not self._logged:
            self._logged = newest
            self._log = [
                [change.time_us, " ".join(change.left), " ".join(change.entered), self._why(change)] for change in changes[:LOG_LENGTH]
            ]
        return self._log

    def _why(self, change: Change) -> str:
        for device in change.left:
            for transition in self.transitions.get(device, ()):
                if {str(step) for step in transition.steps} & set(change.entered):
                    return sentence(transition, self.labels)
        return ""
