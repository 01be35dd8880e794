"""The project speaks of itself alone: no path of anyone's machine, no address of a package registry."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
NOT_TEXT = {".png", ".ico", ".woff2", ".pdf", ".gz"}

# Put together here so that this file does not find itself.
REGISTRIES = [
    ".".join(parts)
    for parts in (
        ("pypi", "org"),
        ("pythonhosted", "org"),
        ("anaconda", "org"),
        ("anaconda", "com"),
        ("npmjs", "org"),
        ("npmjs", "com"),
        ("yarnpkg", "com"),
        ("debian", "org/debian"),
        ("crates", "io"),
        ("jsdelivr", "net"),
        ("unpkg", "com"),
        ("cloudflare", "com"),
    )
]
MACHINE_PATHS = [
    re.compile(pattern)
    for pattern in (
        r"(?<![\w.~/-])/" + r"work/",
        r"(?<![\w.~/-])/" + r"root(?:/|\b(?!:))",
        r"(?<![\w.~/-])/" + r"home/\w",
        r"(?<![\w.~/-])/" + r"Users/\w",
        r"(?<![\w.~/-])/" + r"tmp/\w",
        r"(?i)\b[a-z]:\\{1,2}" + r"users\\",
    )
]


def violations(text):
    """What in a text belongs to one machine or to one registry."""
    found = [host for host in REGISTRIES if host in text.lower()]
    return found + [match.group() for pattern in MACHINE_PATHS for match in [pattern.search(text)] if match]


def text_files():
    """The files that are, or would be, committed."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    try:
        listing = subprocess.run(command, cwd=ROOT, capture_output=True, check=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git checkout")
    paths = [ROOT / name for name in listing.split("\0") if name]
    return [path for path in paths if path.is_file() and path.suffix not in NOT_TEXT]


def test_no_file_names_a_machine_or_a_registry():
    found = {}
    for path in text_files():
        problems = violations(path.read_text(encoding="utf-8"))
        if problems:
            found[str(path.relative_to(ROOT))] = problems
    assert found == {}


@pytest.mark.parametrize(
    "text",
    [
        "cd /" + "work/main",
        'Path("/' + 'root/.cache")',
        "/" + "home/somebody/ecsim",
        "see /" + "Users/somebody/x",
        '"/' + 'tmp/frame.png"',
        "C:\\" + "Users\\somebody",
        '"c:\\\\' + 'users\\\\somebody"',
        "--index-url https://" + REGISTRIES[0] + "/simple",
        "https://files." + REGISTRIES[1] + "/packages",
    ],
)
def test_the_check_sees_a(text):
    assert violations(text) != []


@pytest.mark.parametrize(
    "text",
    ["at /usr/bin", "the root / of a tree", "framework/works", "a/home/x", "~/tmp/x", "http://127.0.0.1:8888/lab/tree/x", "input/output"],
)
def test_the_check_lets_pass(text):
    assert violations(text) == []
