"""A hint after repeated failures: the network in which one changed line mends the program, without the line."""

from ..assembler import Network, Program, Unit, assemble
from ..errors import ProgramError
from .edits import edits
from .exercise import Exercise
from .grade import Stage, runs_of
from .report import Report

TRIES = 2500  # edited programs at most
SCANS = 2_000_000  # and scans at most, which is some ten seconds


def hint(exercise: Exercise, report: Report) -> str:
    """Where to look, "" when every rule is kept. Edits that are changes come before additions; each is tried on the failing runs first."""
    if report.passed:
        return ""
    if report.compiled is None:
        return "Start with the first of the compiler's messages."
    program = report.compiled
    scenarios = {scenario.name: scenario for scenario in exercise.scenarios}
    failing = [(scenarios[one.failure.scenario], dict(one.failure.choices)) for one in report.failed]
    usual = list(runs_of(exercise))
    runs = [*failing, *(run for run in usual if run not in failing)]
    tries = scans = 0
    named = {str(variable.device) for variable in program.variables.values()}
    devices = [device for device in exercise.wiring if device[0] == "X" and device not in named]
    for inserting in (False, True):
        for edit in edits(program.source, inserting, devices):
            if inserting and "\n" not in edit.new:
                continue
            try:
                mended = assemble(edit.text, program.model)
            except ProgramError:
                continue
            tries += 1
            kept, used = _keeps_all(exercise, mended, runs)
            scans += used
            if kept:
                return _words(program, edit.line)
            if tries >= TRIES or scans >= SCANS:
                return _without(exercise)
    return _without(exercise)


def _keeps_all(exercise: Exercise, program: Program, runs: list) -> tuple[bool, int]:
    """Whether a program keeps every rule, and how many scans it took to see."""
    stage, tried, scans = Stage(exercise, program), set(), 0
    for scenario, values in runs:
        trace, _ = stage.run(scenario, values)
        scans += trace.end
        for rule in exercise.rules:
            if rule.applies(scenario.name):
                has_tried, finding = rule.judge(trace)
                if finding is not None:
                    return False, scans
                if has_tried:
                    tried.add(rule.name)
    return len(tried) == len(exercise.rules), scans


def _words(program: Program, line: int) -> str:
    """The network around a line, in words."""
    for unit in program.units:
        for network in unit.networks:
            first, last = _lines(unit, network)
            if first <= line <= last:
                where = f"line {first}" if first == last else f"lines {first} to {last}"
                title = f" ({network.title.splitlines()[-1]})" if network.title else ""
                return f"Look at network {network.number} of {unit.name}{title}, {where}: one line there makes the difference."
    return f"Look around line {line}: one line there makes the difference."


def _lines(unit: Unit, network: Network) -> tuple[int, int]:
    return unit.instructions[network.start].line, unit.instructions[network.end - 1].line


def _without(exercise: Exercise) -> str:
    """What is said when no single line mends the program."""
    return "No single line mends it. Take the first rule that is broken, and replay the machine up to that moment."
