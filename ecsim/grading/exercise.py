"""An exercise: a machine, what happens on it, and the rules that every correct program keeps; found by name or by its folder."""

import hashlib
import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import EcsimError
from ..models import get_model
from .rules import Rule, check
from .run import Scenario

if TYPE_CHECKING:
    from .report import Report

PACKAGE = "ecsim_exercises"


@dataclass(frozen=True)
class Exercise:
    """One task on one machine. `folder` holds its texts: statement.md, hints.md, starter.il, solution.il, solutions/, mistakes/.

    `plant()` makes the machine at its usual; `quantities` are attributes of it that rules and charts may name beside the
    points of its wiring. `models` are the PLCs a program may be written for, the first one unless it is said.
    """

    folder: Path
    title: str
    plant: Callable[[], Any]
    scenarios: Sequence[Scenario]
    rules: Sequence[Rule]
    quantities: Sequence[str] = ()
    models: Sequence[str] = ("EC20", "EC10", "H2U", "H1U")
    scan_ms: float = 10
    picture: Any = None

    def __post_init__(self):
        if not self.scenarios or not self.rules:
            raise EcsimError(f"the exercise {self.title!r} needs scenarios and rules")
        check(self.rules)
        for model in self.models:
            get_model(model)
        named = [scenario.name for scenario in self.scenarios]
        for rule in self.rules:
            unknown = sorted(set(rule.scenarios) - set(named))
            if unknown:
                raise EcsimError(f"the rule {rule.name} is for the scenario {unknown[0]!r}; there are {', '.join(named)}")
        if len(set(named)) < len(named):
            raise EcsimError(f"two scenarios of {self.title!r} have the same name: {', '.join(named)}")

    @property
    def name(self) -> str:
        """The folder's name."""
        return self.folder.name

    @cached_property
    def wiring(self) -> Mapping[str, Any]:
        """Device -> point of the machine, with `name` and `what`."""
        return self.plant().wiring

    def grade(self, program: Any, model: str | None = None, *, more: int = 0, seed: int = 0) -> "Report":
        """Judge a program (text, path or Program) by what the machine does under it; it need not compile.

        `more` draws so many further runs of each scenario, from `seed`, to look for a failure; what is found is made as
        short as it can be. A file that cannot be read raises EcsimError.
        """
        from .grade import grade

        return grade(self, program, model, more=more, seed=seed)

    def hint(self, report: "Report", attempt: int = 1) -> str:
        """What to say after the `attempt`-th failure: the steps of hints.md one after the other, then where in the program to look.

        The last takes seconds: it tries every single edit until one mends the program, and names its network. "" for a program that is right.
        """
        from .hints import hint

        if report.passed or report.compiled is None or attempt > len(self.hints):
            return hint(self, report)
        return self.hints[attempt - 1]

    # -- its texts ----------------------------------------------------------------------------------------------

    def text(self, file: str) -> str:
        """One of its files as text."""
        path = self.folder / file
        try:
            return path.read_text(encoding="utf-8")
        except OSError as error:
            raise EcsimError(f"the exercise {self.name} has no {file}: {error.strerror}") from None

    @property
    def statement(self) -> str:
        """The task, as Markdown."""
        return self.text("statement.md")

    @property
    def starter(self) -> str:
        """What the student begins with."""
        return self.text("starter.il")

    @property
    def solution(self) -> str:
        """The reference program."""
        return self.text("solution.il")

    @property
    def solutions(self) -> dict[str, str]:
        """All correct programs by name, the reference first; the name of one for another family tells its model: chart.h2u."""
        return {"solution": self.solution} | self._programs("solutions")

    @property
    def mistakes(self) -> dict[str, tuple[str, str]]:
        """Typical mistakes: name -> (the program, the rule that it breaks, as its first line tells: `// fails: rule`)."""
        found = {}
        for name, text in self._programs("mistakes").items():
            mark, _, rule = text.partition("\n")[0].partition(":")
            if mark.strip() != "// fails" or rule.strip() not in [one.name for one in self.rules]:
                raise EcsimError(f"{name}.il in mistakes begins with {text.partition(chr(10))[0]!r}; write '// fails: ' and a rule's name")
            found[name] = text, rule.strip()
        return found

    @property
    def hints(self) -> list[str]:
        """The hints in steps: the paragraphs of hints.md, each a numbered item or a section."""
        found: list[list[str]] = []
        for line in self.text("hints.md").splitlines():
            if line.lstrip()[:1].isdigit() and ". " in line[:5]:
                found.append([line.partition(". ")[2]])
            elif line.strip() and found and not line.startswith("#"):
                found[-1].append(line.strip())
        return [" ".join(lines) for lines in found]

    def _programs(self, folder: str) -> dict[str, str]:
        return {path.stem: path.read_text(encoding="utf-8") for path in sorted((self.folder / folder).glob("*.il"))}

    @cached_property
    def fingerprint(self) -> str:
        """A hash of all that judges a program: the exercise's files and the grading itself. Another one asks for grading anew."""
        ours = Path(__file__).parent.parent
        digest = hashlib.sha256()
        for path in [*sorted(self.folder.rglob("*.py")), *sorted(self.folder.parent.glob("*.py")), *sorted(ours.rglob("*.py"))]:
            digest.update(path.read_bytes())
        return digest.hexdigest()[:16]

    def __repr__(self) -> str:
        return f"<Exercise {self.name}: {len(self.scenarios)} scenarios, {len(self.rules)} rules>"


