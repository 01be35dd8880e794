"""A project: the instruction list in its files, and what plc.toml sets. Read from a text, an .il file or a folder, written back to a folder.

plc.toml                            *.il
model = "EC20"                      the main program, subroutines, interrupt programs, VAR_GLOBAL;
io = [[24, 16], "4AD"]              each file is read on its own
scan_ms = 10
input_filter_ms = 10
[system]                            hold_values, data_block_valid, watchdog_ms, constant_scan_ms, power_loss_ms, run_input,
watchdog_ms = 200                   interrupt_priority, no_battery, format_lock
[retain]
D = [[100, 199]]                    ranges of numbers, or of names: [["D100", "D199"]]
[data_block]
D0 = 5                              a word; double words and REAL: "D2:DINT" = 100000
[stop_outputs]
mode = "configure"                  disable, freeze, configure
Y0 = 1
[port0]                             protocol, baud ... of a serial port, also [port1]
[modules.0]                         settings of the special module at place 0
[passwords]                         upload, download, monitor; forbid_upload = true
[protected]
SBR_1 = "secret"                    the password that opens a unit
"""

import os
import re
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from .assembler import Program, assemble
from .errors import EcsimError, Problem, ProgramError
from .hardware.modules import check_io
from .hardware.serial import PortSettings
from .models import MODELS, Model, get_model, model_in
from .protection import Passwords, check_unit_password
from .system import SystemBlock, within
from .upload import unsealed

SETTINGS = "plc.toml"
_SYSTEM = (
    "hold_values", "data_block_valid", "watchdog_ms", "constant_scan_ms", "power_loss_ms", "run_input",
    "interrupt_priority", "no_battery", "format_lock",
)  # fmt: skip
_TABLES = ("system", "retain", "data_block", "stop_outputs", "port0", "port1", "modules", "passwords", "protected")
_HEAD = ("model", "io", "scan_ms", "input_filter_ms")
_PORT = tuple(field.name for field in fields(PortSettings))
_PASSWORDS = tuple(field.name for field in fields(Passwords))


