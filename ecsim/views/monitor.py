"""The device monitor as a table for a notebook."""

from __future__ import annotations

from html import escape

from ..monitor import Monitor, Row
from . import svg as s


def table(monitor: Monitor) -> str:
    """The table with the values of now; a forced row says so in words and by its ground."""
    head = "".join(f'<th scope="col">{escape(each)}</th>' for each in monitor.HEADINGS)
    rows = "".join(f"<tr>{''.join(_cells(row))}</tr>" for row in monitor)
    markup = f'<table class="ec monitor"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'
    return f"<style>{s.look('tokens.css')}\n{s.style(s.classes_of(markup))}</style>{markup}"


def _cells(row: Row) -> list[str]:
    cells = []
    for heading, text in zip(Monitor.HEADINGS, row.cells, strict=True):
        classes = [
            name for name, holds in (("value", heading == "value"), ("forced", row.forced and heading in ("value", "forced"))) if holds
        ]
        if heading == "value" and row.type.bits == 1 and row.value:
            classes.append("on")
        mark = f' class="{" ".join(classes)}"' if classes else ""
        cells.append(f"<td{mark}>{escape(text)}</td>")
    return cells
