"""Grading on the conveyor: verdicts, marks, the failing moment, its shortening, its replay, and the report in all its forms."""

import json
import xml.etree.ElementTree as xml
from dataclasses import replace

import pytest
from ecsim_exercises.plant import Point

import ecsim
from ecsim import EcsimError
from ecsim.grading import Between, Do, Exercise, Never, OneOf, Report, Scenario, Several, Within, find_exercise
from ecsim.grading.chart import ticks
from ecsim.grading.choices import usual
from ecsim.grading.grade import Stage
from ecsim.grading.page import page, panel
from ecsim.grading.page import style as style_of_the_report

GATE = "gate_stays_down"


@pytest.fixture(scope="module")
def right(conveyor):
    return conveyor.grade(conveyor.solution)


@pytest.fixture(scope="module")
def wrong(conveyor):
    return conveyor.grade(conveyor.mistakes[GATE][0])


def test_a_correct_program_has_all_marks(right, conveyor):
    assert right.passed
    assert right.marks == right.out_of == len(conveyor.rules)
    assert (right.failed, right.problems, right.reason, right.notes) == ([], [], "", [])
    assert right.simulated_s > 600


def test_an_empty_program_earns_nothing(conveyor):
    report = conveyor.grade("")
    assert report.marks == 0
    assert {verdict.state for verdict in report.verdicts} == {"untried", "failed"}


def test_a_program_that_does_not_compile_is_told_why(conveyor):
    report = conveyor.grade("LD X0\nOUT Q0")
    assert (report.marks, report.runs) == (0, 0)
    assert report.reason == "The program does not compile."
    assert "line 2" in report.problems[0]
    assert "line 2" in str(report)
    assert "line 2" in panel(report)


def test_a_file_that_is_not_there_is_refused(conveyor, tmp_path):
    with pytest.raises(EcsimError, match="there is no file"):
        conveyor.grade(tmp_path / "answer.il")


def test_a_model_that_the_exercise_does_not_take_is_refused(conveyor):
    with pytest.raises(EcsimError, match="for EC20 and EC10, not for H2U"):
        replace(conveyor, models=("EC20", "EC10")).grade(conveyor.solution, "H2U")


@pytest.mark.parametrize("model", ["EC10", "EC20"])
def test_it_grades_on_each_model(conveyor, model):
    report = conveyor.grade(conveyor.solution, model)
    assert (report.passed, report.model) == (True, model)


def test_the_same_program_gets_the_same_report(conveyor, wrong):
    again = conveyor.grade(conveyor.mistakes[GATE][0])
    assert {**again.as_dict(), "took_s": 0} == {**wrong.as_dict(), "took_s": 0}


def test_a_failure_tells_what_when_and_where(wrong):
    failure = wrong["one-at-a-time"].failure
    assert failure.scenario == "pallets"
    assert failure.expected.startswith("Gate off from the moment InLift comes ON")
    assert failure.found.startswith("Gate on, InLift on")
    assert failure.second == pytest.approx(failure.scan * 0.01)
    assert failure.chart.start < failure.second < failure.chart.end
    assert [lane.name for lane in failure.chart.lanes if lane.marked] == ["Gate"]
    assert failure.chart.lanes[-1].name == "Step"


def test_an_unknown_rule_is_named(wrong):
    with pytest.raises(EcsimError, match=r"no rule 'gates'.*one-at-a-time"):
        wrong["gates"]


def test_the_failure_is_found_again_at_the_same_scan(conveyor, wrong):
    failure = wrong["one-at-a-time"].failure
    rule = next(rule for rule in conveyor.rules if rule.name == "one-at-a-time")
    stage = Stage(conveyor, ecsim.compile(wrong.source, "EC20"))
    trace, _ = stage.run(conveyor.scenarios[0], failure.choices, failure.scan + 1)
    assert rule.judge(trace).finding.scan == failure.scan
    trace, _ = stage.run(conveyor.scenarios[0], failure.choices, failure.scan)
    assert rule.judge(trace).finding is None


def test_the_choices_are_made_simpler(tmp_path):
    """A lamp must follow its switch; the program does not light it when the switch comes later than 3 s."""
    exercise = lamp(tmp_path, Between(0.5, 9.0, usual=1.0))
    report = exercise.grade("LD SM0\nTON T0 30\nLD X0\nANI T0\nOUT Y0", more=20)
    assert report["follows"].state == "failed"
    failure = report["follows"].failure
    assert 3.0 <= failure.choices["at"] <= 3.6
    assert failure.choices["unused"] == 0