@dataclass
class Project:
    """The files of a program by name, and the settings that are downloaded with them.

    What is None is left as the PLC has it. `io` names the base unit and its modules, [(24, 16), (8, 8), "4AD"]. Values may be changed, then `write` puts the project into a folder; comments and the
    order of plc.toml stay. `protected` has the password of each unit whose text is closed (2.1.11).
    """

    files: dict[str, str]
    name: str = ""
    model: str | None = None
    scan_ms: float | None = None
    system: SystemBlock | None = None
    passwords: Passwords | None = None
    protected: dict[str, str] = field(default_factory=dict)
    io: tuple | list | None = None
    toml: str = ""  # plc.toml as it was read
    origin: frozenset[Path] = frozenset()  # the .il files that it was read from

    def __post_init__(self):
        if self.model is None and isinstance(self.files, dict) and len(self.files) == 1:
            self.model = model_in(str(next(iter(self.files))))

    @classmethod
    def of(cls, program: "str | Path | Project") -> "Project":
        """A project from a text, the path of an .il file or of a folder. A one-line string that ends in .il, or names a folder, is a path.

        The name of a file may tell its model: answer.h2u.il.
        """
        if isinstance(program, Project):
            return program
        if isinstance(program, Path) or _is_path(program):
            path = Path(program)
            return cls.read(path) if path.is_dir() else cls({path.name: _text(path)}, path.name)
        if not isinstance(program, str):
            raise EcsimError(f"a program is a text, a path, a Project or a Program, not {type(program).__name__}")
        return cls({"": program})

    @classmethod
    def read(cls, path: str | Path) -> "Project":
        """The project in a folder; raises EcsimError, or ProgramError with every problem of plc.toml and of the program when plc.toml has any."""
        folder = Path(path)
        if not folder.is_dir():
            raise EcsimError(f"there is no folder {folder}; give the path of a project folder with {SETTINGS} and *.il")
        paths = sorted(folder.glob("*.il"))
        if not paths:
            raise EcsimError(f"{folder} holds no .il file; put the program into {folder / 'main.il'}")
        settings = [folder / SETTINGS] if (folder / SETTINGS).exists() else []
        project = cls.spelled({each.name: _text(each) for each in [*paths, *settings]}, folder.name)
        project.origin = frozenset(each.resolve() for each in paths)
        return project

    @classmethod
    def spelled(cls, texts: Mapping[str, str], name: str = "") -> "Project":
        """The project that some texts by file name make, plc.toml among them or not; raises ProgramError as `read` does."""
        files = dict(texts)
        toml = files.pop(SETTINGS, "")
        project = cls(files, name, toml=toml)
        problems = project._take(toml)
        if problems:
            try:
                assemble(unsealed(project.files)[0], project.model or "EC20")
            except ProgramError as error:
                problems += error.problems
            raise ProgramError(problems)
        return project

    # -- the program --------------------------------------------------------------------------------------------

    def compile(self, model: str | Model | None = None) -> Program:
        """The program for a model (the project's own, EC20 when it names none); raises ProgramError with all errors."""
        texts, passwords = unsealed(self.files)
        program = assemble(texts, model or self.model or "EC20")
        for name, password in (passwords | self.protected).items():
            try:
                program.unit(name).password = password
            except EcsimError as error:
                raise ProgramError([self._problem("protected", name, str(error))]) from None
        return program

    def check(self, model: Model) -> None:
        """Raise EcsimError unless this is a project for the model, with settings that it has."""
        kinds = {"files": dict, "protected": dict, "system": SystemBlock, "passwords": Passwords}
        for name, kind in kinds.items():
            if not isinstance(given := getattr(self, name), kind) and (given is not None or kind is dict):
                raise EcsimError(f"{name} of a project is {given!r:.40}; it is a {kind.__name__}")
        if wrong := [name for name, text in self.files.items() if not isinstance(text, str)]:
            raise EcsimError(f"the file {wrong[0]!r} of a project is {self.files[wrong[0]]!r:.40}; it is a text")
        if self.model is not None and self.model != model.name:
            raise EcsimError(f"{self.name or 'this'} is a project for {self.model}, this is an {model.name}; make a Plc({self.model!r})")
        if self.io is not None:
            check_io(model, self.io)
        if self.scan_ms is not None:
            within("scan_ms", self.scan_ms, 0.001, 60_000)
        if self.system is not None:
            self.system.check(model)
        if self.passwords is not None:
            self.passwords.check()
        for name, password in self.protected.items():
            check_unit_password(name, password)

    # -- reading plc.toml ---------------------------------------------------------------------------------------

    def _take(self, toml: str) -> list[Problem]:
        """Take over what a plc.toml sets, entry by entry; what is wrong with it."""
        try:
            document = tomllib.loads(toml.removeprefix("\ufeff"))
        except tomllib.TOMLDecodeError as error:
            found = re.search(r"\(at line (\d+), column (\d+)\)", str(error))
            line, column = (int(found[1]), int(found[2])) if found else (len(toml.splitlines()), 0)
            message = f"this is no TOML: {str(error).partition(' (at ')[0]}"
            return [Problem(line, column, message, 'write lines like model = "EC20"', source=SETTINGS)]
        named = document.get("model")
        model = get_model(named if isinstance(named, str) and named in MODELS else self.model or "EC20")
        entries, problems = list(_entries(document)), []
        for table, key, value in entries:
            try:
                Project({}, system=SystemBlock(watchdog_ms=0))._set(table, key, value, model)  # by itself: a watchdog of 0 limits nothing
                self._set(table, key, value)
            except EcsimError as error:
                problems.append(self._problem(table, key, str(error), toml))
        if not problems:
            try:
                self.check(model)
            except EcsimError as error:  # what only several entries together break
                problems.append(self._problem(*_breaking(entries, model, str(error)), str(error), toml))
        return problems

    def _set(self, table: str, key: str, value: Any, model: Model | None = None) -> None:
        """One entry of plc.toml; it is checked for a model where one is given."""
        place, _, part = table.partition(".")
        if table == "":
            self._set_head(key, value)
        elif table == "passwords":
            self.passwords = self.passwords or Passwords()
            setattr(self.passwords, _known(table, key, _PASSWORDS), value)
        elif table == "protected":
            self.protected[key] = value
        else:
            system = self.system = self.system or SystemBlock()
            if table == "system":
                setattr(system, _known(table, key, _SYSTEM), _events(value) if key == "interrupt_priority" else value)
            elif table == "retain":
                system.retain[key] = _ranges(key, value)
            elif table == "data_block":
                system.data_block[key] = value
            elif table == "stop_outputs" and key == "mode":
                system.stop_outputs = value
            elif table == "stop_outputs":
                system.stop_output_table[key] = value
            elif table in ("port0", "port1"):
                former = getattr(system, table) or PortSettings()
                settings = {name: getattr(former, name) for name in _PORT} | {_known(table, key, _PORT): value}
                setattr(system, table, PortSettings(**settings))
                return  # a port is checked as a whole: its protocol decides what the others may be
            elif place == "modules":
                settings = system.modules.setdefault(int(part) if part.isdigit() else part, {})
                if key:
                    settings[key] = value
                elif not isinstance(value, dict):
                    raise EcsimError(f"modules: place {part} is set to {value!r:.40}; write its settings by name")
                return  # and so is a module: its kind decides
        if model is not None:
            self.check(model)

    def _set_head(self, key: str, value: Any) -> None:
        if key == "model" and not (isinstance(value, str) and value in MODELS):
            raise EcsimError(f"model is {value!r}; choose {' or '.join(MODELS)}")
        if key == "input_filter_ms":
            self.system = self.system or SystemBlock()
            self.system.input_filter_ms = value
        elif _known("", key, (*_HEAD, *_TABLES)) in _HEAD:
            setattr(self, key, value)
        else:
            raise EcsimError(f"{key} is {value!r:.40}; it is a table: write [{key}] and its settings below")

    def _problem(self, table: str, key: str, message: str, toml: str | None = None) -> Problem:
        text = self.toml if toml is None else toml
        return Problem(_line(text, table, key), 0, message, source=SETTINGS)

    # -- writing ------------------------------------------------------------------------------------------------

    def write(self, path: str | Path) -> None:
        """Write the project into a folder, which is made if need be; .il files that it was read from and has no longer are removed.

        A plc.toml with comments keeps them and its order; only values that have changed are written (by tomlkit, which must be there
        when any has). Each file is replaced as a whole: when something fails, those of the folder stay as they were.
        """
        folder = Path(path)
        for name in self.files:
            if name != Path(name).name or not name.endswith(".il"):
                raise EcsimError(f"{name!r} cannot be a file of a project; name it like main.il")
        if not self.files:
            raise EcsimError("the project has no file; give it a program in files['main.il']")
        self.check(get_model(self.model or "EC20"))
        others = [each for each in sorted(folder.glob("*.il")) if each.name not in self.files]
        if strangers := [each.name for each in others if each.resolve() not in self.origin]:
            raise EcsimError(f"{folder} holds {', '.join(strangers)}, which would become part of the project; choose another folder")
        toml = self.settings_text()
        texts = dict(self.files) | ({SETTINGS: toml} if toml or self.toml else {})
        try:
            folder.mkdir(parents=True, exist_ok=True)
            replace_files(folder, texts, others)
        except OSError as error:
            raise EcsimError(f"{folder} cannot be written: {error.strerror or error}") from None
        self.toml, self.origin = toml, frozenset((folder / name).resolve() for name in self.files)

    def settings_text(self) -> str:
        """The text of plc.toml: as it was read, with the values that have changed since."""
        former = Project({})
        problems = former._take(self.toml)
        if problems:
            raise ProgramError(problems)
        before, after, usual = former._flat(), self._flat(), Project({}, system=SystemBlock(), passwords=Passwords())._flat()
        changed = {place: value for place, value in after.items() if before.get(place, usual.get(place)) != value}
        present = [(table, key) for table, key, _ in _entries(tomllib.loads(self.toml.removeprefix("\ufeff")))]
        gone = [place for place in present if place not in after]
        if not changed and not gone:
            return self.toml
        return _edited(self.toml, changed, gone)

    def _flat(self) -> dict[tuple[str, str], Any]:
        """(table, key) -> value as plc.toml has it, of everything that is set."""
        io = [list(each) if isinstance(each, tuple) else each for each in self.io] if self.io is not None else None
        flat = {("", "model"): self.model, ("", "io"): io, ("", "scan_ms"): self.scan_ms}
        if (system := self.system) is not None:
            flat[("", "input_filter_ms")] = system.input_filter_ms
            flat |= {("system", key): getattr(system, key) for key in _SYSTEM}
            flat[("system", "interrupt_priority")] = {str(event): level for event, level in system.interrupt_priority.items()} or None
            flat |= {("retain", area): [list(each) for each in ranges] for area, ranges in system.retain.items()}
            flat |= {("data_block", name): value for name, value in system.data_block.items()}
            flat |= {("stop_outputs", "mode"): system.stop_outputs}
            flat |= {("stop_outputs", name): value for name, value in system.stop_output_table.items()}
            for name in ("port0", "port1"):
                if (port := getattr(system, name)) is not None:
                    usual = PortSettings()
                    flat |= {
                        (name, key): getattr(port, key) for key in _PORT if key == "protocol" or getattr(port, key) != getattr(usual, key)
                    }
            for place, settings in system.modules.items():
                flat |= {(f"modules.{place}", key): value for key, value in settings.items()} or {(f"modules.{place}", ""): {}}
        if self.passwords is not None:
            flat |= {("passwords", key): getattr(self.passwords, key) for key in _PASSWORDS}
        flat |= {("protected", name): password for name, password in self.protected.items()}
        return {place: value for place, value in flat.items() if value is not None}

    def __repr__(self) -> str:
        count = len(self.files)
        return f"<Project {self.name or 'without a name'}, {self.model or 'any model'}, {count} file{'s' * (count != 1)}>"


