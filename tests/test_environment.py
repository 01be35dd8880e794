"""pyproject.toml, constraints.txt, environment.yml and what is installed say the same."""

import importlib
import platform
import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import yaml
from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).resolve().parent.parent
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
ENVIRONMENT = yaml.safe_load((ROOT / "environment.yml").read_text(encoding="utf-8"))
PIN = re.compile(r"([a-z0-9]+(?:-[a-z0-9]+)*)==([^\s;]+)(?: ; (.+))?")
FOLDERS = {"ecsim": "ecsim", "ecsim_widgets": "widgets", "ecsim_exercises": "exercises"}


def requirement_lines():
    """Every requirement that pyproject.toml states, with the place where it stands."""
    project = PYPROJECT["project"]
    groups = {"build": PYPROJECT["build-system"]["requires"], "dependencies": project["dependencies"]}
    groups |= project["optional-dependencies"] | PYPROJECT["dependency-groups"]
    return [(place, line) for place, lines in groups.items() for line in lines]


def pin_lines():
    """The lines of constraints.txt that are not comments."""
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.lstrip().startswith("#")]


def pins():
    """Name -> version of the pins that hold on this Python and this system."""
    found = {}
    for line in pin_lines():
        name, version, marker = PIN.fullmatch(line).groups()
        if marker is None or Marker(marker).evaluate():
            found[name] = Version(version)
    return found


def installed_closure(name, extras):
    """Name -> installed version of a distribution with some extras and all that they need here."""
    found, waiting = {}, [(name, frozenset(extras))]
    seen = set()
    while waiting:
        name, extras = waiting.pop()
        if (name, extras) in seen:
            continue
        seen.add((name, extras))
        distribution = metadata.distribution(name)
        found[canonicalize_name(name)] = Version(distribution.version)
        for line in distribution.requires or []:
            requirement = Requirement(line)
            wanted = [requirement.marker.evaluate({"extra": extra}) for extra in extras or [""]] if requirement.marker else [True]
            if any(wanted):
                waiting.append((requirement.name, frozenset(requirement.extras)))
    return found


@pytest.mark.parametrize(("place", "line"), requirement_lines())
def test_every_requirement_is_pinned_within_its_range(place, line):
    requirement = Requirement(line)
    version = pins().get(canonicalize_name(requirement.name))
    assert version is not None, f"{place}: {line} has no pin in constraints.txt"
    assert requirement.specifier.contains(version), f"{place}: the pin {version} is outside {line}"


@pytest.mark.parametrize(("place", "line"), requirement_lines())
def test_every_requirement_has_a_range_and_no_address(place, line):
    requirement = Requirement(line)
    assert requirement.url is None
    assert requirement.specifier, f"{place}: {line} takes any version"


def test_every_pin_is_one_exact_version():
    assert [line for line in pin_lines() if not PIN.fullmatch(line)] == []


def test_no_name_has_two_pins():
    names = [PIN.fullmatch(line).group(1) for line in pin_lines()]
    assert [name for name in names if names.count(name) > 1] == []


def test_the_whole_installed_closure_has_the_pinned_versions(lab):
    pinned = pins()
    installed = installed_closure("ecsim", lab.EXTRAS.split(","))
    del installed["ecsim"]
    assert len(installed) > 80  # the walk has followed JupyterLab's needs
    assert {name: version for name, version in installed.items() if pinned.get(name) != version} == {}


def test_conda_gets_the_same_range_of_python():
    (line,) = [line for line in ENVIRONMENT["dependencies"] if isinstance(line, str) and line.split()[0] == "python"]
    assert SpecifierSet(line.removeprefix("python")) == SpecifierSet(PYPROJECT["project"]["requires-python"])


def test_this_python_is_in_the_range():
    assert SpecifierSet(PYPROJECT["project"]["requires-python"]).contains(platform.python_version())


def test_conda_gets_the_same_dependencies_by_the_same_pins(lab):
    assert [line.split()[0] for line in ENVIRONMENT["dependencies"] if isinstance(line, str)] == ["python", "pip"]
    (by_pip,) = [entry["pip"] for entry in ENVIRONMENT["dependencies"] if isinstance(entry, dict)]
    assert by_pip == ["--constraint constraints.txt", f"--editable .[{lab.EXTRAS}]"]
    assert set(lab.EXTRAS.split(",")) <= set(PYPROJECT["project"]["optional-dependencies"])


def test_conda_gets_its_packages_by_a_channel_name():
    assert ENVIRONMENT["channels"] == ["conda-forge"]


@pytest.mark.parametrize(("package", "folder"), FOLDERS.items())
def test_each_folder_is_installed_under_its_import_name(package, folder):
    module = importlib.import_module(package)
    assert Path(module.__file__).resolve() == ROOT / folder / "__init__.py"


def test_every_package_below_the_folders_can_be_found():
    missing = []
    for package, folder in FOLDERS.items():
        for init in sorted((ROOT / folder).rglob("__init__.py")):
            name = ".".join([package, *init.relative_to(ROOT / folder).parent.parts])
            found = importlib.util.find_spec(name)
            if found is None or Path(found.origin).resolve() != init:
                missing.append(name)
    assert missing == []


def test_the_console_script_is_installed():
    (script,) = [entry for entry in metadata.entry_points(group="console_scripts") if entry.name == "ecsim"]
    assert script.value == "ecsim.cli:main"
