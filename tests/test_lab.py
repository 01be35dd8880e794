"""The project's one command: what it installs, what it runs, what it says."""

import os
import re
import shutil
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

posix = pytest.mark.skipif(os.name == "nt", reason="the stand-ins for browsers are shell scripts")


EXTENSION = (
    "widgets/labextension/package.json",
    "widgets/labextension/remoteEntry.js",
    "widgets/labextension/highlight.css",
    "widgets/il.js",
    "ecsim/views/look/tokens.css",
)


@pytest.fixture
def copy(lab, tmp_path, monkeypatch):
    """The project's place, moved to a folder that holds only what the environment is installed from."""
    for name in (*lab.INSTALLED_FROM, *EXTENSION):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(lab.ROOT / name, tmp_path / name)
    monkeypatch.setattr(lab, "ROOT", tmp_path)
    monkeypatch.setattr(lab, "VENV", tmp_path / "venv")
    return tmp_path


@pytest.mark.parametrize("name", ["pyproject.toml", "constraints.txt", "setup.py"])
def test_a_change_of_what_is_installed_from_asks_for_a_new_installation(lab, copy, name):
    before = lab.environment_stamp()
    with (copy / name).open("a") as file:
        file.write("# more\n")
    assert lab.environment_stamp() != before


def test_a_moved_project_asks_for_a_new_installation(lab, copy, monkeypatch):
    before = lab.environment_stamp()
    moved = shutil.copytree(copy, copy / "moved")
    monkeypatch.setattr(lab, "ROOT", moved)
    assert lab.environment_stamp() != before


def test_an_unchanged_project_is_not_installed_again(lab, copy, monkeypatch):
    monkeypatch.setattr(lab, "PYTHON", Path(sys.executable))
    monkeypatch.setattr(lab, "STAMP", copy / "stamp")
    (copy / "stamp").write_text(lab.environment_stamp())
    monkeypatch.setattr(lab, "install", lambda uv: pytest.fail("installed again"))
    lab.make_environment()


def test_the_lab_s_extension_is_put_in_place_as_it_is_now(lab, copy, monkeypatch):
    monkeypatch.setattr(lab, "PYTHON", Path(sys.executable))
    monkeypatch.setattr(lab, "STAMP", copy / "stamp")
    (copy / "stamp").write_text(lab.environment_stamp())
    (copy / "widgets/il.js").write_text("// of today")
    lab.make_environment()
    placed = copy / "venv/share/jupyter/labextensions/ecsim"
    assert (placed / "package.json").is_file()
    assert sorted(file.name for file in (placed / "static").iterdir()) == sorted(Path(name).name for name in EXTENSION[1:])
    assert (placed / "static/il.js").read_text() == "// of today"


def test_an_installation_that_fails_is_tried_again_the_next_time(lab, copy, monkeypatch):
    monkeypatch.setattr(lab, "PYTHON", Path(sys.executable))
    monkeypatch.setattr(lab, "STAMP", copy / "stamp")
    (copy / "stamp").write_text("of an older project")
    monkeypatch.setattr(lab, "run", lambda command, environment=None: 1)
    with pytest.raises(lab.LabError, match="did not finish"):
        lab.make_environment()
    assert not (copy / "stamp").exists()


def test_pip_does_what_uv_cannot(lab, monkeypatch):
    commands = []

    def run(command, environment=None):
        commands.append(command)
        return 1 if "--python" in command else 0

    monkeypatch.setattr(lab, "run", run)
    lab.install("uv-on-path")
    assert [command[:2] for command in commands] == [["uv-on-path", "pip"], [str(lab.PYTHON), "-m"]]
    assert all(command[-4:] == ["--constraint", "constraints.txt", "--editable", ".[lab,test]"] for command in commands)


def test_a_python_that_cannot_run_is_not_usable(lab, tmp_path):
    assert lab.usable(Path(sys.executable))
    assert not lab.usable(tmp_path / "python")


