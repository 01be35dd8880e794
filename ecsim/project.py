"""Where a program's text comes from: a string, an .il file, or a project folder with plc.toml and *.il files."""

import re
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from .errors import EcsimError, ProgramError


def read_project(program: str | Path) -> tuple[str, str, dict]:
    """The instruction list, its name and the project's settings. A one-line string that ends in .il, or names a folder, is a path."""
    if isinstance(program, Path) or _is_path(program):
        path = Path(program)
        if path.is_dir():
            chosen = settings(path)
            return _folder(path), path.name, chosen
        return _text(path), path.name, {}
    if not isinstance(program, str):
        raise EcsimError(f"a program is a text, a path or a Program, not {type(program).__name__}")
    return program, "", {}


def _is_path(text: object) -> bool:
    if not isinstance(text, str) or "\n" in text or not text.strip():
        return False
    commented = "//" in text and " " in text.strip()  # a rung with a comment, which may speak of a file
    if text.strip().lower().endswith(".il"):
        return not commented
    return ("/" in text or "\\" in text) and "//" not in text and " " not in text.strip()


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise EcsimError(f"there is no file {path}; give the path of an .il file or a project folder") from None
    except UnicodeDecodeError as error:
        raise EcsimError(f"{path} is no UTF-8 text (byte {error.start}); save it as UTF-8") from None
    except (OSError, ValueError) as error:
        raise EcsimError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from None


def _folder(folder: Path) -> str:
    files = sorted(folder.glob("*.il"))
    if not files:
        raise EcsimError(f"{folder} holds no .il file; put the program into {folder / 'main.il'}")
    return "\n".join(_text(path) for path in files)


@contextmanager
def own_lines(program: object) -> Iterator[None]:
    """Let the problems of a project folder name its files and their own lines instead of those of the whole text."""
    try:
        yield
    except ProgramError as error:
        if not ((isinstance(program, Path) or _is_path(program)) and Path(program).is_dir()):
            raise
        starts = [(1, "")]
        for path in sorted(Path(program).glob("*.il")):
            first, _ = starts.pop()
            starts += [(first, path.name), (first + len(_text(path).split("\n")), "")]
        starts.pop()

        def place(line: int) -> tuple[int, str]:
            first, name = max(start for start in starts if start[0] <= max(line, 1))
            return line - first + 1, name

        def named(text: str) -> str:
            return re.sub(r"\bline (\d+)\b", lambda found: "line {} of {}".format(*place(int(found[1]))), text)

        problems = []
        for problem in error.problems:
            line, name = place(problem.line)
            problems.append(replace(problem, line=line, source=name, message=named(problem.message), hint=named(problem.hint)))
        raise ProgramError(problems) from None


def settings(folder: Path) -> dict:
    """The content of a project's plc.toml, {} when there is none; its keys are `model`, `scan_ms` and `input_filter_ms`."""
    path = folder / "plc.toml"
    if not path.exists():
        return {}
    try:
        found = tomllib.loads(_text(path))
    except tomllib.TOMLDecodeError as error:
        raise EcsimError(f'{path} is no TOML: {error}; write lines like model = "EC20"') from None
    known = {"model": str, "scan_ms": (int, float), "input_filter_ms": (int, float)}
    for key, value in found.items():
        if key not in known:
            raise EcsimError(f"{path}: there is no setting {key!r}; known are {', '.join(known)}")
        if not isinstance(value, known[key]) or isinstance(value, bool):
            raise EcsimError(f"{path}: {key} is {value!r}; expected {'text' if known[key] is str else 'a number'}")
    return found
