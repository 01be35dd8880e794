"""The floors of the house: a module imports from its own floor or below, and never what it must not know."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

# From the ground up; the modules of one line stand on the same floor.
FLOORS = (
    ("errors", "values"),
    ("devices",),
    ("models",),  # data about devices, and nothing more
    ("memory", "hardware", "comms"),
    ("instructions",),
    ("assembler", "project", "protection", "system", "upload"),
    ("engines", "editing", "saved", "states", "translation", "exchange"),
    ("plc", "programming", "formats", "monitor"),
    ("views", "record", "conditions", "history", "network", "outside", "modbus", "verify", "scenario", "help", "help_spelled", "sensors"),
    ("breakpoints", "session"),
    ("grading",),
    ("cli", "terminal", "pytest_plugin", "__init__", "__main__"),
)
FLOOR_OF = {module: floor for floor, modules in enumerate(FLOORS) for module in modules}

# ecsim is standard library alone, but for these parts of it.
ALLOWED = {"record": {"numpy", "matplotlib"}, "history": {"numpy"}, "modbus": {"pymodbus"}, "project": {"tomlkit"}, "terminal": {"rich"}}
ALLOWED |= {"grading": {"distributed"}, "pytest_plugin": {"pytest"}}
WALL_CLOCK = "time"  # only session reads it

# folder -> import name; neither may know the other's insides
INSTALLED_AS = {"widgets": "ecsim_widgets", "exercises": "ecsim_exercises"}
EVERYWHERE = ("ecsim", "widgets", "exercises", "tests", "bench", "docs")


def imports(path, package):
    """Yield (line, dotted name, whether it runs) for what a file imports; `from a import b` gives a.b, relative ones are resolved.

    Below `if TYPE_CHECKING:` an import does not run: it names the type of an argument and makes no cycle.
    """
    tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
    guarded = [
        node for node in ast.walk(tree) if isinstance(node, ast.If) and ast.unparse(node.test) in ("TYPE_CHECKING", "typing.TYPE_CHECKING")
    ]
    for_types = {id(inner) for node in guarded for statement in node.body for inner in ast.walk(statement)}
    for node in ast.walk(tree):
        runs = id(node) not in for_types
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name, runs
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            stem = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                yield node.lineno, f"{stem}.{alias.name}", runs


def python_files(root, folder):
    """Yield (path, parts of the package it is in) for every Python file below a folder."""
    for path in sorted((root / folder).rglob("*.py")):
        if "__pycache__" not in path.parts and ".ipynb_checkpoints" not in path.parts:
            yield path, (INSTALLED_AS.get(folder, folder), *path.relative_to(root / folder).parent.parts)


def module_of(root, dotted):
    """The module of ecsim that a dotted name reaches: `ecsim.plc.Plc` -> plc, `ecsim.Plc` -> __init__."""
    parts = dotted.split(".")
    if len(parts) == 1:
        return "__init__"
    known = parts[1] in FLOOR_OF or (root / "ecsim" / parts[1]).is_dir() or (root / "ecsim" / f"{parts[1]}.py").is_file()
    return parts[1] if known else "__init__"


def violations(root):
    """Return a line for every import that goes up the floors, across the house or out of it."""
    found = []
    for folder in EVERYWHERE:
        for path, package in python_files(root, folder):
            for line, name, runs in imports(path, package):
                place = f"{path.relative_to(root).as_posix()}:{line}"
                found += [f"{place}: {why}" for why in wrong_for_all(name)]
                if folder == "ecsim":
                    found += [f"{place}: {why}" for why in wrong_in_ecsim(root, path, name, runs)]
                if folder in INSTALLED_AS:
                    found += [f"{place}: {why}" for why in wrong_between_neighbours(folder, name)]
    return found


def wrong_for_all(name):
    """What no file may import."""
    top = name.split(".")[0]
    if top == "notebooks":
        yield f"imports {name}: nothing imports notebooks"
    if top in INSTALLED_AS:
        yield f"imports {name}: the folder {top} is imported as {INSTALLED_AS[top]}"


def wrong_in_ecsim(root, path, name, runs):
    """What a module of ecsim may not import."""
    inside = path.relative_to(root / "ecsim")
    module = inside.parts[0].removesuffix(".py")
    top = name.split(".")[0]
    if module not in FLOOR_OF:
        yield f"{module} has no floor: give it its place in FLOORS"
    elif top == "ecsim":
        target = module_of(root, name)
        if target not in FLOOR_OF:
            yield f"{target} has no floor: give it its place in FLOORS"
        elif runs and FLOOR_OF[target] > FLOOR_OF[module]:
            yield f"{module} imports {target}, which stands above it"
    elif top not in sys.stdlib_module_names and top not in ALLOWED.get(module, ()):
        yield f"{module} imports {top}, which is not in the standard library"
    elif top == WALL_CLOCK and FLOOR_OF[module] < FLOOR_OF["session"]:
        yield f"{module} imports {top}: only session reads the wall clock"


def wrong_between_neighbours(folder, name):
    """What widgets may not import of exercises, and the other way round."""
    (neighbour,) = [package for other, package in INSTALLED_AS.items() if other != folder]
    if name.startswith(f"{neighbour}.") and name.count(".") > 1:
        yield f"imports {name}: {folder} know nothing of the inside of {neighbour}"


def test_the_house_stands():
    assert violations(ROOT) == []


def test_the_check_has_read_the_house():
    read = [path for folder in EVERYWHERE for path, package in python_files(ROOT, folder)]
    assert ROOT / "ecsim" / "__init__.py" in read
    assert Path(__file__).resolve() in read


def test_every_floor_is_named_once():
    assert len(FLOOR_OF) == sum(len(modules) for modules in FLOORS)


def test_ecsim_runs_on_the_standard_library_alone():
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); import ecsim; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "ecsim" in done.stdout.split()


@pytest.fixture
def house(tmp_path):
    """A small house without a fault, built from the ground up."""
    build = {
        "ecsim/__init__.py": "from ecsim.plc import Plc",
        "ecsim/errors.py": "import re\nimport datetime\nfrom typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .plc import Plc",
        "ecsim/plc.py": "from ecsim import errors\nfrom .errors import Fault\nfrom .hardware.clock import Clock",
        "ecsim/hardware/__init__.py": "",
        "ecsim/hardware/clock.py": "from ..errors import Fault\nfrom . import timers",
        "ecsim/hardware/timers.py": "",
        "ecsim/record.py": "def array():\n    import numpy\n    return numpy",
        "ecsim/modbus/slave.py": "from pymodbus.server import StartServer\nfrom ..plc import Plc",
        "ecsim/session.py": "import time",
        "widgets/lab.py": "import anywidget\nimport ecsim\nfrom ecsim_widgets.panel import Panel\nimport ecsim_exercises",
        "exercises/conveyor/plant.py": "from ecsim.plc import Plc\nfrom ecsim_exercises.conveyor import picture",
        "tests/test_plc.py": "import ecsim_exercises.conveyor.plant\nimport pytest",
    }
    for name, text in build.items():
        write(tmp_path / name, text)
    return tmp_path


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def test_a_sound_house_passes(house):
    assert violations(house) == []


@pytest.mark.parametrize(
    ("name", "text", "complaint"),
    [
        ("ecsim/devices.py", "from ecsim.plc import Plc", "ecsim/devices.py:1: devices imports plc, which stands above it"),
        ("ecsim/devices.py", "import ecsim.plc", "ecsim/devices.py:1: devices imports plc, which stands above it"),
        ("ecsim/devices.py", "from .plc import Plc", "ecsim/devices.py:1: devices imports plc, which stands above it"),
        ("ecsim/devices.py", "from . import plc", "ecsim/devices.py:1: devices imports plc, which stands above it"),
        ("ecsim/devices.py", "from ecsim import plc", "ecsim/devices.py:1: devices imports plc, which stands above it"),
        ("ecsim/devices.py", "from ecsim import Plc", "ecsim/devices.py:1: devices imports __init__, which stands above it"),
        (
            "ecsim/devices.py",
            "import typing\nif not typing.TYPE_CHECKING:\n    x = 1\nelse:\n    pass\nif True:\n    from .plc import Plc",
            "ecsim/devices.py:7: devices imports plc, which stands above it",
        ),
        (
            "ecsim/devices.py",
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    x = 1\nelse:\n    from .plc import Plc",
            "ecsim/devices.py:5: devices imports plc, which stands above it",
        ),
        ("ecsim/devices.py", "import ecsim", "ecsim/devices.py:1: devices imports __init__, which stands above it"),
        (
            "ecsim/hardware/pulse.py",
            "\ndef late():\n    from ...ecsim import plc\n    from ..plc import Plc",
            "ecsim/hardware/pulse.py:4: hardware imports plc, which stands above it",
        ),
        ("ecsim/models/ec.py", "from ..assembler.parse import x", "ecsim/models/ec.py:1: models imports assembler, which stands above it"),
        ("ecsim/plc.py", "import numpy", "ecsim/plc.py:1: plc imports numpy, which is not in the standard library"),
        ("ecsim/record.py", "import pymodbus", "ecsim/record.py:1: record imports pymodbus, which is not in the standard library"),
        ("ecsim/modbus/x.py", "import numpy as np", "ecsim/modbus/x.py:1: modbus imports numpy, which is not in the standard library"),
        (
            "ecsim/views/x.py",
            "from IPython.display import SVG",
            "ecsim/views/x.py:1: views imports IPython, which is not in the standard library",
        ),
        (
            "ecsim/cli.py",
            "from ecsim_exercises import conveyor",
            "ecsim/cli.py:1: cli imports ecsim_exercises, which is not in the standard library",
        ),
        ("ecsim/plc.py", "from time import monotonic", "ecsim/plc.py:1: plc imports time: only session reads the wall clock"),
        ("ecsim/gadgets.py", "import re", "ecsim/gadgets.py:1: gadgets has no floor: give it its place in FLOORS"),
        ("ecsim/plc.py", "import notebooks.demo", "ecsim/plc.py:1: imports notebooks.demo: nothing imports notebooks"),
        ("tests/test_x.py", "from notebooks import a", "tests/test_x.py:1: imports notebooks.a: nothing imports notebooks"),
        ("bench/x.py", "from widgets import lab", "bench/x.py:1: imports widgets.lab: the folder widgets is imported as ecsim_widgets"),
        (
            "widgets/x.py",
            "from ecsim_exercises.conveyor import plant",
            "widgets/x.py:1: imports ecsim_exercises.conveyor.plant: widgets know nothing of the inside of ecsim_exercises",
        ),
        (
            "exercises/conveyor/picture.py",
            "from ecsim_widgets.lab import Lab",
            "exercises/conveyor/picture.py:1: imports ecsim_widgets.lab.Lab: exercises know nothing of the inside of ecsim_widgets",
        ),
    ],
)
def test_a_fault_is_found(house, name, text, complaint):
    write(house / name, text)
    assert complaint in violations(house)
