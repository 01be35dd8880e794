#!/usr/bin/env python3
"""The one command of the project: makes the environment it needs, then opens the lab or runs the tests.

    python3 lab.py                    JupyterLab on the first notebook
    python3 lab.py setup              only make or refresh the environment in .venv
    python3 lab.py test               everything that must hold: style, tests, notebooks, browser

The standard library is all it uses, so that it runs where nothing is installed yet.
"""

import sys

if sys.version_info < (3, 11):
    sys.exit("ecsim needs Python 3.11 or newer; this is Python %d.%d (%s)." % (*sys.version_info[:2], sys.executable))

import argparse
import ast
import hashlib
import importlib.util
import os
import re
import secrets
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
PYTHON = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
STAMP = VENV / "ecsim-installed"
EXTRAS = "lab,test"
INSTALLED_FROM = ("pyproject.toml", "constraints.txt", "setup.py")

FIRST_NOTEBOOK = "notebooks/01-first-light.ipynb"
FIRST_PORT = 8888
START_TIMEOUT_S = 120

# uv does not read pip's settings; these have a counterpart.
PIP_TO_UV = {
    "index-url": "UV_DEFAULT_INDEX",
    "extra-index-url": "UV_INDEX",
    "trusted-host": "UV_INSECURE_HOST",
    "proxy": "ALL_PROXY",
    "cert": "SSL_CERT_FILE",
}

CHROMIUM_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
CHROMIUM_PLACES = (
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "${ProgramFiles}/Google/Chrome/Application/chrome.exe",
)
NO_CHROMIUM = "no Chromium found (apt install chromium, or set ECSIM_CHROMIUM to one)"


class LabError(Exception):
    """What keeps the command from going on, in words for the person who gave it."""


def main(arguments=None):
    """Run the command line; return the exit code."""
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    own, pytest_arguments = split_at_dashes(arguments)
    options = command_line().parse_args(own)
    if pytest_arguments and options.command != "test":
        raise LabError("Arguments after -- go to pytest: python3 lab.py test -- " + " ".join(pytest_arguments))
    make_environment()
    if options.command == "setup":
        return 0
    if options.command == "test":
        return run_tests(options.quick, options.k, pytest_arguments)
    return open_lab(options.port, options.browser)


def split_at_dashes(arguments):
    """Return the arguments before and after the first `--`."""
    if "--" not in arguments:
        return arguments, []
    cut = arguments.index("--")
    return arguments[:cut], arguments[cut + 1 :]


def command_line():
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="lab.py", description="Open the ecsim lab in JupyterLab, or run its tests.")
    parser.add_argument("--no-browser", dest="browser", action="store_false", help="print the address, open no browser")
    parser.add_argument("--port", type=int, help=f"the port to use (otherwise the first free one from {FIRST_PORT} on)")
    commands = parser.add_subparsers(dest="command", metavar="{setup,test}")
    commands.add_parser("setup", help="make or refresh the environment in .venv and stop there")
    test = commands.add_parser("test", help="run style checks, tests, notebooks and the browser test")
    test.add_argument("--quick", action="store_true", help="only what takes seconds: no slow tests, no notebooks, no browser")
    test.add_argument("-k", metavar="EXPRESSION", help="only the tests whose names match, as in pytest")
    return parser


def say(text):
    """Print one line at once, also into a pipe."""
    print(text, flush=True)


# ---------------------------------------------------------------------- the environment


def make_environment():
    """Leave a .venv that holds what pyproject.toml and constraints.txt ask for; do nothing when it does already."""
    stamp = environment_stamp()
    if usable(PYTHON) and STAMP.is_file() and STAMP.read_text() == stamp:
        place_extension()
        return
    started = time.monotonic()
    uv = shutil.which("uv")
    say("ecsim: making the environment in .venv (once; about half a minute and 600 MB)")
    if not usable(PYTHON):
        create_venv(uv)
    STAMP.unlink(missing_ok=True)
    install(uv)
    place_extension()
    STAMP.write_text(stamp)
    say(f"ecsim: the environment is ready after {time.monotonic() - started:.0f} s")


def place_extension():
    """Copy JupyterLab's extension into .venv, as it is now: an editable installation leaves out what is no package."""
    import tomllib  # Python 3.11, which was asked for before

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    for folder, names in project["tool"]["setuptools"]["data-files"].items():
        target = VENV / folder
        target.mkdir(parents=True, exist_ok=True)
        for name in names:
            shutil.copyfile(ROOT / name, target / Path(name).name)