# -- texts and paths ------------------------------------------------------------------------------------------------


def _is_path(text: object) -> bool:
    if not isinstance(text, str) or "\n" in text or not text.strip():
        return False
    commented = "//" in text and " " in text.strip()  # a rung with a comment, which may speak of a file
    if text.strip().lower().endswith(".il"):
        return not commented
    return os.path.isdir(text) or (("/" in text or "\\" in text) and "//" not in text and " " not in text.strip())


def _text(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8")
    except FileNotFoundError:
        raise EcsimError(f"there is no file {path}; give the path of an .il file or a project folder") from None
    except UnicodeDecodeError as error:
        raise EcsimError(f"{path} is no UTF-8 text (byte {error.start}); save it as UTF-8") from None
    except (OSError, ValueError) as error:
        raise EcsimError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from None


def replace_files(folder: Path, texts: Mapping[str, str | bytes], gone: list[Path]) -> None:
    """Write all texts beside their places first, then put each into its place and remove what is gone; when that fails, all is as it was."""
    former: dict[Path, bytes | None] = {}  # of the files that have changed already
    waiting: list[tuple[str, Path]] = []
    try:
        for name, text in texts.items():
            target, content = folder / name, text.encode() if isinstance(text, str) else text
            if target.exists() and target.read_bytes() == content:
                continue
            number, temporary = tempfile.mkstemp(dir=folder, prefix=f".{name}.")
            waiting.append((temporary, target))
            with os.fdopen(number, "wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(temporary, target.stat().st_mode if target.exists() else 0o644)
        while waiting:
            temporary, target = waiting[0]
            content = target.read_bytes() if target.exists() else None
            os.replace(temporary, target)
            former[target] = content
            waiting.pop(0)
        for target in gone:
            content = target.read_bytes()
            target.unlink()
            former[target] = content
    except OSError:
        for target, content in former.items():
            target.unlink() if content is None else target.write_bytes(content)
        raise
    finally:
        for temporary, _ in waiting:
            os.unlink(temporary)


# -- TOML -----------------------------------------------------------------------------------------------------------


def _entries(document: dict[str, Any]) -> Iterator[tuple[str, str, Any]]:
    """(table, key, value) of a plc.toml; what stands above the tables has the table ""."""
    for key, value in document.items():
        if key == "modules" and isinstance(value, dict):
            for place, settings in value.items():
                if not isinstance(settings, dict) or not settings:  # a module with nothing to set
                    yield f"modules.{place}", "", settings
                else:
                    yield from ((f"modules.{place}", name, setting) for name, setting in settings.items())
        elif key in _TABLES and isinstance(value, dict):
            yield from ((key, name, setting) for name, setting in value.items())
        else:
            yield "", key, value


def _breaking(entries: list[tuple[str, str, Any]], model: Model, message: str) -> tuple[str, str]:
    """Table and key of the entry with which what stands above it comes to be refused with that message."""
    project = Project({})
    for table, key, value in entries:
        project._set(table, key, value)
        try:
            project.check(model)
        except EcsimError as error:
            if str(error) == message:
                return table, key
    return "", ""


def _known(table: str, key: str, keys: tuple[str, ...]) -> str:
    if key not in keys:
        where = f"[{table}] has" if table else "there is"
        raise EcsimError(f"{where} no setting {key!r}; known are {', '.join(keys)}")
    return key


def _events(value: Any) -> dict[int, str]:
    if not isinstance(value, dict):
        raise EcsimError(f'interrupt_priority is {value!r:.40}; write events and levels, for example {{ 26 = "high" }}')
    return {int(event) if event.isdigit() else event: level for event, level in value.items()}


def _ranges(area: str, value: Any) -> list[tuple[int, int]]:
    """[[first, last], ...] with numbers or names as numbers."""
    if not isinstance(value, list) or not all(isinstance(pair, list) and len(pair) == 2 for pair in value):
        raise EcsimError(f"retain of {area} is {value!r:.40}; write ranges, for example {area} = [[100, 199]]")
    return [(_number(area, first), _number(area, last)) for first, last in value]


def _number(area: str, bound: Any) -> Any:
    named = isinstance(bound, str) and bound.upper().startswith(area) and bound[len(area) :].isdigit()
    return int(bound[len(area) :]) if named else bound


_HEADING = re.compile(r"\s*\[\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"""\s*("[^"]*"|'[^']*'|[\w-]+)\s*[.=]""")


def _line(toml: str, table: str, key: str) -> int:
    """The line, from 1, of an entry, of its table where the entry has none of its own; 0 for neither."""
    heading, best = "", 0
    for number, line in enumerate(toml.splitlines(), 1):
        if (found := _HEADING.match(line)) is not None:
            heading = re.sub(r"[\s\"']", "", found[1])
            best = number if heading == (table or key) else best
        elif (found := _KEY.match(line)) is not None:
            name = found[1].strip("\"'")
            if (heading, name) == (table, key) or f"{heading}.{name}" == table:
                return number
            best = best or (number if not heading and table and name == table.partition(".")[0] else 0)
    return best


def _edited(toml: str, changed: dict[tuple[str, str], Any], gone: list[tuple[str, str]]) -> str:
    """The text with some entries changed, added and removed; all else stays as it stands."""
    try:
        import tomlkit
    except ImportError:
        raise EcsimError("changed settings are written by tomlkit, which is not installed; pip install ecsim[project]") from None
    document = tomlkit.parse(toml)

    def table(name: str) -> Any:
        found = document
        for part in name.split(".") if name else ():
            if part not in found:
                found[part] = tomlkit.table(is_super_table=part == "modules")
            found = found[part]
        return found

    for (name, key), value in changed.items():
        place = table(name)
        if key:
            place[key] = tomlkit.inline_table() | value if isinstance(value, dict) else value
    for name, key in gone:
        if key:
            del table(name)[key]
        kept = any(other == name for other, _ in changed) or len(table(name))
        if name.startswith("modules.") and not kept:
            del document["modules"][name.removeprefix("modules.")]
    return tomlkit.dumps(document)
