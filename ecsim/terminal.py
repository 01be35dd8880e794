"""A program in a terminal: a live view with keys, or a run without a view that prints what came of it (`ecsim run`)."""

import contextlib
import os
import select
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from .errors import EcsimError
from .plc import Plc
from .session import Session
from .values import BOOL

REFRESH_S = 0.1
KEYS = "q quit   space pause, go on   s one scan   b back   a name turns an input over, NAME=VALUE writes (: begins one with q, s or b)"
SECTIONS = {"Inputs": "X", "Outputs": "Y", "Steps": "S", "Relays": "M", "Timers": "T", "Counters": "C", "Registers": "D"}


@dataclass(frozen=True)
class Line:
    """One device: its name in the program, its value in words, whether it is ON, whether it is forced."""

    device: str
    name: str
    value: str
    on: bool
    forced: bool

    @property
    def text(self) -> str:
        return f"{self.value}{' ●' if self.on else ''}{' forced' if self.forced else ''}"


def sections(plc: Plc) -> dict[str, list[Line]]:
    """What the view shows: the devices that the program names, by kind."""
    found = {title: [_line(plc, str(device)) for device in plc.in_use((area,))] for title, area in SECTIONS.items()}
    return {title: lines for title, lines in found.items() if lines}


def _line(plc: Plc, device: str) -> Line:
    contact = f"{device}:BOOL" if device[0] in "TC" else device
    value = plc[device]
    on = bool(plc[contact]) if device[0] != "D" else False
    return Line(device, plc.names.get(device, ""), str(value), on, device in plc.forced or contact in plc.forced)


def heading(session: Session) -> str:
    """State, time and scans in one line."""
    plc = session.plc
    state = "RUN" if plc.running else "STOP"
    held = {"running": "", "stopped": ""}.get(session.state, f" ({session.state})")
    lamps = " ".join(f"{name} {state}" for name, state in plc.lamps.items() if state != "off")
    return (
        f"{plc.model.name} {state}{held}   {plc.time_us / 1e6:.3f} s   {plc.scans} scans of {plc.period_us / 1000:g} ms   {lamps}".rstrip()
    )


def page(session: Session) -> str:
    """The whole view as plain text."""
    blocks = [heading(session)]
    for title, lines in sections(session.plc).items():
        wide, named = max(len(line.device) for line in lines), max(len(line.name) for line in lines)
        rows = [f"  {line.device:<{wide}}  {line.name:<{named}}  {line.text}".rstrip() for line in lines]
        blocks.append("\n".join([title, *rows]))
    errors = [f"  {error}" for error in session.plc.errors]
    return "\n\n".join([*blocks, *(["\n".join(["Errors", *errors])] if errors else [])])


# -- without a view -------------------------------------------------------------------------------------------------


def condition(plc: Plc, text: str) -> Callable[[], bool]:
    """What "Y0" (is ON), "D0=5", "D0>=5" and the like ask; raises EcsimError for what asks nothing."""
    for sign, holds in _SIGNS.items():
        name, found, wanted = text.partition(sign)
        if found:
            value = _value(wanted)
            plc.get(name)
            return lambda: holds(plc.get(name), value)
    plc.get(text)
    return lambda: plc.get(text) != 0


_SIGNS = {
    ">=": lambda a, b: a >= b, "<=": lambda a, b: a <= b, "!=": lambda a, b: a != b, "=": lambda a, b: a == b,
    ">": lambda a, b: a > b, "<": lambda a, b: a < b,
}  # fmt: skip


def _value(text: str) -> int | float:
    for kind in (lambda words: int(words, 0), float):
        with contextlib.suppress(ValueError):
            return kind(text.strip())
    raise EcsimError(f"{text.strip()!r} is no number; write D0=5, for example")


def assign(plc: Plc, text: str) -> tuple[str, int | float]:
    """Name and value of "D0=5"; of a bit alone, "X0", the level that it has not."""
    name, sign, value = (part.strip() for part in text.partition("="))
    if sign:
        return name, _value(value)
    device, kind = plc.memory.parse(name, plc._names)
    if kind is not BOOL:
        raise EcsimError(f"{name} is no bit that could be turned over; write {name}=5, for example")
    return name, 1 - (plc.inputs.terminals[device.number] if device.area == "X" else plc.get(name))


def headless(session: Session, ms: float, until: str = "") -> bool:
    """Run for so much simulated time as fast as it goes; with `until` up to the scan after which that holds, and false when it never did."""
    plc = session.plc
    reached = condition(plc, until) if until else lambda: False
    end = plc.time_us + round(ms * 1000)
    while plc.time_us < end:
        session.scan(1)
        if reached():
            return True
    return not until


# -- the live view --------------------------------------------------------------------------------------------------


