"""A PLC in a file: a zip of its program's texts and of its state as JSON (docs/saving.md). Opening one executes nothing that it holds."""

import contextlib
import hashlib
import importlib
import io
import json
import os
import pkgutil
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any

from . import devices, hardware, protection, system
from .assembler import Instruction, Program, Region
from .errors import EcsimError

FORMAT, VERSION = "ecsim PLC", 1
HEAD, STATE, PROGRAM = "ecsim.json", "state.json", "program/"
LARGEST = 64 << 20  # bytes of one part, unpacked
_PLAIN = (type(None), bool, int, float, str)
_DATE = (1980, 1, 1, 0, 0, 0)  # the same state gives the same file


@cache
def _kept_classes() -> dict[str, type]:
    """The values that a state may hold besides numbers and texts: the dataclasses of the devices, the system block and the hardware."""
    modules = [
        devices,
        protection,
        system,
        *(importlib.import_module(f"{hardware.__name__}.{each.name}") for each in pkgutil.iter_modules(hardware.__path__)),
    ]
    return {kind.__name__: kind for module in modules for kind in vars(module).values() if isinstance(kind, type) and is_dataclass(kind)}


def places(program: Program) -> list[int]:
    """Where a program's instructions and steps remember what they do; a change in RUN (2.4.3) gives them other places than a download."""
    return [program.slots, *(getattr(owner, name) for owner, name in _owners(program))]


def put_places(program: Program, numbers: list[int]) -> None:
    """Give a program the places that `places` told."""
    program.slots, *others = numbers
    for (owner, name), number in zip(_owners(program), others, strict=True):
        setattr(owner, name, number)


def _owners(program: Program) -> Iterator[tuple[Instruction | Region, str]]:
    for unit in program.units:
        yield from ((instruction, name) for instruction in unit.instructions for name in ("slot", "pulse"))
        waiting = list(unit.nodes)
        while waiting:
            node = waiting.pop()
            if isinstance(node, Region):
                waiting += node.nodes
                yield node, "slot"


# -- values -----------------------------------------------------------------------------------------------------------


def encode(value: Any) -> Any:
    """A value as JSON can hold it and `decode` gives it back, type and all; raises EcsimError for what is no plain data."""
    if type(value) in _PLAIN:
        return value
    if type(value) is list:
        return [encode(each) for each in value]
    if type(value) is dict:
        return {"dict": [[encode(key), encode(each)] for key, each in value.items()]}
    if type(value) in (set, frozenset):
        return {type(value).__name__: [encode(each) for each in sorted(value)]}
    if type(value) is tuple:
        return {"tuple": [encode(each) for each in value]}
    if type(value) is bytes:
        return {"bytes": value.hex()}
    if _kept_classes().get(type(value).__name__) is type(value):
        return {"object": [type(value).__name__, {field.name: encode(getattr(value, field.name)) for field in fields(value)}]}
    if callable(link := getattr(value, "link", None)):
        return {"link": encode(link())}
    raise EcsimError(f"{value!r:.60} cannot be kept in a file; it is a {type(value).__name__}, no plain data")


def decode(value: Any, linked: Callable[[Any], Any] | None = None) -> Any:
    """What `encode` was given; `linked` finds what a link stands for. Raises ValueError and the like for anything else."""
    if type(value) in _PLAIN:
        return value
    if type(value) is list:
        return [decode(each, linked) for each in value]
    ((tag, inside),) = value.items()
    if tag == "dict":
        return {decode(key, linked): decode(each, linked) for key, each in inside}
    if tag in _GROUPS:
        return _GROUPS[tag](decode(each, linked) for each in inside)
    if tag == "bytes":
        return bytes.fromhex(inside)
    if tag == "link":
        return linked(decode(inside, linked))
    if tag != "object":
        raise ValueError(f"there is no kind of value {tag!r}")
    name, given = inside
    return _kept_classes()[name](**{field: decode(each, linked) for field, each in given.items()})


