"""`ecsim serve` as a process of its own."""

import re
import signal
import socket
import subprocess
import sys
import time

import pytest


def run(folder, *arguments):
    command = [sys.executable, "-m", "ecsim", "serve", str(folder), *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.fixture
def project(tmp_path):
    (tmp_path / "main.il").write_text("LD SM0\nINC D0\n", encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_it_runs_and_answers_until_it_is_ended(project, end):
    process = run(project, "--tcp", "0", "--speed", "10")
    try:
        line = process.stdout.readline()
        port = int(re.fullmatch(r"<Modbus server on tcp 127\.0\.0\.1:(\d+)>; Ctrl-C ends it\n", line)[1])
        with socket.create_connection(("127.0.0.1", port), timeout=10) as peer:
            values = set()
            deadline = time.monotonic() + 10
            while len(values) < 3 and time.monotonic() < deadline:
                peer.sendall(bytes.fromhex("0001 0000 0006 01 03 0000 0001"))
                values.add(peer.recv(100)[9:])
        assert len(values) == 3  # time goes by
        process.send_signal(end)
        assert process.wait(timeout=10) == 0
        assert process.stderr.read() == ""
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [((), "ecsim: nothing to serve on: give tcp=5020"), (("--rtu", "/dev/no-such-port"), "ecsim: /dev/no-such-port cannot be opened")],
)
def test_what_is_wrong_is_said_in_a_line(project, arguments, complaint):
    process = run(project, *arguments)
    _, error = process.communicate(timeout=30)
    assert process.returncode == 2
    assert error.startswith(complaint)
    assert error.count("\n") == 1


def test_a_program_that_does_not_compile_is_not_served(project):
    (project / "main.il").write_text("LD X0\nOUT Q9\n", encoding="utf-8")
    process = run(project, "--tcp", "0")
    out, error = process.communicate(timeout=30)
    assert (process.returncode, out) == (2, "")
    assert "line 2" in error