class Keyboard:
    """Single keys of a terminal, without waiting for Enter. Use it in a `with`."""

    def __enter__(self) -> "Keyboard":
        self.restore: Callable[[], None] = lambda: None
        if os.name == "posix":
            import termios
            import tty

            number = sys.stdin.fileno()
            former = termios.tcgetattr(number)
            self.restore = lambda: termios.tcsetattr(number, termios.TCSADRAIN, former)
            tty.setcbreak(number)
        return self

    def __exit__(self, *error) -> None:
        self.restore()

    def read(self, wait_s: float) -> str:
        """The keys that were pressed, "" when none was for so long; "\\x04" when the terminal has gone."""
        if os.name == "posix":
            if not select.select([sys.stdin], [], [], wait_s)[0]:
                return ""
            return os.read(sys.stdin.fileno(), 64).decode("utf-8", "ignore") or "\x04"
        import msvcrt
        import threading

        threading.Event().wait(wait_s)
        return "".join(iter(lambda: msvcrt.getwch() if msvcrt.kbhit() else "", ""))


class Console:
    """What keys do to a session; `entry` is the name that is being typed, `said` the answer to the last one."""

    def __init__(self, session: Session):
        self.session = session
        self.entry: str | None = None
        self.said = ""
        self.ended = False

    def press(self, keys: str) -> None:
        """Take some keys."""
        for key in keys:
            if self.entry is not None:
                self._type(key)
            elif key in self._COMMANDS:
                self.said = ""
                self._COMMANDS[key](self)
            elif key == ":" or key.isalnum():
                self.said, self.entry = "", "" if key == ":" else key

    def _type(self, key: str) -> None:
        if key in "\r\n":
            text, self.entry = self.entry.strip(), None
            self._act(text)
        elif key == "\x1b":
            self.entry = None
        elif key in "\x7f\b":
            self.entry = self.entry[:-1]
        elif key.isprintable():
            self.entry += key

    def _act(self, text: str) -> None:
        if not text:
            return
        try:
            name, value = assign(self.session.plc, text)
            self.session.set(name, value)
            self.said = f"{name} = {value}"
        except EcsimError as error:
            self.said = str(error)

    def _quit(self) -> None:
        self.ended = True

    def _pause(self) -> None:
        if self.session.state == "running":
            self.session.pause()
        else:
            self.session.run()

    def _scan(self) -> None:
        self.session.scan(1)

    def _back(self) -> None:
        if not self.session.back(1):
            self.said = "this is as far back as is remembered"

    _COMMANDS = {"q": _quit, "\x04": _quit, " ": _pause, "s": _scan, "b": _back}

    @property
    def foot(self) -> str:
        """The keys, or what is being typed."""
        return self.said or KEYS if self.entry is None else f"> {self.entry}"


def live(session: Session, plain: bool = False) -> None:
    """Show a session until `q` is pressed, by rich where it is installed; keys go to its inputs."""
    console = Console(session)
    session.run()
    try:
        with _screen(plain) as show, Keyboard() as keyboard:
            while not console.ended and session.error is None:
                show(session, console.foot)
                console.press(keyboard.read(REFRESH_S))
    finally:
        session.stop()


@contextlib.contextmanager
def _screen(plain: bool) -> Iterator[Callable[[Session, str], None]]:
    """What draws the view."""
    try:
        if plain:
            raise ImportError
        from rich.live import Live
    except ImportError:
        yield _draw_plain
        return
    with Live(screen=True, auto_refresh=False) as screen:
        yield lambda session, foot: screen.update(_drawing(session, foot), refresh=True)


def _draw_plain(session: Session, foot: str) -> None:
    rows = shutil.get_terminal_size().lines - 3
    lines = page(session).split("\n")
    cut = lines if len(lines) <= rows else [*lines[: rows - 1], f"  ... {len(lines) - rows + 1} more lines"]
    sys.stdout.write("\x1b[H\x1b[2J" + "\n".join([*cut, "", foot]))
    sys.stdout.flush()


def _drawing(session: Session, foot: str):
    """The view as rich draws it: a table for each kind of device, side by side."""
    from rich.columns import Columns
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    tables = []
    for title, lines in sections(session.plc).items():
        table = Table(title=title, title_justify="left", box=None, show_header=False, padding=(0, 1))
        for line in lines:
            style = "black on yellow" if line.forced else "bold green" if line.on else ""
            table.add_row(Text(line.device), Text(line.name), Text(line.text, style=style))
        tables.append(table)
    errors = [Text(str(error), style="bold red") for error in session.plc.errors]
    return Group(Text(heading(session), style="bold"), Text(), Columns(tables, padding=(0, 3)), Text(), *errors, Text(foot, style="dim"))