def environment_stamp():
    """Return a text that changes when the environment has to be installed again."""
    digest = hashlib.sha256(str(ROOT).encode())  # a moved project has to be installed at its new place
    for name in INSTALLED_FROM:
        digest.update((ROOT / name).read_bytes())
    return digest.hexdigest()


def usable(python):
    """Tell whether a Python runs, is new enough and has pip."""
    probe = "import sys, pip; sys.exit(sys.version_info < (3, 11))"
    try:
        return subprocess.run([python, "-c", probe], capture_output=True, cwd=ROOT).returncode == 0
    except OSError:
        return False


def create_venv(uv):
    """Create .venv, anew when a broken one stands there."""
    base = getattr(sys, "_base_executable", None) or sys.executable
    say(f"  [1/2] a virtual environment with Python {sys.version_info[0]}.{sys.version_info[1]} ({base})")
    if uv:
        if VENV.exists():
            shutil.rmtree(VENV)
        command = [uv, "venv", "--quiet", "--seed", "--python", base, str(VENV)]
    else:
        missing = [name for name in ("venv", "ensurepip") if importlib.util.find_spec(name) is None]
        if missing:
            raise LabError(without_venv(missing))
        command = [base, "-m", "venv", "--clear", str(VENV)]
    if run(command) != 0:
        raise LabError(without_venv([]))


def without_venv(missing):
    """Say what to do where Python cannot make a virtual environment."""
    what = f"its module {' and '.join(missing)} is missing" if missing else "see the lines above"
    return "\n".join(
        [
            f"This Python ({sys.executable}) cannot make a virtual environment: {what}.",
            "  Debian, Ubuntu:  apt install python3-venv    (as root, or with sudo)",
            "  elsewhere:       install Python 3.11 or newer with pip and venv, or install uv, which needs neither",
            "Then give the same command again.",
        ]
    )


def install(uv):
    """Install the project and what it needs into .venv, with uv where that can be had and with pip otherwise."""
    pip = [str(PYTHON), "-m", "pip", "install", "--disable-pip-version-check"]
    uv_command = [uv] if uv else fetch_uv(pip)
    what = ["--constraint", "constraints.txt", "--editable", f".[{EXTRAS}]"]
    say(f"  [2/2] ecsim with {EXTRAS.replace(',', ' and ')}, the versions in constraints.txt, by {'uv' if uv_command else 'pip'}")
    if uv_command:
        by_uv = [*uv_command, "pip", "install", "--python", str(PYTHON), "--build-constraint", "constraints.txt", *what]
        if run(by_uv, uv_settings()) == 0:
            return
        say("  uv did not finish; once more with pip")
    # Which of the two names pip obeys while it builds depends on its age.
    if run([*pip, *what], {"PIP_CONSTRAINT": "constraints.txt", "PIP_BUILD_CONSTRAINT": "constraints.txt"}) != 0:
        raise LabError("The installation did not finish: see the lines above. Is the network there, and space on the disk?")


def fetch_uv(pip):
    """Let pip install uv, which halves the time of the rest; return its command, or [] where there is none."""
    got = run([*pip, "--quiet", "--constraint", "constraints.txt", "uv"])
    return [str(PYTHON), "-m", "uv"] if got == 0 else []


def uv_settings():
    """Return pip's settings (a mirror, a proxy, a certificate) in uv's names, where uv has none of its own."""
    listing = subprocess.run([str(PYTHON), "-m", "pip", "config", "list"], capture_output=True, text=True, cwd=ROOT).stdout
    settings = {}
    for name, value in re.findall(r"^(?:global|install|:env:)\.([a-z-]+)=(.*)$", listing, re.MULTILINE):
        if name in PIP_TO_UV and not os.environ.get(PIP_TO_UV[name]):
            settings[PIP_TO_UV[name]] = " ".join(ast.literal_eval(value).split())
    return settings


def run(command, environment=None):
    """Run a command in the project's folder with its output shown; return its exit code."""
    try:
        return subprocess.run(command, cwd=ROOT, env={**os.environ, **(environment or {})}, stdin=subprocess.DEVNULL).returncode
    except OSError as error:
        say(f"  {command[0]}: {error.strerror}")
        return 127


