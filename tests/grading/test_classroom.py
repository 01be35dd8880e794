"""Submissions apart from each other: limits, rubbish, a class on this machine and on a cluster, resumed, with the same marks."""

import json
import os
import sys

import pytest

from ecsim import EcsimError
from ecsim.cli import main
from ecsim.grading import find_exercise
from ecsim.grading.classroom import grade_class, read_table, submissions_in
from ecsim.grading.sandbox import Judge, Limits, Submission

ENDLESS = "LD SM0\nOUT Y4\nOUT Y5\nLBL 1\nLD SM0\nWDT\nCJ 1"
posix = pytest.mark.skipif(not hasattr(os, "fork"), reason="limits of the processor and of memory are POSIX")


def submission(text, name="anna"):
    return Submission(name, {f"{name}.il": text if isinstance(text, bytes) else text.encode()})


@pytest.fixture(scope="module")
def judge():
    with Judge("conveyor") as judge:
        yield judge


def test_a_judge_gives_the_report_that_grading_here_gives(judge, conveyor):
    text = conveyor.mistakes["cycle_ends_early"][0]
    apart, here = judge.grade(submission(text)), conveyor.grade(text)
    assert json.loads(apart.as_json()) == {**json.loads(here.as_json()), "took_s": apart.took_s, "program": "anna"}


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"\xff\xfe\x00rubbish", "is no text in UTF-8"),
        (b"LD X0\0", "it holds zero bytes"),
        (b"LD X0\n" * 200_000, "The program has 1,200,000 bytes"),
        (b"import os; os.remove('x')", "does not compile"),
        (b"", ""),
        ("LD X0\nOUT Y0\n" * 20_000, "does not compile"),
    ],
)
def test_rubbish_costs_its_author_the_mark(judge, content, reason):
    report = judge.grade(submission(content))
    assert report.marks == 0
    assert reason in report.reason


def test_the_judge_goes_on_after_rubbish(judge, conveyor):
    assert judge.grade(submission(conveyor.solution)).passed


def test_an_endless_loop_ends_by_the_watchdog(judge):
    report = judge.grade(submission(ENDLESS.replace("WDT\n", "")))
    assert report.marks <= 2
    assert any("61" in note for note in report.notes)


@posix
def test_a_program_that_takes_too_long_is_ended():
    with Judge("conveyor", limits=Limits(cpu_s=1, wall_s=30)) as judge:
        report = judge.grade(submission(ENDLESS))
        assert report.reason == "The program took more than 1 s of the processor."
        assert judge.grade(submission("LD X0\nOUT Q")).problems != []  # the judge is still there


@posix
def test_the_wall_clock_ends_it_too():
    with Judge("conveyor", limits=Limits(cpu_s=60, wall_s=0.3)) as judge:
        assert "took more than 0.3 s" in judge.grade(submission(ENDLESS)).reason


@posix
def test_a_program_that_takes_too_much_memory_is_ended(conveyor):
    with Judge("conveyor", limits=Limits(memory_mb=8)) as judge:
        report = judge.grade(submission(conveyor.solution))
    assert report.marks == 0
    assert "memory" in report.reason or "8 MB" in report.reason