def find_exercise(name: "str | Path | Exercise") -> Exercise:
    """The exercise of a name ("conveyor") among those that come with ecsim, or of a folder; raises EcsimError when there is none."""
    if isinstance(name, Exercise):
        return name
    folder = Path(name)
    if not folder.is_dir():
        own = own_folder()
        if own is None or not (own / folder / "__init__.py").is_file() or folder.is_absolute():
            here = ", ".join(exercise_names()) or "none here"
            raise EcsimError(f"there is no exercise {str(name)!r}; give the path of its folder, or a name: {here}")
        folder = own / folder
    module = _imported(folder.resolve())
    exercise = getattr(module, "EXERCISE", None)
    if not isinstance(exercise, Exercise):
        raise EcsimError(f"{folder / '__init__.py'} has no EXERCISE; see the README of the exercises")
    return exercise


def exercise_names() -> list[str]:
    """The exercises that come with ecsim, by the names that `find_exercise` takes; those within others as "mixer/repair"."""
    own = own_folder()
    if own is None:
        return []
    return sorted(path.parent.relative_to(own).as_posix() for path in own.rglob("rules.py") if (path.parent / "__init__.py").is_file())


def place_of(exercise: Exercise) -> str:
    """What another process finds an exercise by: its name where it comes with ecsim, else the path of its folder."""
    own = own_folder()
    folder = exercise.folder.resolve()
    return folder.relative_to(own).as_posix() if own is not None and folder.is_relative_to(own) else str(folder)


def own_folder() -> Path | None:
    """Where the exercises lie that come with ecsim, if they are installed."""
    spec = importlib.util.find_spec(PACKAGE)
    places = list(spec.submodule_search_locations or []) if spec else []
    return Path(places[0]).resolve() if places else None


def _imported(folder: Path) -> Any:
    """The package in a folder, as a part of the packages around it."""
    top, inner = folder, [folder.name]
    while (top.parent / "__init__.py").is_file():
        top = top.parent
        inner.insert(0, top.name)
    if not (folder / "__init__.py").is_file():
        raise EcsimError(f"{folder} is no exercise: it has no __init__.py with EXERCISE")
    if top == own_folder():
        inner[0] = PACKAGE
    else:
        inner[0] = f"exercise_{hashlib.sha256(str(top).encode()).hexdigest()[:8]}_{top.name}"
        if inner[0] not in sys.modules:
            spec = importlib.util.spec_from_file_location(inner[0], top / "__init__.py", submodule_search_locations=[str(top)])
            module = sys.modules[inner[0]] = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
    return importlib.import_module(".".join(inner))