def test_no_choice_is_tried_twice_while_a_failure_is_made_simpler(tmp_path):
    """The usual values 3, 1 can be made simpler as well; from there it is not gone back to them, over and over until no scans are left."""
    exercise = lamp(tmp_path, Between(1.0, 2.0))
    [scenario] = exercise.scenarios
    choices = {**scenario.choices, "order": Several(OneOf(1, 2, 3), 1, 4, usual=[3, 1])}
    exercise = replace(exercise, scenarios=[replace(scenario, choices=choices, draws=0)])
    report = exercise.grade("LDI X0\nOUT Y0")
    assert report["dark"].failure.choices == {"at": 1.0, "unused": 0, "order": [1]}
    assert report["dark"].failure.scan == 1  # one scan is let pass
    # The whole run; then for each of the two rules, as both break: [3], [1], and this one again for its chart.
    assert report.runs == 7


def lamp(folder, at):
    """A lamp that follows a switch, without any machine."""

    class Lamp:
        wiring = {"X0": Point("Switch", "a switch"), "Y0": Point("Lamp", "a lamp")}

        def step(self, seconds, outputs):
            return {}

    return Exercise(
        folder=folder,
        title="Lamp",
        plant=Lamp,
        scenarios=[
            Scenario(
                "switch", "The switch is put on", 12, lambda chosen: [Do({"Switch": 1}, at=chosen.at)], {"at": at, "unused": Between(0, 5)}
            )
        ],
        rules=[
            Within("follows", "The lamp follows the switch", "Switch", "Lamp", 0.1),
            Never("dark", "Dark before", "Lamp and not Switch", 1, "Lamp"),
        ],
    )


def test_a_replay_stands_shortly_before_the_failure(conveyor, wrong):
    failure = wrong["one-at-a-time"].failure
    replay = wrong.replay("one-at-a-time", seconds=1.5)
    assert replay.seconds == pytest.approx(1.5)
    assert replay.plc.scans == pytest.approx(failure.scan - 150, abs=1)
    assert replay.plc["X1"] == 0
    replay.session.scan(151)
    assert (replay.plc["X1"], replay.plc["Y0"]) == (1, 1)
    assert replay.picture is conveyor.picture


def test_a_replay_goes_on_with_the_operators_acts(conveyor):
    report = conveyor.grade(conveyor.mistakes["emergency_forgets_outputs"][0])
    failure = report["emergency"].failure
    replay = report.replay("emergency", seconds=1.0)
    assert replay.plc["X6"] == 0
    replay.session.scan(100)
    assert replay.plc["X6"] == 1
    assert replay.session.back(60)
    assert replay.plc["X6"] == 0
    replay.session.scan(61)
    assert replay.plc["X6"] == 1
    assert (failure.scan - replay.plc.scans) in (-1, 0)


def test_a_replayed_plant_looks_like_the_plant(wrong):
    replay = wrong.replay()
    at = replay.plant.fronts
    assert replay.plant.wiring["X0"].name == "AtEntry"
    replay.plant.step(0.0, {f"Y{n}": 0 for n in range(6)})
    assert replay.plant.fronts == at


def test_there_is_no_replay_without_a_failure(right, wrong):
    with pytest.raises(EcsimError, match="no rule was broken"):
        right.replay()
    with pytest.raises(EcsimError, match=r"'belts-run' was not broken; broken are .*one-at-a-time"):
        wrong.replay("belts-run")
    with pytest.raises(EcsimError, match="read from a file"):
        Report.from_dict(wrong.as_dict()).replay()


def test_a_report_goes_through_json_and_back(wrong):
    data = json.loads(wrong.as_json())
    assert json.loads(Report.from_dict(data).as_json()) == data
    assert data["marks"] == wrong.marks
    assert "chart" not in wrong.as_dict(charts=False)["verdicts"][4]["failure"]


def test_the_text_shows_rules_moment_and_chart(wrong):
    text = str(wrong)
    assert "[x] From Start on both belts run" in text
    assert "[ ] The gate opens for no pallet" in text
    assert "> Gate Y0" in text
    assert max(map(len, text.splitlines())) < 160


def test_the_page_is_well_formed_and_marks_the_lanes(wrong):
    html = panel(wrong, styled=False).replace("<details open>", "<details>")
    root = xml.fromstring(html)
    assert len(root.findall(".//{*}svg[@class='trace']")) == len(wrong.failed)
    assert len([one for one in root.iter() if one.get("class") == "bad-lane"]) >= len(wrong.failed)
    assert [one.get("class") for one in root.iter("li")].count("rule pass") == len(wrong.verdicts) - len(wrong.failed)
    ids = [one.get("id") for one in root.iter() if one.get("id")]
    assert len(ids) == len(set(ids))
    assert "<style>" in wrong._repr_html_()
    assert page("Title", html).startswith("<!doctype html>")


def test_a_page_by_itself_follows_its_reader_s_system():
    style = page("Title", "").partition("<style>")[2].partition("</style>")[0]
    before, found, dark = style.partition("@media screen and (prefers-color-scheme: dark)")
    assert found
    assert "--ec-paper: #111111;" in dark  # a literal: there is no JupyterLab around it
    assert "--ec-on: #43dd9a;" in dark
    assert "--ec-radius" not in dark  # colours alone
    assert before == style_of_the_report()


