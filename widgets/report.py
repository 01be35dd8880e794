"""The grader's report in a notebook: buttons at each broken rule replay the machine up to that moment, and a hint after repeated failures."""

from __future__ import annotations

import threading
from collections.abc import Callable
from html import escape
from importlib import resources
from typing import Any

import anywidget
import ipywidgets
import traitlets

from ecsim.errors import EcsimError
from ecsim.grading import Report, Verdict
from ecsim.grading.page import panel

from .lab import Lab

TRIES = 2  # reports on failing programs before there are hints


class Sheet(anywidget.AnyWidget):
    """The report as it is shown; `said(act, rule)` is called for a click. `help` has the hint's words and its button."""

    _esm = resources.files(__package__).joinpath("report.js").read_text(encoding="utf-8")
    html = traitlets.Unicode().tag(sync=True)
    help = traitlets.Dict().tag(sync=True)

    def __init__(self, html: str, said: Callable[[str, str], Any]):
        super().__init__(html=html, help={})
        self.on_msg(lambda _, message, buffers: said(message.get("act"), message.get("rule")))


class ReportPanel(ipywidgets.VBox):
    """A report with its buttons. Replay opens a lab `seconds` before the failure, runs it in real time and stops at the failing scan.

    `lab` is the one opened last, None before. Go to the scan stands there at once. The hints of the exercise come one after the other
    from the second failing program on, and last the network at fault; that search goes on beside the notebook.
    """

    _failures: dict[str, int] = {}  # of each exercise, by its folder: how many reports on failing programs were shown

    def __init__(self, report: Report, seconds: float = 2.0):
        self.report, self.seconds = report, seconds
        self.lab: Lab | None = None
        self.search: threading.Thread | None = None
        self.hints = 0  # so many were shown
        self.most = len(report.task.hints) + 1 if report.task is not None else 0
        key = str(report.task.folder) if report.task is not None else ""
        if not report.passed:
            self._failures[key] = self._failures.get(key, 0) + 1
        self.tries = self._failures.get(key, 0)
        self.place = ipywidgets.VBox()
        self.sheet = Sheet(panel(report, actions=self._actions, foot=self._foot()), self._act)
        self._say("")
        super().__init__([self.sheet, self.place])
        self.add_class("ec-report")

    def _actions(self, verdict: Verdict) -> str:
        rule = escape(verdict.rule)
        return (
            f'<button class="btn primary" data-act="replay" data-rule="{rule}" data-testid="replay-{rule}">Replay from {self.seconds:g} s before</button>'
            f'<button class="btn" data-act="scan" data-rule="{rule}" data-testid="scan-{rule}">Go to the scan</button>'
        )

    def _foot(self) -> str:
        if self.report.passed or not self.most:
            return ""
        return (
            '<div class="hint" data-place="hint"><button class="btn" data-act="hint" data-testid="hint"></button>'
            '<p aria-live="polite" data-testid="hint-words"></p></div>'
        )

    def _act(self, act: str, rule: str) -> None:
        """A click."""
        if act in ("replay", "scan") and rule in [verdict.rule for verdict in self.report.failed]:
            self.replay(rule) if act == "replay" else self.go_to_scan(rule)
        elif act == "hint":
            self.hint()

    # -- the machine --------------------------------------------------------------------------------------------

    def replay(self, rule: str) -> Lab:
        """Open the lab shortly before a rule broke and let it run up to the failing scan; gives the lab. The one opened before is closed."""
        lab, target = self._open(rule, self.seconds)
        session = lab.session

        def stop() -> None:
            session.pause()
            if session.plc.scans > target:
                session.back(session.plc.scans - target)

        def look() -> None:
            if session.plc.scans == target:
                end()
                threading.Thread(target=stop, daemon=True).start()  # a hook only looks; time is held from outside

        end = session.each_scan(look)
        session.run()
        return lab

    def go_to_scan(self, rule: str) -> Lab:
        """Open the lab behind the very scan in which a rule was seen to be broken; gives the lab."""
        lab, target = self._open(rule, self.seconds)
        lab.session.scan(target - lab.plc.scans)
        return lab

    def _open(self, rule: str, seconds: float) -> tuple[Lab, int]:
        """A paused lab before a failure, and how many scans there are when it is reached."""
        replay = self.report.replay(rule, seconds)
        if self.lab is not None:
            self.lab.close()
        self.lab = Lab(replay.plc, plant=replay.plant, picture=replay.picture, name="replay", autostart=False, title=self.report.title)
        self.place.children = [self.lab]
        behind = round(replay.seconds * 1e6 / replay.plc.period_us)
        return self.lab, replay.plc.scans + behind + 1

    # -- hints --------------------------------------------------------------------------------------------------

    def hint(self) -> None:
        """Show the next hint. The last one is looked for in a thread, `search`, and tells how far it is."""
        if self.tries < TRIES or self.hints >= self.most or self.report.passed:
            return
        self.hints += 1
        if self.hints < self.most and self.report.compiled is not None:
            self._say(self.report.task.hint(self.report, self.hints))
            return
        self.hints = self.most
        self._say("Looking for the network at fault.")
        self.search = threading.Thread(target=self._look, daemon=True)
        self.search.start()

    def _look(self) -> None:
        from ecsim.grading.hints import hint

        told = [0]

        def progress(done: int, of: int) -> None:
            percent = 100 * done // of
            if percent >= told[0] + 10:
                told[0] = percent
                self._say(f"Looking for the network at fault: {percent} % of what is tried at most.")

        try:
            self._say(hint(self.report.task, self.report, progress))
        except EcsimError as error:
            self._say(str(error))

    def _say(self, words: str) -> None:
        if not self.most:
            return
        left = self.hints < self.most
        button = f"Hint {min(self.hints + 1, self.most)} of {self.most}" if self.tries >= TRIES else "Hints come after another try"
        self.sheet.help = {"words": words, "button": button, "open": left and self.tries >= TRIES}
