"""The command `ecsim`: run, check, serve and translate programs, run conformance cases, tell about instructions."""

import argparse
import json
import signal
import sys
import threading
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from . import __version__, terminal
from . import compile as compile_program
from .errors import EcsimError, ProgramError
from .exchange import read_list, write_csv, write_list
from .grading.command import add_commands
from .help import help as help_on
from .modbus import serve
from .models import MODELS
from .plc import Plc
from .project import Project, replace_files
from .scenario import load_cases, run_case
from .session import Session
from .translation import translate


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; 0 when all is well, 1 when something failed, 2 for a wrong use."""
    options = _parser().parse_args(arguments)
    try:
        return options.act(options)
    except EcsimError as error:
        print(f"ecsim: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ecsim", description="A simulator of Emerson EC10 and EC20, Inovance H1U and H2U PLCs.")
    parser.add_argument("--version", action="version", version=f"ecsim {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    cases = commands.add_parser("cases", help="run conformance cases", description="Run conformance cases from JSON files.")
    cases.add_argument("files", nargs="+", type=Path, metavar="FILE")
    cases.add_argument("--json", action="store_true", help="print the verdicts as JSON")
    cases.add_argument("--only", default="", metavar="TEXT", help="only cases whose id contains TEXT")
    cases.add_argument("--stepping", action="store_true", help="use the stepping engine")
    cases.set_defaults(act=_cases)
    check = commands.add_parser(
        "check",
        help="compile a program and list its errors",
        description="Compile a program and list all its errors and those of its settings.",
        epilog="Ends with 0 when there are none, with 1 when there are some, with 2 when it cannot be read.",
    )
    _takes_program(check)
    check.set_defaults(act=_check)
    run = commands.add_parser(
        "run",
        help="run a program",
        description="Run a program with a live view, or with --ms or --until without one: then the devices are printed at the end.",
        epilog="Ends with 0, with 1 when the program does not compile, --until did not come true or an error has stopped the PLC, with 2 for a"
        " wrong use.",
    )
    _takes_program(run)
    run.add_argument("--ms", type=positive, metavar="N", help="run N ms of simulated time as fast as it goes")
    run.add_argument("--until", default="", metavar="TEST", help='run until Y0 is ON, or "D0>=5" holds; at most --ms, or 60000')
    run.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="a value before the first scan; may stand several times"
    )
    run.add_argument("--speed", type=positive, default=1.0, metavar="FACTOR", help="simulated seconds a second in the live view")
    run.add_argument("--plain", action="store_true", help="a live view without colours, as there is one without rich")
    run.set_defaults(act=_run)
    served = commands.add_parser(
        "serve",
        help="run a program for Modbus clients",
        description="Run a program in real time and answer Modbus clients until Ctrl-C.",
        epilog="Ends with 0, with 2 when the program does not compile or a line cannot be opened.",
    )
    _takes_program(served)
    served.add_argument("--tcp", type=int, metavar="PORT", help="answer on this TCP port, 0 for any free one")
    served.add_argument("--rtu", metavar="DEVICE", help="answer on this serial port in RTU mode")
    served.add_argument("--ascii", metavar="DEVICE", help="answer on this serial port in ASCII mode")
    served.add_argument("--host", default="127.0.0.1", help="the address to listen at; this machine alone unless told otherwise")
    served.add_argument("--station", type=int, default=1, help="1 to 31")
    served.add_argument("--baud", type=int, default=19200, help="of the serial ports")
    served.add_argument("--parity", default="even", help="none, odd or even")
    served.add_argument("--speed", type=float, default=1.0, metavar="FACTOR", help="simulated seconds a second")
    served.set_defaults(act=_serve)
    into = commands.add_parser(
        "translate",
        help="turn a program of one family into one of the other",
        description="Turn a program for EC10 or EC20 into one for H1U or H2U, or back, and report what differs.",
        epilog="Ends with 0, with 1 and all reasons when the program does not compile or cannot be kept, with 2 for a wrong use.",
    )
    _takes_program(into)
    into.add_argument("--to", choices=list(MODELS), required=True, help="the model that it is to be for")
    into.add_argument("--out", type=Path, metavar="FILE", help="write the program to this file, and the report to the screen")
    into.set_defaults(act=_translate)
    taken = commands.add_parser(
        "import",
        help="read a program that another tool has written",
        description="Read a program for H1U or H2U from the CSV of Mitsubishi's software or from a plain list of instructions.",
        epilog="Ends with 0, with 1 when the program does not compile, with 2 when the file is something else.",
    )
    taken.add_argument("file", type=Path, metavar="FILE", help="UTF-16 with tabs, or lines of instructions")
    taken.add_argument("--model", choices=list(MODELS), default="H2U", help="the model that it is for (H2U)")
    taken.add_argument("--out", type=Path, metavar="FILE", help="write the program to this file and not to the screen")
    taken.set_defaults(act=_import)
    given = commands.add_parser(
        "export",
        help="write a program for another tool",
        description="Write a program for H1U or H2U as CSV of Mitsubishi's software, or as a plain list where the name ends in .txt.",
        epilog="Ends with 0, with 1 when the program does not compile, with 2 for one of another family.",
    )
    _takes_program(given, usual="H2U")
    given.add_argument("file", type=Path, metavar="FILE", help="NAME.csv or NAME.txt")
    given.set_defaults(act=_export)
    tell = commands.add_parser("help", help="tell about an instruction", description="Tell about an instruction, a section, or list all.")
    tell.add_argument("name", nargs="?", default="", metavar="NAME", help="an instruction (ADD) or a section of the manual (6.3)")
    tell.add_argument("--model", choices=list(MODELS), default="", help="whose instructions; EC's unless only H2U has such a one")
    tell.set_defaults(act=_help)
    add_commands(commands)
    return parser


def _takes_program(command: argparse.ArgumentParser, usual: str = "EC20") -> None:
    command.add_argument("program", type=Path, metavar="PROGRAM", help="an .il file or a project folder")
    command.add_argument(
        "--model", choices=list(MODELS), help=f"the model that it is for; {usual} unless the file or project says otherwise"
    )


def _cases(options: argparse.Namespace) -> int:
    verdicts = [
        run_case(case, model, tracing=options.stepping)
        for path in options.files
        for case in load_cases(path)
        if options.only in case["id"]
        for model in case["models"]
    ]
    failed = [verdict for verdict in verdicts if not verdict.passed]
    if options.json:
        print(json.dumps([asdict(verdict) | {"passed": verdict.passed} for verdict in verdicts], indent=1))
    else:
        for verdict in failed:
            print(verdict)
        print(f"{len(verdicts) - len(failed)} passed, {len(failed)} failed")
    return 1 if failed else 0


def _check(options: argparse.Namespace) -> int:
    try:
        program = compile_program(options.program, options.model)
    except ProgramError as error:
        return _told(error)
    print(f"{program.model.name}: {program.steps} of {program.model.limits['steps']} steps, no errors")
    return 0


def _told(error: ProgramError) -> int:
    for problem in error.problems:
        print(problem)
    count = len(error.problems)
    print(f"{count} error{'s' if count != 1 else ''}")
    return 1


def positive(text: str) -> float:
    number = float(text)
    if not 0 < number < float("inf"):
        raise ValueError(text)
    return number


def _run(options: argparse.Namespace) -> int:
    try:
        project = Project.of(options.program)
        plc = Plc(options.model or project.model or "EC20")
        plc.load(project)
    except ProgramError as error:
        return _told(error)
    session = Session(plc, name=project.name, speed=options.speed)
    plc.run()
    for text in options.set:
        session.set(*terminal.assign(plc, text))
    if options.ms or options.until:
        reached = terminal.headless(session, options.ms or 60_000, options.until)
        print(terminal.page(session))
        if not reached:
            print(f"\n{options.until} did not come true")
        return 0 if reached and not plc.stopped_by else 1
    if not sys.stdin.isatty():
        raise EcsimError("there is no terminal for a live view; give --ms or --until")
    try:
        terminal.live(session, options.plain)
    except KeyboardInterrupt:
        return 130
    return 0


def _serve(options: argparse.Namespace) -> int:
    project = Project.of(options.program)
    plc = Plc(options.model or project.model or "EC20")
    plc.load(project)
    plc.run()
    session = Session(plc, name=project.name, speed=options.speed)
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    lines = {name: getattr(options, name) for name in ("tcp", "rtu", "ascii", "host", "station", "baud", "parity")}
    with serve(session, **lines) as server:
        session.start()
        print(f"{server}; Ctrl-C ends it", flush=True)
        try:
            while session.state != "failed" and not ended.wait(0.5):
                pass
        except KeyboardInterrupt:
            print()
    session.stop()
    return 0


def _translate(options: argparse.Namespace) -> int:
    try:
        done = translate(compile_program(options.program, options.model), options.to)
    except ProgramError as error:
        return _told(error)
    _write(options.out, done.text)
    print(done.report(), file=sys.stderr if options.out is None else sys.stdout)
    return 0


def _import(options: argparse.Namespace) -> int:
    try:
        content = options.file.read_bytes()
    except OSError as error:
        raise EcsimError(f"{options.file} cannot be read: {error.strerror}") from None
    try:
        _write(options.out, read_list(content, options.model))
    except ProgramError as error:
        return _told(error)
    return 0


def _export(options: argparse.Namespace) -> int:
    project = Project.of(options.program)
    try:
        program = project.compile(options.model or project.model or "H2U")
    except ProgramError as error:
        return _told(error)
    plain = options.file.suffix.lower() == ".txt"
    _write(options.file, write_list(program) if plain else write_csv(program, options.program.name.split(".")[0].upper()))
    return 0


def _write(path: Path | None, content: str | bytes) -> None:
    """Put a text to the screen, or a file into its place as a whole."""
    if path is None:
        print(content)
        return
    try:
        replace_files(path.parent, {path.name: content}, [])
    except OSError as error:
        raise EcsimError(f"{path} cannot be written: {error.strerror}") from None


def _help(options: argparse.Namespace) -> int:
    print(help_on(options.name, options.model))
    return 0