@posix
def test_nothing_is_written_sent_or_started_while_grading(tmp_path):
    import subprocess

    code = (
        "import os, socket, sys\n"
        "from ecsim.grading.sandbox import Limits, _confine\n"
        "_confine(Limits())\n"
        f"for act in (lambda: open({str(tmp_path / 'x')!r}, 'w'), lambda: socket.socket().connect(('127.0.0.1', 9)), lambda: os.system('true'), os.fork):\n"
        "    try:\n        act()\n    except PermissionError as error:\n        print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.count("is not allowed while a program is graded") == 4, done.stderr
    assert list(tmp_path.iterdir()) == []


# ---- a class -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path, conveyor):
    """Six submissions: right, wrong, rubbish, endless, a folder with a right one, an empty folder."""
    folder = tmp_path / "submissions"
    folder.mkdir()
    (folder / "anna.il").write_text(conveyor.solution)
    (folder / "ben.il").write_text(conveyor.mistakes["cycle_ends_early"][0])
    (folder / "cleo.il").write_bytes(b"\xff\xfe")
    (folder / "dora.il").write_text(ENDLESS.replace("WDT\n", ""))
    (folder / "emil").mkdir()
    (folder / "emil" / "main.il").write_text(conveyor.solutions["number"])
    (folder / "fine").mkdir()
    return folder


def test_a_class_gets_its_marks_its_table_and_its_pages(folder, conveyor, tmp_path):
    seen = []
    table, pages = tmp_path / "marks.csv", tmp_path / "report"
    graded = grade_class(conveyor, folder, table, pages, workers=2, progress=lambda *told: seen.append(told))
    assert {row.name: row.marks for row in graded.rows} == {
        "anna": 14,
        "ben": 13,
        "cleo": 0,
        "dora": pytest.approx(1, abs=1),
        "emil": 14,
        "fine": 0,
    }
    assert sorted(done for done, of, name in seen) == [1, 2, 3, 4, 5, 6]
    rows = read_table(table)
    assert rows["ben"].states["one-at-a-time"] == "failed"
    assert rows["fine"].reason == "There is no .il file."
    assert sorted(path.name for path in pages.iterdir()) == [
        *(f"{name}.html" for name in ("anna", "ben", "cleo", "dora", "emil", "fine")),
        "index.html",
    ]
    assert 'href="ben.html"' in (pages / "index.html").read_text()
    assert "one-at-a-time" in (pages / "ben.html").read_text()

    before = table.read_bytes()
    again = grade_class(conveyor, folder, table, pages, workers=1)
    assert (again.taken_over, table.read_bytes()) == (6, before)

    (folder / "ben.il").write_text(conveyor.solution)
    lines = table.read_text().splitlines(keepends=True)
    table.write_text("".join(lines[:3]) + lines[3][:9])  # the run was broken off in the middle of a row
    third = grade_class(conveyor, folder, table, pages, workers=1)
    assert third.taken_over == 1
    assert {row.name: row.marks for row in third.rows}["ben"] == 14


@pytest.mark.slow
def test_the_marks_are_the_same_at_any_number_of_workers_and_on_a_cluster(folder, conveyor, tmp_path):
    from distributed import LocalCluster

    (folder / "dora.il").unlink()
    tables = [tmp_path / f"{name}.csv" for name in ("one", "three", "cluster")]
    grade_class(conveyor, folder, tables[0], workers=1)
    grade_class(conveyor, folder, tables[1], workers=3)
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0") as cluster:
        grade_class(conveyor, folder, tables[2], scheduler=cluster.scheduler_address)
    texts = [table.read_text() for table in tables]
    assert texts[0] == texts[1] == texts[2]


def test_no_scheduler_is_told_in_words(folder, conveyor):
    with pytest.raises(EcsimError, match=r"no Dask scheduler at tcp://127\.0\.0\.1:1"):
        grade_class(conveyor, folder, scheduler="tcp://127.0.0.1:1")


def test_folders_and_tables_that_cannot_be_used_are_refused(tmp_path, conveyor, folder):
    with pytest.raises(EcsimError, match="there is no folder"):
        submissions_in(tmp_path / "none")
    (tmp_path / "empty").mkdir()
    with pytest.raises(EcsimError, match="holds no submissions"):
        submissions_in(tmp_path / "empty")
    other = tmp_path / "other.csv"
    other.write_text("a,b\n1,2\n")
    with pytest.raises(EcsimError, match="no table of marks"):
        grade_class(conveyor, folder, other)
    assert other.read_text() == "a,b\n1,2\n"
    (folder / "emil.il").write_text("")
    with pytest.raises(EcsimError, match="two submissions of 'emil'"):
        submissions_in(folder)


# ---- the commands ------------------------------------------------------------------------------------------------------


def test_the_command_grades_a_program(conveyor, tmp_path, capsys):
    answer = tmp_path / "answer.il"
    answer.write_text(conveyor.solution)
    assert main(["grade", "conveyor", str(answer)]) == 0
    assert "14 of 14 rules, 14 of 14 marks" in capsys.readouterr().out
    answer.write_text(conveyor.mistakes["cycle_ends_early"][0])
    assert main(["grade", "conveyor", str(answer), "--json", "--html", str(tmp_path / "r.html"), "--hint"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert (data["marks"], data["program"]) == (13, "answer")
    assert "network" in data["hint"]
    assert "data-rule" in (tmp_path / "r.html").read_text()


def test_the_command_shows_how_far_the_search_for_a_hint_is(tmp_path, capsys, monkeypatch):
    answer = tmp_path / "answer.il"
    answer.write_text(find_exercise("motor").mistakes["no_hold"][0])
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert main(["grade", "motor", str(answer), "--hint"]) == 1
    said = capsys.readouterr()
    assert "hint: " in said.out
    shares = [int(line.partition("] ")[2].partition("/100 looking for a hint")[0]) for line in said.err.split("\r")[1:]]
    assert shares == sorted(set(shares))
    assert shares
    assert said.err.endswith("\n")
    assert main(["grade", "motor", str(answer), "--json"]) == 1
    assert capsys.readouterr().err == ""  # without --hint nothing is looked for


def test_the_command_grades_a_class(folder, tmp_path, capsys):
    for name in ("cleo.il", "dora.il"):
        (folder / name).unlink()
    assert (
        main(["grade", "conveyor", str(folder), "--report", str(tmp_path / "m.csv"), "--html", str(tmp_path / "r"), "--workers", "2"]) == 1
    )
    out = capsys.readouterr().out
    assert "anna                        14 of 14" in out
    assert "4 submissions, 2 with all marks (0 graded before)" in out
    assert main(["grade", "conveyor", str(folder), "--report", str(tmp_path / "m.csv"), "--json"]) == 1
    assert [row["name"] for row in json.loads(capsys.readouterr().out)] == ["anna", "ben", "emil", "fine"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["grade", "nothing", "x.il"], "there is no exercise 'nothing'"),
        (["grade", "conveyor", "x.il"], "x.il cannot be read"),
        (["grade", "conveyor", "x.il", "--workers", "2"], "are for a folder of submissions"),
        (["grade", "conveyor", "x.il", "--model", "H3U"], "not for H3U"),
        (["mutate", "nothing"], "there is no exercise"),
    ],
)
def test_a_wrong_use_is_told_in_words(arguments, words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert words in capsys.readouterr().err


def test_a_project_folder_is_graded_with_its_system_block(tmp_path, conveyor, judge):
    """The program starts only with what its data block holds; the scan stays the exercise's."""
    project = tmp_path / "anna"
    project.mkdir()
    (project / "main.il").write_text(conveyor.solution.replace("LD   Start", "LD   Start\nAND= D7 1"))
    (project / "plc.toml").write_text('model = "EC20"\nscan_ms = 500\nio = [[24, 16]]\ninput_filter_ms = 20\n[data_block]\nD7 = 1\n')
    assert judge.grade(Submission.read(project)).passed
    assert conveyor.grade(project).passed
    (project / "plc.toml").write_text('model = "EC20"\ninput_filter_ms = 20\n')
    report = conveyor.grade(project)
    assert not report.passed
    assert report.replay().plc.system.input_filter_ms == 20
    assert judge.grade(Submission.read(project)).marks == report.marks
    (project / "plc.toml").write_text('model = "EC20"\ninput_filter_ms = "long"\n')
    assert "plc.toml" in judge.grade(Submission.read(project)).reason
    with pytest.raises(EcsimError, match=r"plc\.toml"):
        conveyor.grade(project)
