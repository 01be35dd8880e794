"""The pytest plugin, in a pytest of its own."""

import os
import subprocess
import sys

import pytest

TESTS = """
import pytest

def test_plc(plc):
    plc.load("LD X0\\nOUT Y0")
    plc.run()
    plc["X0"] = 1
    plc.scan()
    assert (plc["Y0"], plc.model.name) == (1, "EC20")

@pytest.mark.plc("EC10", scan_ms=5)
def test_another_plc(plc):
    assert (plc.model.name, plc.scan_ms) == ("EC10", 5)

@pytest.mark.exercise("conveyor")
def test_right(grade, exercise):
    assert grade(exercise.solution).marks == len(exercise.rules)

@pytest.mark.exercise("conveyor")
def test_wrong(grade):
    grade("answer.il")

def test_without_marker(grade):
    pass
"""


@pytest.fixture
def run(tmp_path, root):
    """Run a file of tests with the plugin as its entry point would load it; gives status and output."""
    (tmp_path / "answer.il").write_text((root / "exercises" / "conveyor" / "mistakes" / "gate_stays_down.il").read_text(encoding="utf-8"))

    def run(text):
        (tmp_path / "test_it.py").write_text(text)
        options = ["-q", "-p", "no:cacheprovider", "--strict-markers", "-p", "ecsim.pytest_plugin"]
        alone = os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # the installed entry point would load it a second time
        done = subprocess.run(
            [sys.executable, "-m", "pytest", *options, str(tmp_path)], cwd=tmp_path, env=alone, capture_output=True, text=True, timeout=120
        )
        return done.returncode, done.stdout

    return run


def test_the_fixtures_serve_and_a_broken_rule_shows_its_chart(run):
    status, out = run(TESTS)
    assert status == 1
    assert "3 passed" in out
    assert "1 failed" in out.replace("1 failed, 3 passed, 1 error", "1 failed")
    assert "[ ] The gate opens for no pallet" in out
    assert "expected  Gate off from the moment" in out
    assert "> Gate Y0" in out
    assert "name the exercise: @pytest.mark.exercise('conveyor')" in out


def test_the_entry_point_is_declared(root):
    import tomllib

    points = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]["entry-points"]["pytest11"]
    assert points == {"ecsim": "ecsim.pytest_plugin"}
