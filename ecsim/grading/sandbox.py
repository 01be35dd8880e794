"""Each submission in a process of its own: whatever a program does, it costs its author the mark and nobody else anything.

A judge is a process that waits with the exercise loaded and lets a child grade each submission, within limits of time
and memory, without files to write to, without network and without processes. A submission is text; nothing of it is run as Python.
Where a system has no fork (Windows) the judge grades by itself and is started again after one that had to be ended.
"""

import contextlib
import gc
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..errors import EcsimError, ProgramError
from ..project import SETTINGS, Project
from .exercise import Exercise, find_exercise
from .grade import grade, untried
from .report import Report

GARBAGE = 20_000  # a run keeps tens of thousands of values: to look through them every 700 costs a tenth of the time


@dataclass(frozen=True)
class Limits:
    """What grading one submission may take. `wall_s` is met whatever happens, the others where the system can hold them (POSIX)."""

    cpu_s: int = 60
    wall_s: float = 180.0
    memory_mb: int = 1024
    text_bytes: int = 500_000


@dataclass(frozen=True)
class Submission:
    """One student's program: a name and its files, name -> content as it lies on the disk."""

    name: str
    files: dict[str, bytes]

    @classmethod
    def read(cls, path: Path) -> "Submission":
        """A file, or a project folder: its *.il files and plc.toml. A file of more than 10 MB is not read to its end."""
        paths = [*sorted(path.glob("*.il")), *path.glob(SETTINGS)] if path.is_dir() else [path]
        files = {}
        for one in paths:
            try:
                with one.open("rb") as file:
                    files[one.name] = file.read(10_000_000)
            except OSError as error:
                raise EcsimError(f"{one} cannot be read: {error.strerror}") from None
        return cls(path.name if path.is_dir() else path.stem, files)

    def texts(self, limits: Limits) -> dict[str, str]:
        """Its files as text; raises EcsimError in words for its author."""
        if not self.files.keys() - {SETTINGS}:
            raise EcsimError("There is no .il file.")
        size = sum(map(len, self.files.values()))
        if size > limits.text_bytes:
            raise EcsimError(f"The program has {size:,} bytes; a program has {limits.text_bytes:,} at most.")
        texts = {}
        for name, content in self.files.items():
            try:
                texts[name] = content.decode("utf-8")
            except UnicodeDecodeError as error:
                raise EcsimError(f"{name} is no text in UTF-8 (byte {error.start}).") from None
            if "\0" in texts[name]:
                raise EcsimError(f"{name} is no text: it holds zero bytes.")
        return texts


def failed_report(exercise: Exercise, name: str, model: str | None, reason: str) -> Report:
    """A report without marks on a program that was not graded."""
    return Report(exercise.name, exercise.title, model or exercise.models[0], name, "", untried(exercise), reason=reason)


class Judge:
    """Grades submissions to one exercise in a process beside this one. Used by one thread at a time; `close` ends it.

    `progress(done, of)` is called while a hint is looked for.
    """

    def __init__(
        self,
        exercise: "str | Path",
        model: str | None = None,
        limits: Limits | None = None,
        hints: bool = False,
        progress: Callable[[int, int], Any] | None = None,
    ):
        self.place, self.model, self.limits, self.hints = str(exercise), model, limits or Limits(), hints
        self.progress = progress
        self.exercise = find_exercise(exercise)
        self._process: subprocess.Popen | None = None

    def grade(self, submission: Submission) -> Report:
        """The report on one submission, whatever it holds."""
        try:
            texts = submission.texts(self.limits)
        except EcsimError as error:
            return failed_report(self.exercise, submission.name, self.model, str(error))
        request = {"name": submission.name, "files": texts, "model": self.model, "hints": self.hints, "limits": asdict(self.limits)}
        answer = self._ask(json.dumps(request))
        if "report" in answer:
            return Report.from_dict(answer["report"])
        return failed_report(self.exercise, submission.name, self.model, answer["reason"])

    def _ask(self, line: str) -> dict[str, Any]:
        process = self._running()
        # The judge keeps to wall_s itself where it has a child; this one is for a judge that does not answer.
        timer = threading.Timer(self.limits.wall_s * 1.2 + 5, process.kill)
        timer.start()
        try:
            process.stdin.write(line + "\n")
            process.stdin.flush()
            while "progress" in (answer := json.loads(process.stdout.readline())):
                if self.progress is not None:
                    self.progress(*answer["progress"])
            return answer
        except (OSError, ValueError):
            self.close()
            return {"reason": "Grading came to no end: the program took too long or too much memory."}
        finally:
            timer.cancel()

    def _running(self) -> subprocess.Popen:
        if self._process is None or self._process.poll() is not None:
            command = [sys.executable, "-m", "ecsim.grading.sandbox", self.place]
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, encoding="utf-8"
            )
        return self._process

    def close(self) -> None:
        """End the process."""
        process, self._process = self._process, None
        if process is not None:
            for pipe in (process.stdin, process.stdout):
                with contextlib.suppress(OSError):
                    pipe.close()
            try:
                process.wait(timeout=1)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def __enter__(self) -> "Judge":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