def test_a_missing_ensurepip_is_named_with_the_remedy(lab, monkeypatch):
    monkeypatch.setattr(lab.importlib.util, "find_spec", lambda name: None if name == "ensurepip" else name)
    with pytest.raises(lab.LabError) as caught:
        lab.create_venv(None)
    assert "its module ensurepip is missing" in str(caught.value)
    assert "apt install python3-venv" in str(caught.value)


def test_uv_learns_the_mirror_that_pip_was_told(lab, monkeypatch):
    monkeypatch.setattr(lab, "PYTHON", Path(sys.executable))
    monkeypatch.setenv("PIP_INDEX_URL", "http://127.0.0.1:9/simple")
    monkeypatch.setenv("PIP_EXTRA_INDEX_URL", "http://127.0.0.1:9/a http://127.0.0.1:9/b")
    monkeypatch.setenv("UV_INDEX", "http://127.0.0.1:9/own")
    monkeypatch.delenv("UV_DEFAULT_INDEX", raising=False)
    settings = lab.uv_settings()
    assert settings["UV_DEFAULT_INDEX"] == "http://127.0.0.1:9/simple"
    assert "UV_INDEX" not in settings  # uv has its own word on it


def test_arguments_after_dashes_go_to_pytest(lab):
    assert lab.split_at_dashes(["test", "--", "-x", "--", "y"]) == (["test"], ["-x", "--", "y"])
    assert lab.split_at_dashes(["test", "--quick"]) == (["test", "--quick"], [])
    (part,) = lab.test_parts(False, "conveyor", ["-x"])
    assert part.command[-3:] == ["-k", "conveyor", "-x"]


def test_arguments_after_dashes_are_refused_without_test(lab):
    with pytest.raises(lab.LabError, match=r"python3 lab\.py test -- -x"):
        lab.main(["setup", "--", "-x"])


def test_a_taken_port_is_refused_with_a_remedy(lab):
    with socket.create_server(("127.0.0.1", 0)) as server:
        taken = server.getsockname()[1]
        with pytest.raises(lab.LabError, match=f"Port {taken} is in use"):
            lab.chosen_port(taken)
    assert lab.chosen_port(taken) == taken


def test_without_a_wish_the_port_is_the_first_free_one(lab, monkeypatch):
    monkeypatch.setattr(lab, "is_free", lambda port: port >= lab.FIRST_PORT + 2)
    assert lab.chosen_port(None) == lab.FIRST_PORT + 2


