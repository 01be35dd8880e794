"""The grader's report in a notebook, with a button at each broken rule that replays the machine up to that moment."""

from __future__ import annotations

from typing import Any

import ipywidgets

from ecsim.grading import Report, Verdict

from .lab import Lab


class ReportPanel(ipywidgets.VBox):
    """A report and its replay buttons; a click opens a lab, paused shortly before the failure.

    `seconds` is how long before the failure the lab stands. `lab` is the one opened last, None before.
    """

    def __init__(self, report: Report, seconds: float = 2.0):
        self.report, self.seconds = report, seconds
        self.lab: Lab | None = None
        self.place = ipywidgets.VBox()
        self.buttons = [self._button(verdict) for verdict in report.failed]
        super().__init__([ipywidgets.HTML(report._repr_html_()), *self.buttons, self.place])
        self.add_class("ec-report")

    def _button(self, verdict: Verdict) -> ipywidgets.Button:
        words = f"Replay from {self.seconds:g} s before: {verdict.words}"
        button = ipywidgets.Button(description=words, tooltip=words, icon="history", layout={"width": "auto"})
        button.on_click(lambda _: self.replay(verdict.rule))
        return button

    def replay(self, rule: str) -> Any:
        """Open the lab shortly before a rule broke; gives the lab. The one opened before is closed."""
        replay = self.report.replay(rule, self.seconds)
        if self.lab is not None:
            self.lab.close()
        self.lab = Lab(replay.plc, plant=replay.plant, picture=replay.picture, name="replay", autostart=False, title=self.report.title)
        self.place.children = [self.lab]
        return self.lab