def inside(**more):
    """Return the environment variables of a program that runs in .venv."""
    variables = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
    path = os.pathsep.join([str(PYTHON.parent), variables.get("PATH", os.defpath)])
    return {**variables, "VIRTUAL_ENV": str(VENV), "PATH": path, **more}


# ---------------------------------------------------------------------- the lab


def open_lab(port, browser):
    """Start JupyterLab on the first notebook, tell its address once it answers, and stay until it ends."""
    port = chosen_port(port)
    token = secrets.token_hex(24)
    page = f"lab/tree/{FIRST_NOTEBOOK}" if (ROOT / FIRST_NOTEBOOK).is_file() else "lab"
    say(f"ecsim: starting JupyterLab on port {port}")
    # The token goes by the environment: command lines can be read by everyone on the machine.
    # labconfig/ holds the settings that the lab starts with; the person's own come before them.
    settings = os.pathsep.join(filter(None, [os.environ.get("JUPYTER_CONFIG_PATH"), str(ROOT)]))
    environment = inside(JUPYTER_TOKEN=token, JUPYTER_CONFIG_PATH=settings)
    server = subprocess.Popen(server_command(port, page, browser and can_show_a_browser()), cwd=ROOT, env=environment)
    # A Ctrl-C reaches the server too, which asks before it stops; here it would only part the two.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: server.terminate())
    wait_until_it_answers(server, port, token)
    say(f"ecsim: JupyterLab is ready at\n\n    http://127.0.0.1:{port}/{page}?token={token}\n")
    say("Ctrl-C twice stops it.")
    return max(server.wait(), 0)


def server_command(port, page, browser):
    """Return the command that serves JupyterLab to this machine alone."""
    command = [str(PYTHON), "-m", "jupyterlab", "--ServerApp.ip=127.0.0.1", f"--ServerApp.port={port}", "--ServerApp.port_retries=0"]
    command += [f"--ServerApp.root_dir={ROOT}", f"--LabApp.default_url=/{page}", "--Application.log_level=WARN"]
    command += [f"--ServerApp.open_browser={browser}", "--LanguageServerManager.autodetect=False"]  # that search starts npm and others
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        command.append("--allow-root")  # Jupyter refuses root otherwise, and a container has no one else
    return command


def chosen_port(port):
    """Return the port asked for, or the first free one; raise LabError where it is taken."""
    if port is not None:
        if not is_free(port):
            raise LabError(f"Port {port} is in use or not allowed; choose another one, or leave --port out to get a free one.")
        return port
    return next(port for port in range(FIRST_PORT, 65536) if is_free(port))


def is_free(port):
    """Tell whether this machine's loopback address has nothing on a port."""
    with socket.socket() as probe:
        if os.name != "nt":
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except (OSError, OverflowError):
            return False
    return True


def can_show_a_browser():
    """Tell whether there is a screen to open a browser on."""
    if os.environ.get("CI"):
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))


def wait_until_it_answers(server, port, token):
    """Return when the server answers; raise LabError when it has ended or takes too long."""
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # no proxy stands before loopback
    request = urllib.request.Request(f"http://127.0.0.1:{port}/api/status", headers={"Authorization": f"token {token}"})
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline:
        if server.poll() is not None:
            raise LabError(f"JupyterLab ended with code {server.returncode} before it answered: see the lines above.")
        try:
            with opener.open(request, timeout=5):
                return
        except (urllib.error.URLError, OSError):
            time.sleep(0.2)
    server.terminate()
    raise LabError(f"JupyterLab did not answer within {START_TIMEOUT_S} s.")


# ---------------------------------------------------------------------- the tests


@dataclass
class Part:
    """One part of the tests: what runs, or why it does not; `may_be_empty` where having no test is no failure."""

    name: str
    command: list
    skipped: str = ""
    may_be_empty: str = ""
    passed: bool = True
    seconds: float = 0.0
    failures: tuple = ()

    def outcome(self):
        """Return the part's line in the closing table, and one for each test that failed."""
        if self.skipped:
            return f"  {self.name:<10} skipped            {self.skipped}"
        line = f"  {self.name:<10} {'passed' if self.passed else 'FAILED'}  {self.seconds:6.1f} s"
        return "\n".join([line, *(f"             {name}" for name in self.failures)])


