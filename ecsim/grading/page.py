"""The report as a page: HTML with its own style, for a notebook's output and for files."""

from collections.abc import Callable
from functools import cache
from html import escape
from importlib.resources import files

from ..views.svg import look, tokens
from .report import FAILED, PASSED, Report, Verdict, duration

CHECK = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><path d="M3 8.5l3.5 3.5L13 4.5"/></svg>'
CROSS = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><path d="M4 4l8 8M12 4l-8 8"/></svg>'
DASH = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><path d="M4 8h8"/></svg>'
STATES = {PASSED: ("pass", CHECK, "kept"), FAILED: ("fail", CROSS, "broken")}
NEVER_TRIED = ("untried", DASH, "never put to the test")


@cache
def style() -> str:
    """The tokens and the report's rules."""
    return look("tokens.css") + files("ecsim.grading").joinpath("report.css").read_text(encoding="utf-8")


def panel(report: Report, styled: bool = True, actions: Callable[[Verdict], str] | None = None, foot: str = "") -> str:
    """The report as one section; `styled` puts the style before it.

    `actions` gives the buttons of a broken rule; without it the page says how to get to the moment. `foot` is HTML at the end.
    """
    kept = sum(verdict.passed for verdict in report.verdicts)
    tally = "".join(f'<i class="{STATES.get(verdict.state, NEVER_TRIED)[0]}"></i>' for verdict in report.verdicts)
    facts = {"exercise": report.title, "your program": report.program, "PLC": report.model}
    facts |= {"tried in": f"{report.runs} runs, {duration(report.simulated_s)} of plant time"} if report.runs else {}
    facts |= {"took": f"{report.took_s:.1f} s"} if report.took_s else {}
    rows = "".join(f"<dt>{escape(name)}</dt><dd>{escape(value)}</dd>" for name, value in facts.items() if value)
    parts = [
        f"<style>{style()}</style>" if styled else "",
        '<section class="ec report" aria-label="Report" data-testid="report">',
        '<header class="panel-head"><h2>Report</h2><span class="sub">graded by behaviour; any correct program passes</span></header>',
        f'<div class="score"><div class="big">{kept}<span> of {len(report.verdicts)} rules · {report.marks:g} of {report.out_of:g} marks'
        f'</span></div><div class="tally" aria-hidden="true">{tally}</div><dl class="facts">{rows}</dl></div>',
        f'<p class="reason">{escape(report.reason)}</p>' if report.reason else "",
        "".join(f'<pre class="problem">{escape(problem)}</pre>' for problem in report.problems),
        f'<ol class="rules">{"".join(_rule(verdict, number, actions or _way) for number, verdict in enumerate(report.verdicts))}</ol>',
        "".join(f'<p class="note">{escape(note)}</p>' for note in report.notes),
        f'<p class="hint"><b>Hint</b> {escape(report.hint)}</p>' if report.hint else "",
        foot,
        "</section>",
    ]
    return "".join(parts)


def _way(verdict: Verdict) -> str:
    """How to get to the moment from a page that has no program behind it."""
    call = escape(f'report.replay("{verdict.rule}")')
    return f"<span><b>Go to the scan</b> grade the program in a notebook; <code>{call}</code> puts PLC and machine to 2 s before it</span>"


def _rule(verdict: Verdict, number: int, actions: Callable[[Verdict], str]) -> str:
    kind, icon, state = STATES.get(verdict.state, NEVER_TRIED)
    label = f"{verdict.words}: {state}"
    failure = verdict.failure
    when = "" if failure is None else f"{failure.scenario}, {failure.second:,.3f} s"
    line = (
        f'<span class="verdict">{icon}</span><span class="what">{escape(verdict.words)}</span>'
        f'<span class="when">{escape(when or (state if kind == "untried" else ""))}</span>'
    )
    if failure is None:
        return f'<li class="rule {kind}" aria-label="{escape(label)}">{line}</li>'
    choices = ", ".join(f"{name} {value}" for name, value in failure.choices.items())
    happening = f"{failure.happening}{f' ({choices})' if choices else ''}"
    return (
        f'<li class="rule fail" data-rule="{escape(verdict.rule)}"><details open><summary aria-label="{escape(label)}">{line}</summary>'
        f'<div class="evidence"><p><b>Expected</b>{escape(failure.expected)}</p><p><b>Found</b>{escape(failure.found)}</p>'
        f'<p><b>Scenario</b>{escape(happening)}</p><div class="chartbox">{failure.chart.svg(f"fail-{number}-{failure.scan}")}</div>'
        f'<div class="actions">{actions(verdict)}</div></div>'
        f"</details></li>"
    )


@cache
def dark() -> str:
    """The colours of the dark theme on a page by itself, for those whose system asks for it. Paper stays white."""
    light = tokens()
    colours = "".join(f"{name}: {value}; " for name, value in tokens("dark").items() if value != light[name])
    return f"@media screen and (prefers-color-scheme: dark) and (forced-colors: none) {{ .ec.report-page, .ec.report-page .ec {{ color-scheme: dark; {colours}}} }}\n"


def page(title: str, body: str) -> str:
    """A whole HTML file, dark where its reader's system is."""
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{style()}{dark()}</style></head>'
        f'<body class="ec report-page">{body}</body></html>\n'
    )