def test_words_of_a_program_cannot_break_the_page(conveyor):
    report = conveyor.grade("LD X0\nOUT <script>alert(1)</script>")
    assert "<script>" not in report._repr_html_()


@pytest.mark.parametrize(("start", "end"), [(0, 1), (3.2, 7.7), (100, 4000), (0, 0.05), (86_390, 86_400)])
def test_the_scale_has_some_round_times(start, end):
    times = ticks(start, end)
    assert 3 <= len(times) <= 13
    assert all(start <= when <= end for when in times)


def test_a_scenario_can_power_the_plc_off_and_write_devices(tmp_path):
    exercise = lamp(tmp_path, Between(1, 1))
    scenario = Scenario(
        "power", "Power goes off and on", 4, [Do({"X0": 1, "D0": 7}, at=1), Do(at=2, act=lambda plc, plant: plc.power_cycle())]
    )
    stage = Stage(exercise, ecsim.compile("LD SM0\nINC D0\nLD X0\nSET M0\nOUT Y0\nLD M0\nINC D1", "EC20"))
    run = stage.begin(scenario, {})
    run.to()
    # 1 s of 10 ms scans, D0 written to 7 then 100 scans; power off clears it, 200 scans more
    assert run.plc["D0"] == 200


def test_acts_come_one_behind_the_other(tmp_path):
    exercise = lamp(tmp_path, Between(1, 1))
    script = [
        Do({"X0": 1}, at=0.5, hold=0.3),
        Do({"X0": 1}, when="not Lamp", after=1.0),
        Do({"X0": 0}, when="Lamp", after=0.5),
        Do({"X0": 1}, after=0.2),
    ]
    stage = Stage(exercise, ecsim.compile("LD X0\nOUT Y0", "EC20"))
    trace, _ = stage.run(Scenario("s", "s", 5, script), {})
    # 0.5 s; 0.3 s later; the lamp is still off at 0.5 s, so a second behind that; 0.5 s later; 0.2 s later. The filter takes a scan.
    assert [scan for scan, _ in trace.lane("Lamp")] == pytest.approx([0, 51, 81, 151, 202, 222], abs=2)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Do({"X0": 1}, at=1, when="Lamp"), "a time .* or a condition, not both"),
        (lambda: Do({"X0": 1}, when="rise(Lamp)"), "wait for ON, then for OFF"),
        (lambda: Scenario("s", "s", 1, until="fall(Lamp)"), "name lanes only"),
    ],
)
def test_scripts_that_cannot_be_are_refused(make, words):
    with pytest.raises(EcsimError, match=words):
        make()


def test_an_exercise_is_checked_as_a_whole(tmp_path):
    scenario, rule = Scenario("s", "s", 1), Never("n", "n", "X0")
    make = lambda **more: Exercise(tmp_path, "T", dict, **({"scenarios": [scenario], "rules": [rule]} | more))
    assert make().name == tmp_path.name
    for wrong, words in [
        ({"rules": []}, "needs scenarios and rules"),
        ({"scenarios": [scenario, scenario]}, "the same name"),
        ({"rules": [Never("n", "n", "X0", scenarios=("t",))]}, "for the scenario 't'; there are s"),
        ({"models": ["EC30"]}, "EC30"),
    ]:
        with pytest.raises(EcsimError, match=words):
            make(**wrong)


def test_an_exercise_is_found_by_name_path_and_itself(conveyor, root, tmp_path):
    assert find_exercise("conveyor") is conveyor
    assert find_exercise(root / "exercises" / "conveyor") is conveyor
    assert find_exercise(conveyor) is conveyor
    with pytest.raises(EcsimError, match=r"no exercise 'mixers'.*conveyor"):
        find_exercise("mixers")
    with pytest.raises(EcsimError, match="is no exercise"):
        find_exercise(tmp_path)


def test_an_exercise_may_lie_anywhere(tmp_path, conveyor):
    folder = tmp_path / "course" / "lift"
    folder.mkdir(parents=True)
    (tmp_path / "course" / "__init__.py").write_text("")
    (folder / "rules.py").write_text(
        "from ecsim.grading import find_exercise\nfrom dataclasses import replace\nfrom pathlib import Path\n"
        "EXERCISE = replace(find_exercise('conveyor'), folder=Path(__file__).parent, title='Mine')\n"
    )
    (folder / "__init__.py").write_text("from .rules import EXERCISE\n")
    (folder / "solution.il").write_text(conveyor.solution)
    exercise = find_exercise(folder)
    assert (exercise.title, exercise.name) == ("Mine", "lift")
    assert exercise.grade(exercise.solution).passed
    assert exercise.fingerprint != conveyor.fingerprint


def test_usual_runs_need_no_draws(conveyor):
    assert all(usual(scenario.choices).keys() == scenario.choices.keys() for scenario in conveyor.scenarios)
