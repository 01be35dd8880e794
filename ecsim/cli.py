"""The command `ecsim`: check programs, run conformance cases, tell about instructions."""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from . import __version__
from . import compile as compile_program
from .errors import EcsimError, ProgramError
from .help import help as help_on
from .models import MODELS
from .scenario import load_cases, run_case


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
    parser = argparse.ArgumentParser(prog="ecsim", description="A simulator of Emerson EC10 and EC20 PLCs.")
    parser.add_argument("--version", action="version", version=f"ecsim {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    cases = commands.add_parser("cases", help="run conformance cases", description="Run conformance cases from JSON files.")
    cases.add_argument("files", nargs="+", type=Path, metavar="FILE")
    cases.add_argument("--json", action="store_true", help="print the verdicts as JSON")
    cases.add_argument("--only", default="", metavar="TEXT", help="only cases whose id contains TEXT")
    cases.add_argument("--stepping", action="store_true", help="use the stepping engine")
    cases.set_defaults(act=_cases)
    check = commands.add_parser(
        "check", help="compile a program and list its errors", description="Compile a program and list all its errors."
    )
    check.add_argument("program", type=Path, metavar="PROGRAM", help="an .il file or a project folder")
    check.add_argument("--model", choices=list(MODELS), help="EC20 unless the project says otherwise")
    check.set_defaults(act=_check)
    tell = commands.add_parser("help", help="tell about an instruction", description="Tell about an instruction, a section, or list all.")
    tell.add_argument("name", nargs="?", default="", metavar="NAME", help="an instruction (ADD) or a section of the manual (6.3)")
    tell.set_defaults(act=_help)
    return parser


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
        for problem in error.problems:
            print(problem)
        count = len(error.problems)
        print(f"{count} error{'s' if count != 1 else ''}")
        return 1
    print(f"{program.model.name}: {program.steps} of {program.model.limits['steps']} steps, no errors")
    return 0


def _help(options: argparse.Namespace) -> int:
    print(help_on(options.name))
    return 0
