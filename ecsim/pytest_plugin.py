"""What pytest gets from ecsim: the fixture `plc`, and the fixtures `exercise` and `grade` for programs that drive a machine.

    def test_the_motor_holds_itself(plc):
        plc.load("motor.il")
        plc.run()
        plc["X0"] = 1
        plc.scan()
        assert plc["Y0"]

    @pytest.mark.exercise("conveyor")
    def test_my_answer(grade):
        grade("answer.il")

`plc` is an EC20 with ideal inputs (no input filter) and scans of 10 ms; `@pytest.mark.plc("EC10", scan_ms=5)` asks for
another one. `grade(program)` fails the test when a rule of the exercise is broken, and shows what was expected, what was found and the
timing chart of the moment; it gives the report. The exercise is one that comes with ecsim, or the path of a folder.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Make the two markers known."""
    config.addinivalue_line("markers", "plc(model, **settings): what the fixture `plc` is made with, as for ecsim.Plc")
    config.addinivalue_line(
        "markers", "exercise(name): the exercise of the fixtures `exercise` and `grade`, by its name or the path of its folder"
    )


@pytest.fixture
def plc(request: pytest.FixtureRequest) -> Any:
    """A PLC that is powered and in STOP, with ideal inputs."""
    from ecsim import Plc

    marker = request.node.get_closest_marker("plc")
    arguments, settings = (marker.args, marker.kwargs) if marker else ((), {})
    return Plc(*arguments, **{"input_filter_ms": 0, **settings})


@pytest.fixture
def exercise(request: pytest.FixtureRequest) -> Any:
    """The exercise that the marker names; a relative path is one from the test's own folder."""
    from ecsim.grading import find_exercise

    marker = request.node.get_closest_marker("exercise")
    if marker is None or len(marker.args) != 1:
        pytest.fail("name the exercise: @pytest.mark.exercise('conveyor')", pytrace=False)
    beside = Path(request.path).parent / str(marker.args[0])
    return find_exercise(beside if (beside / "__init__.py").is_file() else marker.args[0])


@pytest.fixture
def grade(request: pytest.FixtureRequest, exercise: Any) -> Callable[..., Any]:
    """Grade a program (text, Program, or a path, from the test's own folder); the test fails when a rule is broken."""

    def graded(program: Any, **settings: Any) -> Any:
        named = isinstance(program, Path) or (isinstance(program, str) and "\n" not in program and program.strip().endswith(".il"))
        if named:
            program = Path(request.path).parent / program
        report = exercise.grade(program, **settings)
        if not report.passed:
            pytest.fail(str(report), pytrace=False)
        return report

    return graded
