"""Files of cases that are not as they should be: each is refused in words, and a wrong model fails its own case only."""

import json

import pytest

from ecsim import EcsimError
from ecsim.cli import main
from ecsim.scenario import load_cases

GOOD = {"id": "good", "models": ["EC20"], "il": "LD SM0\nOUT Y0", "steps": [{"scans": 1, "expect": {"Y0": 1}}]}


@pytest.mark.parametrize(
    ("case", "says"),
    [
        ({**GOOD, "il": 5}, "case 1 has 5 for il; expected a text"),
        ({**GOOD, "models": "EC20"}, "expected a list of models"),
        ({**GOOD, "steps": {}}, "expected a list of steps"),
        ({**GOOD, "steps": ["scan"]}, "a step that is no object"),
        ({key: value for key, value in GOOD.items() if key != "steps"}, "case 1 lacks steps"),
        ({"il": ""}, "lacks id, models"),
        (5, "case 1 is no object"),
    ],
)
def test_a_case_of_the_wrong_form_is_refused(tmp_path, case, says):
    path = tmp_path / "cases.json"
    path.write_text(json.dumps([case]), encoding="utf-8")
    with pytest.raises(EcsimError, match=says):
        load_cases(path)


def test_a_folder_is_no_file_of_cases(tmp_path):
    with pytest.raises(EcsimError, match="cannot be read"):
        load_cases(tmp_path)


def test_a_wrong_model_fails_its_own_case_only(tmp_path, capsys):
    path = tmp_path / "cases.json"
    path.write_text(json.dumps([{**GOOD, "id": "odd", "models": ["EC30"]}, GOOD]), encoding="utf-8")
    assert main(["cases", str(path)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "odd [EC30]: there is no model 'EC30'; ecsim knows EC10, EC20, H1U, H2U",
        "1 passed, 1 failed",
    ]


def test_the_command_tells_its_version(capsys):
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out.startswith("ecsim 0.")