# -- in the judge's process -----------------------------------------------------------------------------------------


def serve(place: str) -> None:
    """Answer requests, one JSON a line, until the input ends. Lines of progress may come before an answer."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what anything prints does not mix with the answers
    exercise = find_exercise(place)
    gc.collect()
    gc.freeze()  # what is loaded stays: the children share its pages, and need not look through it
    gc.set_threshold(GARBAGE)

    def tell(line: str) -> None:
        answers.write(line + "\n")
        answers.flush()

    for line in sys.stdin:
        request = json.loads(line)
        tell(_in_a_child(exercise, request, tell) if hasattr(os, "fork") else json.dumps(_graded(exercise, request, tell)))


def _graded(exercise: Exercise, request: dict[str, Any], tell: Callable[[str], Any]) -> dict[str, Any]:
    """The report as data, or the reason why there is none. How far the search for a hint is goes to `tell` as a line, at each percent."""
    told = -1

    def progress(done: int, of: int) -> None:
        nonlocal told
        if 100 * done // max(of, 1) > told:
            told = 100 * done // max(of, 1)
            tell(json.dumps({"progress": [done, of]}))

    try:
        report = grade(exercise, Project.spelled(request["files"], request["name"]), request["model"])
        if request["hints"]:
            from .hints import hint

            report.hint = hint(exercise, report, progress)
        return {"report": report.as_dict()}
    except (EcsimError, ProgramError) as error:
        return {"reason": str(error)}
    except MemoryError:
        return {"reason": f"The program needs more than {request['limits']['memory_mb']} MB."}
    except RecursionError:
        return {"reason": "The program is nested too deeply."}
    except Exception as error:  # a bug of ours must not end the grading of a class
        return {"reason": f"Grading failed: {type(error).__name__}: {error}"}


def _in_a_child(exercise: Exercise, request: dict[str, Any], tell: Callable[[str], Any]) -> str:
    """Grade in a child under limits; its answer as a line, or the reason why there is none. Its lines of progress are passed on."""
    limits = Limits(**request["limits"])
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.close(reading)
            _confine(limits)
            with os.fdopen(writing, "w", encoding="utf-8", buffering=1) as pipe:
                pipe.write(json.dumps(_graded(exercise, request, lambda line: pipe.write(line + "\n"))))
            code = 0
        finally:
            os._exit(code)
    os.close(writing)
    timer = threading.Timer(limits.wall_s, os.kill, (child, signal.SIGKILL))
    timer.start()
    answer = ""
    try:
        with os.fdopen(reading, encoding="utf-8") as pipe:
            for answer in pipe:
                if answer.endswith("\n"):  # only the answer itself, the last one, has no such end
                    tell(answer.rstrip())
    finally:
        timer.cancel()
    _, status, used = os.wait4(child, 0)
    if os.WIFEXITED(status) and os.WEXITSTATUS(status) == 0 and answer:
        return answer
    spent = used.ru_utime + used.ru_stime
    if spent >= limits.cpu_s - 1:
        reason = f"The program took more than {limits.cpu_s} s of the processor."
    elif os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL:
        reason = f"The program took more than {limits.wall_s:g} s, or more memory than there is."
    else:
        reason = "Grading broke off; the program may need too much memory."
    return json.dumps({"reason": reason})


_REFUSED = (
    "socket.",
    "subprocess.",
    "os.exec",
    "os.fork",
    "os.posix_spawn",
    "os.system",
    "os.remove",
    "os.rename",
    "os.mkdir",
    "shutil.",
    "ctypes.",
)


def _confine(limits: Limits) -> None:
    """Limits of the processor, of memory and of what is written, for this process and for good; no network, no processes."""
    import resource

    memory = limits.memory_mb << 20
    for what, most in [
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_CPU, limits.cpu_s),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
    ]:
        _, hard = resource.getrlimit(what)
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(what, (most, most))

    def refuse(event: str, arguments: tuple) -> None:
        writing = (
            event == "open" and isinstance(arguments[1], str) and set(arguments[1]) & set("wax+") and not isinstance(arguments[0], int)
        )
        if writing or event.startswith(_REFUSED):
            raise PermissionError(f"{event} is not allowed while a program is graded")

    sys.addaudithook(refuse)


if __name__ == "__main__":
    serve(sys.argv[1])