def run_tests(quick=False, expression=None, pytest_arguments=()):
    """Run every part of the tests, tell which ran and which did not; return 1 when one failed."""
    parts = test_parts(quick, expression, list(pytest_arguments))
    with tempfile.TemporaryDirectory(prefix="ecsim-test-") as home:
        environment = test_environment(home)
        for part in parts:
            if not part.skipped:
                run_part(part, environment, Path(home) / f"{part.name}.xml")
    failed = [part.name for part in parts if not part.passed]
    say("\n" + "\n".join(part.outcome() for part in parts))
    say(f"ecsim: FAILED: {', '.join(failed)}" if failed else "ecsim: all that ran has passed")
    return 1 if failed else 0


def test_parts(quick, expression, pytest_arguments):
    """Return the parts of the tests in the order in which they run, each with its reason where it is left out."""
    python = str(PYTHON)
    pytest = [python, "-m", "pytest"]
    if expression or pytest_arguments:
        chosen = [*(["-k", expression] if expression else []), *(["-m", "not slow and not browser"] if quick else [])]
        return [Part("tests", [*pytest, *chosen, *pytest_arguments])]
    left_out = "left out by --quick" if quick else ""
    several = ["-n", str(min(os.cpu_count() or 1, 8)), "--dist", "loadfile"]
    nbval = ["--nbval", "--nbval-current-env", "--nbval-cell-timeout=120"]
    no_notebooks = "" if any((ROOT / "notebooks").glob("*.ipynb")) else "no notebook in notebooks/"
    no_chromium = "" if find_chromium() else NO_CHROMIUM
    return [
        Part("style", [python, "-m", "ruff", "check", "."]),
        Part("format", [python, "-m", "ruff", "format", "--check", "."]),
        Part("tests", [*pytest, *several, "-m", "not browser and not slow" if quick else "not browser"]),
        Part("notebooks", [*pytest, *several, *nbval, "notebooks"], skipped=left_out or no_notebooks),
        Part("browser", [*pytest, "-m", "browser"], skipped=left_out or no_chromium, may_be_empty="no test is marked browser"),
    ]


def run_part(part, environment, report):
    """Run one part with its output shown and note how it ended; pytest writes its report to a file, which tells the tests that failed."""
    say(f"\n--- {part.name}: {' '.join(part.command[1:])}")
    started = time.monotonic()
    command = [*part.command, f"--junitxml={report}"] if "pytest" in part.command else part.command
    code = subprocess.run(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL).returncode
    part.seconds = time.monotonic() - started
    if code == 5 and part.may_be_empty:  # pytest: no test collected
        part.skipped = part.may_be_empty
    else:
        part.passed = code == 0
    if not part.passed and report.is_file():
        part.failures = failures_in(report)


def failures_in(report):
    """Return the names of the tests that failed or stopped with an error, of a report in JUnit's form."""
    cases = ElementTree.parse(report).iter("testcase")
    bad = [case for case in cases if case.find("failure") is not None or case.find("error") is not None]
    return tuple(f"{case.get('classname')}::{case.get('name')}" for case in bad)


def test_environment(home):
    """Return the variables of a test run: nothing of the person's own Jupyter has a say in it, and nothing is left there."""
    places = ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR")
    chromium = find_chromium()
    return inside(**{name: os.path.join(home, name.lower()) for name in places}, **({"ECSIM_CHROMIUM": chromium} if chromium else {}))


def find_chromium():
    """Return the path of a Chromium that runs, or None; ECSIM_CHROMIUM goes before what is on PATH."""
    named = os.environ.get("ECSIM_CHROMIUM")
    if named:
        return shutil.which(named)
    candidates = [shutil.which(name) for name in CHROMIUM_NAMES] + [shutil.which(os.path.expandvars(place)) for place in CHROMIUM_PLACES]
    return next((path for path in candidates if path and starts(path)), None)


def starts(browser):
    """Tell whether a browser is more than a signpost to another package manager."""
    if os.name == "nt":
        return True  # there `--version` opens a window
    return subprocess.run([browser, "--version"], capture_output=True, stdin=subprocess.DEVNULL).returncode == 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except LabError as error:
        sys.exit(f"ecsim: {error}")
    except KeyboardInterrupt:
        sys.exit(130)
