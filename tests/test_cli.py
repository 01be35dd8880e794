"""The command `ecsim`: what it prints and how it ends."""

import json
import subprocess
import sys

import pytest

from ecsim.cli import main

PASSING = {
    "id": "adds",
    "models": ["EC10", "EC20"],
    "il": "LD SM0\nADD D0 1 D1",
    "steps": [{"set": {"D0": 4}, "scans": 1, "expect": {"D1": 5}}],
}
FAILING = PASSING | {
    "id": "adds wrongly",
    "models": ["EC20"],
    "steps": [{"scans": 1}, {"set": {"D0": 4}, "scans": 1, "expect": {"D1": 6, "D0": 4}}],
}


@pytest.fixture
def cases(tmp_path):
    """Write cases to a file."""

    def write(*cases, name="cases.json"):
        path = tmp_path / name
        path.write_text(cases[0] if isinstance(cases[0], str) else json.dumps(cases))
        return str(path)

    return write


def test_cases_that_pass_end_with_0_and_the_count(cases, capsys):
    assert main(["cases", cases(PASSING)]) == 0
    assert capsys.readouterr().out == "2 passed, 0 failed\n"


def test_a_case_that_fails_is_told_with_step_device_value_and_expectation(cases, capsys):
    assert main(["cases", cases(PASSING, FAILING)]) == 1
    assert capsys.readouterr().out == "adds wrongly [EC20]: step 2: D1 is 5, expected 6\n2 passed, 1 failed\n"


@pytest.mark.parametrize("engine", [[], ["--stepping"]])
def test_cases_of_several_files_run_on_either_engine(cases, capsys, engine):
    assert main(["cases", cases(PASSING, name="a.json"), cases(FAILING, name="b.json"), *engine]) == 1
    assert capsys.readouterr().out.endswith("2 passed, 1 failed\n")


def test_cases_are_chosen_by_a_part_of_their_id(cases, capsys):
    assert main(["cases", cases(PASSING, FAILING), "--only", "wrongly"]) == 1
    assert capsys.readouterr().out.endswith("0 passed, 1 failed\n")


def test_verdicts_are_given_as_json(cases, capsys):
    assert main(["cases", cases(PASSING, FAILING), "--json"]) == 1
    verdicts = json.loads(capsys.readouterr().out)
    assert [(v["case"], v["model"], v["passed"]) for v in verdicts] == [
        ("adds", "EC10", True),
        ("adds", "EC20", True),
        ("adds wrongly", "EC20", False),
    ]
    assert verdicts[2]["mismatches"] == [{"step": 2, "device": "D1", "value": 5, "expected": 6}]


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("{", "is no JSON: Expecting property name"),
        ("{}", "holds no array of cases"),
        ('[{"id": "a"}]', "case 1 lacks models, il, steps"),
        ('["a"]', "case 1 is no object"),
    ],
)
def test_a_broken_file_of_cases_ends_with_2(cases, capsys, content, says):
    assert main(["cases", cases(content)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("ecsim: ")
    assert says in error


def test_a_missing_file_of_cases_ends_with_2(capsys):
    assert main(["cases", "nowhere.json"]) == 2
    assert capsys.readouterr().err == "ecsim: there is no file nowhere.json\n"


def test_a_sound_program_is_told_with_its_length(tmp_path, capsys):
    path = tmp_path / "lamp.il"
    path.write_text("LD X0\nOUT Y0")
    assert main(["check", str(path)]) == 0
    assert capsys.readouterr().out == "EC20: 2 of 12000 steps, no errors\n"


def test_all_errors_of_a_program_are_listed(tmp_path, capsys):
    path = tmp_path / "lamp.il"
    path.write_text("LD X0\nOUT X0\nLD X1\nTON T0")
    assert main(["check", str(path)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(": ")[:2] for line in lines[:2]] == [["lamp.il", "line 2, column 5"], ["lamp.il", "line 4, column 5"]]
    assert lines[-1] == "2 errors"


def test_the_model_of_a_check_can_be_chosen(tmp_path, capsys):
    path = tmp_path / "lamp.il"
    path.write_text("LD X377\nOUT Y0")
    assert main(["check", str(path), "--model", "EC20"]) == 0
    assert main(["check", str(path), "--model", "EC10"]) == 1
    assert capsys.readouterr().out.endswith("1 error\n")
    (tmp_path / "plc.toml").write_text('model = "EC10"')
    assert main(["check", str(tmp_path)]) == 1


def test_a_program_that_is_not_there_ends_with_2(capsys):
    assert main(["check", "nowhere.il"]) == 2
    assert "there is no file nowhere.il" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [[], ["fly"], ["check"], ["check", "a.il", "--model", "EC30"]])
def test_a_wrong_use_ends_with_2_and_says_how_it_is_used(arguments, capsys):
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert ended.value.code == 2
    assert "usage: ecsim" in capsys.readouterr().err


def test_the_package_is_a_command_too(cases):
    done = subprocess.run([sys.executable, "-m", "ecsim", "cases", cases(FAILING)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.splitlines()[-1]) == (1, "0 passed, 1 failed")


def test_translate_import_and_export(tmp_path, capsys):
    source, there, table, back = (tmp_path / name for name in ("lamp.il", "lamp.h2u.il", "lamp.csv", "back.h2u.il"))
    source.write_text("LD X0\nEU\nTON T0 5\n")
    assert main(["translate", str(source), "--to", "H2U"]) == 0
    shown = capsys.readouterr()
    assert shown.out.split() == ["LDP", "X0", "OUT", "T0", "K5"]
    assert "line 3: timers stop at their preset there" in shown.err
    assert main(["translate", str(source), "--to", "H2U", "--out", str(there)]) == 0
    assert main(["export", str(there), str(table)]) == 0
    assert table.read_bytes()[:2] == b"\xff\xfe"
    assert main(["import", str(table), "--out", str(back)]) == 0
    assert back.read_text() == there.read_text()
    assert main(["export", str(there), str(tmp_path / "lamp.txt")]) == 0
    assert (tmp_path / "lamp.txt").read_text().split() == ["0", "LDP", "X0", "2", "OUT", "T0", "K5"]
    capsys.readouterr()
    source.write_text("LD X0\nTOF T0 5\n")
    assert main(["translate", str(source), "--to", "H2U"]) == 1
    assert "line 2: TOF T0 5: H2U has nothing that does the same" in capsys.readouterr().out
    assert main(["translate", str(source), "--to", "EC10"]) == 2
    assert main(["import", str(tmp_path / "nothing.csv")]) == 2
    source.write_text("LD X0\nOUT Q0\n")
    assert main(["export", str(source), str(table)]) == 1
