"""A class: a folder of submissions, graded on all cores or on a Dask cluster, resumed where it broke off, with the same marks either way."""

import csv
import hashlib
import io
import os
import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

from ..errors import EcsimError
from .exercise import Exercise, find_exercise, place_of
from .page import page, panel
from .report import Report
from .sandbox import Judge, Limits, Submission, failed_report


@dataclass
class Marks:
    """One row of the table of marks. `key` is a hash of the submission and of what graded it."""

    name: str
    key: str
    marks: float
    out_of: float
    states: dict[str, str]  # rule -> passed, failed, untried
    reason: str = ""

    @classmethod
    def of(cls, name: str, key: str, report: Report) -> "Marks":
        """The row of a report."""
        reason = " ".join([report.reason, *report.problems[:1]]).strip()
        return cls(name, key, report.marks, report.out_of, {verdict.rule: verdict.state for verdict in report.verdicts}, reason)


@dataclass
class Class:
    """The marks of a class by name, and how many were taken over from the run before."""

    exercise: str
    rows: list[Marks] = field(default_factory=list)
    taken_over: int = 0

    def __str__(self) -> str:
        full = sum(row.marks == row.out_of for row in self.rows)
        return f"{self.exercise}: {len(self.rows)} submissions, {full} with all marks ({self.taken_over} graded before)"


def submissions_in(folder: Path) -> list[Path]:
    """The submissions of a folder: each *.il file, and each folder in it."""
    if not folder.is_dir():
        raise EcsimError(f"there is no folder {folder}")
    found = sorted(path for path in folder.iterdir() if not path.name.startswith(".") and (path.is_dir() or path.suffix.lower() == ".il"))
    if not found:
        raise EcsimError(f"{folder} holds no submissions: neither .il files nor folders with them")
    stems = [path.name if path.is_dir() else path.stem for path in found]
    for stem in stems:
        if stems.count(stem) > 1:
            raise EcsimError(f"{folder} holds two submissions of {stem!r}; names tell them apart")
    return found


def grade_class(
    exercise: Exercise,
    folder: Path,
    table: Path | None = None,
    pages: Path | None = None,
    *,
    model: str | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    limits: Limits | None = None,
    hints: bool = False,
    progress: Callable[[int, int, str], Any] | None = None,
) -> Class:
    """Grade every submission in a folder.

    `table` is a CSV file of marks: it is kept up to date while the class is graded, and what stands in it with the same
    content is not graded again. `pages` is a folder for a page of each report and an index. `workers` is a number of
    processes, all cores unless given; `scheduler` is the address of a Dask cluster ("tcp://...") to be used instead.
    `progress(done, of, name)` is called after each. Raises EcsimError for folders that cannot be used.
    """
    limits = limits or Limits()
    paths = submissions_in(folder)
    before = read_table(table) if table is not None else {}
    if pages is not None:
        pages.mkdir(parents=True, exist_ok=True)
    found = Class(exercise.name)
    waiting: list[tuple[Submission, str]] = []
    for path in paths:
        submission = Submission.read(path)
        key = _key(submission, exercise, model, hints)
        row = before.get(submission.name)
        if row is not None and row.key == key and (pages is None or _page_of(pages, submission.name).is_file()):
            found.rows.append(row)
            found.taken_over += 1
        else:
            waiting.append((submission, key))
    keys = {submission.name: key for submission, key in waiting}
    place = place_of(exercise)
    work = [submission for submission, _ in waiting]
    engine = _on_cluster(scheduler, place, model, limits, hints, work) if scheduler else _here(workers, place, model, limits, hints, work)
    for name, report in engine:
        found.rows.append(Marks.of(name, keys[name], report))
        found.rows.sort(key=lambda row: row.name)
        if pages is not None:
            _page_of(pages, name).write_text(page(f"{name}: {report.title}", panel(report, styled=False)), encoding="utf-8")
        if table is not None:
            write_table(table, exercise, found.rows)
        if progress is not None:
            progress(len(found.rows), len(paths), name)
    found.rows.sort(key=lambda row: row.name)
    if table is not None:
        write_table(table, exercise, found.rows)
    if pages is not None:
        (pages / "index.html").write_text(_index(exercise, found), encoding="utf-8")
    return found