_GROUPS = {"tuple": tuple, "set": set, "frozenset": frozenset}


# -- files ------------------------------------------------------------------------------------------------------------


def write(path: str | Path, texts: dict[str, str], state: dict[str, Any]) -> None:
    """Put texts and state into a file, as a whole: until it is complete, the former file stays. Raises EcsimError when that fails."""
    body = json.dumps({name: encode(part) for name, part in state.items()}, separators=(",", ":"))
    parts = {STATE: body, **{f"{PROGRAM}{name}": text for name, text in texts.items()}}
    head = {"format": FORMAT, "version": VERSION, "sha256": _digest({name: text.encode() for name, text in parts.items()})}
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in {HEAD: json.dumps(head), **parts}.items():
            archive.writestr(zipfile.ZipInfo(name, _DATE), text, zipfile.ZIP_DEFLATED)
    try:
        _replace(Path(path), packed.getvalue())
    except OSError as error:
        raise EcsimError(f"{path} cannot be written: {error.strerror or error}; the former file is as it was") from None


def _digest(parts: dict[str, bytes]) -> str:
    """One checksum over all parts, with their names."""
    found = hashlib.sha256()
    for name, content in sorted(parts.items()):
        found.update(f"{len(name)} {name} {len(content)} ".encode())
        found.update(content)
    return found.hexdigest()


def _replace(path: Path, content: bytes) -> None:
    """Write a file so that at any moment either the former or the new one is there, complete."""
    folder = path.resolve().parent
    number, temporary = tempfile.mkstemp(dir=folder, prefix=f".{path.name}.", suffix=".new")
    try:
        with os.fdopen(number, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            os.chmod(temporary, path.stat().st_mode & 0o777)
        os.replace(temporary, path.resolve())
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        raise
    with contextlib.suppress(OSError):  # where a folder can be opened, its entry is made sure as well
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


@contextlib.contextmanager
def reading(path: str | Path) -> Iterator[tuple[dict[str, str], dict[str, Any]]]:
    """The texts of a file and its state, still encoded; what cannot be done with them is an EcsimError too."""
    texts, state = _read(path)
    try:
        yield texts, state
    except (LookupError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise EcsimError(f"{path} was written by another ecsim, which keeps other things: {type(error).__name__}: {error}") from None


def _read(path: str | Path) -> tuple[dict[str, str], dict[str, Any]]:
    try:
        content = Path(path).read_bytes()
    except FileNotFoundError:
        raise EcsimError(f"there is no file {path}; Plc.save(path) writes one") from None
    except (OSError, ValueError) as error:
        raise EcsimError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    parts = _unpacked(path, content)
    head = _parsed(path, parts.pop(HEAD, b"null"))
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise EcsimError(f"{path} holds no PLC; open a file that Plc.save has written")
    if head.get("version") != VERSION:
        raise EcsimError(
            f"{path} has version {head.get('version')!r}, this ecsim reads version {VERSION}; save it again with an ecsim of its own"
        )
    if head.get("sha256") != _digest(parts) or STATE not in parts:
        raise EcsimError(f"{path} is damaged or was changed by hand: its checksum is wrong; take another copy of it")
    texts = {name.removeprefix(PROGRAM): content.decode() for name, content in parts.items() if name.startswith(PROGRAM)}
    return texts, _parsed(path, parts[STATE])


def _unpacked(path: str | Path, content: bytes) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            if any(entry.file_size > LARGEST for entry in entries):
                raise EcsimError(f"{path} is too large: a part of it would unpack to more than {LARGEST >> 20} MB")
            return {entry.filename: archive.read(entry) for entry in entries}
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, RuntimeError, LookupError, OverflowError) as error:
        raise EcsimError(f"{path} is no file of a PLC, or it is damaged: {error}; take another copy of it") from None


def _parsed(path: str | Path, text: bytes) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise EcsimError(f"{path} is damaged: {error}; take another copy of it") from None