@pytest.mark.parametrize(
    ("variables", "platform", "expected"),
    [
        ({"CI": "true", "DISPLAY": ":0"}, "linux", False),
        ({}, "linux", False),
        ({"DISPLAY": ":0"}, "linux", True),
        ({"WAYLAND_DISPLAY": "wayland-0"}, "linux", True),
        ({}, "darwin", True),
        ({}, "win32", True),
    ],
)
def test_a_browser_opens_where_there_is_a_screen(lab, monkeypatch, variables, platform, expected):
    for name in ("CI", "DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys, "platform", platform)
    assert lab.can_show_a_browser() is expected


@pytest.mark.parametrize(("user", "expected"), [(0, True), (1000, False)])
def test_only_root_is_allowed_as_root(lab, monkeypatch, user, expected):
    monkeypatch.setattr(os, "geteuid", lambda: user, raising=False)
    assert ("--allow-root" in lab.server_command(8888, "lab", False)) is expected


def test_a_server_that_ends_at_once_is_told(lab):
    server = subprocess.Popen([sys.executable, "-c", "raise SystemExit(3)"])
    server.wait()
    with pytest.raises(lab.LabError, match="ended with code 3"):
        lab.wait_until_it_answers(server, 9, "token")


def test_the_lab_answers_on_loopback_and_to_its_token_alone(lab, tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    code = f"import sys, lab; lab.PYTHON = lab.Path(sys.executable); sys.exit(lab.open_lab({port}, False))"
    server = subprocess.Popen(
        [sys.executable, "-c", code], cwd=lab.ROOT, env=lab.test_environment(tmp_path), stdout=subprocess.PIPE, text=True
    )
    try:
        address = next((line.strip() for line in server.stdout if "http://" in line), "")
        host, page, token = re.fullmatch(r"(http://127\.0\.0\.1:\d+)/(\S+)\?token=(\w+)", address).groups()
        assert page == f"lab/tree/{lab.FIRST_NOTEBOOK}"
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        with opener.open(address) as answer:
            assert answer.status == 200
        with opener.open(f"{host}/lab/api/settings/@jupyterlab/apputils-extension:notification?token={token}") as answer:
            assert '"fetchNews": {"title": "Fetch official Jupyter news"' in (text := answer.read().decode()), text
            assert '"default": "false"' in text
        with pytest.raises(urllib.error.HTTPError, match="403"):
            opener.open(f"{host}/api/contents")
    finally:
        server.terminate()
        server.communicate()


def script(path, code):
    """Write an executable that ends with a code."""
    path.write_text(f"#!/bin/sh\nexit {code}\n")
    path.chmod(0o755)
    return str(path)


@posix
def test_a_chromium_is_found_on_the_path(lab, tmp_path, monkeypatch):
    monkeypatch.delenv("ECSIM_CHROMIUM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(lab, "CHROMIUM_PLACES", ())
    assert lab.find_chromium() is None
    script(tmp_path / "chromium-browser", 1)  # a signpost, as some distributions have it
    assert lab.find_chromium() is None
    chrome = script(tmp_path / "google-chrome", 0)
    assert lab.find_chromium() == chrome
    monkeypatch.setenv("ECSIM_CHROMIUM", script(tmp_path / "mine", 0))
    assert lab.find_chromium() == str(tmp_path / "mine")


def test_a_missing_chromium_is_told_with_the_remedy(lab, monkeypatch):
    monkeypatch.setattr(lab, "find_chromium", lambda: None)
    browser = lab.test_parts(False, None, [])[-1]
    assert browser.name == "browser"
    assert "apt install chromium" in browser.skipped


def test_quick_says_what_it_leaves_out(lab):
    left_out = {part.name for part in lab.test_parts(True, None, []) if part.skipped}
    assert left_out == {"notebooks", "browser"}


def part(lab, name, code, **more):
    return lab.Part(name, [sys.executable, "-c", f"raise SystemExit({code})"], **more)


@pytest.mark.parametrize(("code", "expected"), [(0, 0), (1, 1), (5, 1)])
def test_the_command_fails_when_a_part_fails(lab, monkeypatch, capsys, code, expected):
    parts = [part(lab, "style", code), part(lab, "tests", 0), part(lab, "browser", 1, skipped="no browser here")]
    monkeypatch.setattr(lab, "test_parts", lambda *_: parts)
    assert lab.run_tests() == expected
    said = capsys.readouterr().out
    assert ("ecsim: FAILED: style" in said) is bool(expected)
    assert re.search(r"browser +skipped +no browser here", said)


def test_the_closing_table_names_the_tests_that_failed(lab, monkeypatch, capsys, tmp_path):
    (tmp_path / "test_three.py").write_text(
        "import pytest\n\n@pytest.fixture\ndef broken(): 1 / 0\n\ndef test_good(): pass\ndef test_bad(): assert 0\ndef test_none(broken): pass\n"
    )
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(tmp_path), str(tmp_path)]
    monkeypatch.setattr(lab, "test_parts", lambda *_: [lab.Part("tests", command)])
    assert lab.run_tests() == 1
    table = capsys.readouterr().out.partition("FAILED")[2].splitlines()
    assert [line.strip() for line in table[1:3]] == ["test_three::test_bad", "test_three::test_none"]


def test_a_part_that_may_be_empty_is_told_as_skipped(lab, monkeypatch, capsys):
    monkeypatch.setattr(lab, "test_parts", lambda *_: [part(lab, "browser", 5, may_be_empty="no such test")])
    assert lab.run_tests() == 0
    assert re.search(r"browser +skipped +no such test", capsys.readouterr().out)