def _key(submission: Submission, exercise: Exercise, model: str | None, hints: bool) -> str:
    digest = hashlib.sha256(f"{exercise.fingerprint} {model} {hints}".encode())
    for name, content in submission.files.items():
        digest.update(f"\0{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()[:16]


# -- the engines ----------------------------------------------------------------------------------------------------


def _here(
    workers: int | None, place: str, model: str | None, limits: Limits, hints: bool, work: Sequence[Submission]
) -> Iterator[tuple[str, Report]]:
    """On this machine: so many judges, each with a process of its own."""
    count = max(1, min(workers or os.cpu_count() or 1, len(work) or 1))
    judges: queue.SimpleQueue[Judge] = queue.SimpleQueue()
    made = [Judge(place, model, limits, hints) for _ in range(count)]
    for judge in made:
        judges.put(judge)

    def one(submission: Submission) -> Report:
        judge = judges.get()
        try:
            return judge.grade(submission)
        finally:
            judges.put(judge)

    try:
        with ThreadPoolExecutor(count) as pool:
            tasks = {pool.submit(one, submission): submission.name for submission in work}
            try:
                for task in as_completed(tasks):
                    yield tasks[task], task.result()
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    finally:
        for judge in made:
            judge.close()


def _on_cluster(
    scheduler: str, place: str, model: str | None, limits: Limits, hints: bool, work: Sequence[Submission]
) -> Iterator[tuple[str, Report]]:
    """On a Dask cluster: each submission is a task; the exercise must be found on the workers by the same name or path."""
    try:
        from distributed import Client
        from distributed import as_completed as done
    except ImportError:
        raise EcsimError(
            "a cluster needs dask.distributed: pip install 'ecsim[class]'; without --scheduler all cores of this machine work"
        ) from None
    try:
        client = Client(scheduler, timeout="5s", set_as_default=False)
    except (OSError, ValueError) as error:
        raise EcsimError(f"there is no Dask scheduler at {scheduler}: {error}") from None
    with client:
        tasks = {client.submit(_on_worker, place, model, limits, hints, one, pure=False, retries=1): one.name for one in work}
        for task in done(list(tasks), loop=client.loop):
            try:
                yield tasks[task], Report.from_dict(task.result())
            except Exception as error:  # the worker is gone, or cannot find the exercise: this submission alone is lost
                reason = f"Not graded: {type(error).__name__}: {error}"
                yield tasks[task], failed_report(find_exercise(place), tasks[task], model, reason)


def _on_worker(place: str, model: str | None, limits: Limits, hints: bool, submission: Submission) -> dict[str, Any]:
    """One task of the cluster."""
    return _judge_of(threading.get_ident(), place, model, limits, hints).grade(submission).as_dict()


@cache
def _judge_of(thread: int, place: str, model: str | None, limits: Limits, hints: bool) -> Judge:
    """A worker's own judge for each of its threads; its process ends with the worker's, when its input is closed."""
    return Judge(place, model, limits, hints)


# -- the table and the pages ----------------------------------------------------------------------------------------

COLUMNS = ("name", "marks", "out_of", "reason", "key")


def read_table(path: Path) -> dict[str, Marks]:
    """The rows of a table of marks by name, {} when there is none yet; raises EcsimError for a file that is something else."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return {}
    except (OSError, UnicodeDecodeError) as error:
        raise EcsimError(f"{path} cannot be read as a table of marks: {error}") from None
    if not text.strip():
        return {}
    rows = csv.DictReader(io.StringIO(text))
    if not set(COLUMNS) <= set(rows.fieldnames or ()):
        raise EcsimError(f"{path} is no table of marks; it would be overwritten: name another file")
    found = {}
    for row in rows:
        states = {name: state for name, state in row.items() if name not in COLUMNS}
        try:
            found[row["name"]] = Marks(row["name"], row["key"], float(row["marks"]), float(row["out_of"]), states, row["reason"])
        except (TypeError, ValueError):
            continue  # a row that was cut off is graded again
    return found


def write_table(path: Path, exercise: Exercise, rows: Sequence[Marks]) -> None:
    """The table of marks, all or nothing."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    rules = [rule.name for rule in exercise.rules]
    writer.writerow([*COLUMNS[:3], *rules, *COLUMNS[3:]])
    for row in rows:
        writer.writerow([row.name, f"{row.marks:g}", f"{row.out_of:g}", *(row.states.get(rule, "") for rule in rules), row.reason, row.key])
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f"{path.name}.new")
    new.write_text(text.getvalue(), encoding="utf-8")
    new.replace(path)


def _page_of(pages: Path, name: str) -> Path:
    return pages / f"{name}.html"


def _index(exercise: Exercise, found: Class) -> str:
    """The table of marks as a page, each name a link to its report."""
    head = "".join(f"<th>{escape(word)}</th>" for word in ("name", "marks", "of", "rules that are not kept"))
    lines = []
    for row in found.rows:
        words = row.reason or ", ".join(rule for rule, state in row.states.items() if state != "passed")
        link = f'<a href="{escape(row.name)}.html">{escape(row.name)}</a>'
        lines.append(f'<tr><td>{link}</td><td class="n">{row.marks:g}</td><td class="n">{row.out_of:g}</td><td>{escape(words)}</td></tr>')
    return page(exercise.title, f'<h1>{escape(exercise.title)}</h1><table class="marks"><tr>{head}</tr>{"".join(lines)}</table>')
