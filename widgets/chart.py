"""The sequential function chart: active steps, what each waits for in words, and the steps taken.

Of a large chart the page gets the place of every step, and the drawings and values of the bands of the sheet that it looks at. It
keeps the drawings of those that it has looked at lately, so that going to and fro sends each of them once.
"""

from __future__ import annotations

from math import ceil, floor

from ecsim.devices import Device
from ecsim.errors import EcsimError
from ecsim.views.flows import Transition
from ecsim.views.sfc import chart

from .history import Change
from .panel import Part
from .rig import PREFIX, Rig
from .waiting import phrases, recorded, sentence

LOG_LENGTH = 8
NARROWEST, WIDEST = 300, 1400
LIVE, KEPT = 16, 60  # of the bands that were looked at lately: so many have their values, so many their drawings in the page
FIRST = 6  # bands of a chart of more than `LIVE` that are there before a page has said what it looks at
MOST_LOOKS, MOST_BANDS = 4, 40  # views at a time, and what one of them may look at


class Chart(Part):
    """The chart as a drawing, laid out for the page's width; `<step>.now` says of an active step what it does and waits for.

    A frame has an entry "band.<n>" for the drawing of each band that was looked at lately; "live" tells which of them have their
    values in the frame, "looked" which are looked at now.
    """

    key = "chart"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self.drawing = chart(rig.program)
        self.labels = self.drawing.labels
        self.transitions: dict[str, list[Transition]] = {}
        self.outputs: dict[str, list[str]] = {}
        for step in self.drawing.steps:
            for device in map(str, step.devices):
                self.transitions.setdefault(device, []).extend(step.transitions)
                shown = self.outputs.setdefault(device, [])
                targets = [action.word.operands[0] for action in step.actions if action.word.operands]
                shown += [str(target) for target in targets if self._is_bit(target) and str(target) not in shown]
        self._looks: dict[str, range] = {"": range(FIRST)}  # view -> the bands that it looks at
        self._lay_out(320)
        self._logged: Change | None = None
        self._log: list[list] = []

    def _is_bit(self, operand: object) -> bool:
        return isinstance(operand, Device) and operand.index is None and self.rig.plc.model.areas[operand.area].kind != "word"

    def _lay_out(self, width: int) -> None:
        self.width, self.sheet = width, self.drawing.sheet(width)
        self._bands: dict[int, str] = {}
        bands = self.sheet.bands
        self._kept = dict.fromkeys(range(len(bands)) if len(bands) <= LIVE else ())  # those that were looked at, the latest last
        self._places = {
            "svg": self.sheet.shell(),
            "bands": [[floor(band.top), ceil(band.bottom)] for band in bands],
            "steps": self.sheet.boxes(),
        }

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
        rig = self.rig
        active = [device for device in rig.active() if device in self.outputs]
        met = recorded(rig.plc.trace)
        looked = {number for numbers in self._looks.values() for number in numbers if number < len(self.sheet.bands)}
        live = looked.union(list(self._kept)[-LIVE:])
        entries = {"sheet": self._places, "live": sorted(live), "looked": sorted(looked)}
        for number in (*self._kept, *live):
            if number not in self._bands:
                self._bands[number] = self.sheet.band(number, PREFIX)
            entries[f"band.{number}"] = self._bands[number]
        entries |= self.sheet.live.state(rig.session, live)
        entries |= {"active": active, "log": self._steps_taken(), "held": int(rig.session.transitions_held)}
        entries["breaks"] = {point.text: int(point.enabled) for point in rig.session.breakpoints if point.text in self.outputs}
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
        if width != self.width:
            self._lay_out(width)

    def on_see(self, view, first, last):
        """A view looks at the bands from `first` to `last`, counted from 0."""
        first = min(max(int(first), 0), len(self.sheet.bands))
        looks = {name: numbers for name, numbers in self._looks.items() if name not in ("", view)}
        while len(looks) >= MOST_LOOKS:  # a page that went away leaves its own behind
            del looks[next(iter(looks))]
        now = range(first, min(int(last) + 1, len(self.sheet.bands), first + MOST_BANDS))
        self._looks = looks | {view: now}
        kept = [*(number for number in self._kept if number not in now), *now]
        self._kept = dict.fromkeys(kept[-KEPT:])

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
