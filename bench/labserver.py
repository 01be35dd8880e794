"""A JupyterLab of its own and its page in Chromium, for the measurements here and for the browser tests."""

import contextlib
import json
import os
import secrets
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}
HOMES = (
    "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "JUPYTERLAB_SETTINGS_DIR", "JUPYTERLAB_WORKSPACES_DIR", "IPYTHONDIR",
)  # fmt: skip
# The session context of the notebook is ready, and its kernel connected.
CONNECTED = """() => {
  const context = window.jupyterapp?.shell.currentWidget?.sessionContext;
  return Boolean(context?.isReady && context.session?.kernel?.connectionStatus === 'connected');
}"""
# What the kernel prints for a piece of code.
EVALUATE = """async (code) => {
  const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
  const future = kernel.requestExecute({ code, store_history: false });
  let text = '';
  future.onIOPub = (message) => {
    if (message.header.msg_type === 'stream') text += message.content.text;
    if (message.header.msg_type === 'error') text += message.content.evalue;
  };
  await future.done;
  return text.trim();
}"""
# Animation frames a second, counted for so many ms.
COUNT_FRAMES = """(ms) => new Promise((done) => {
  let count = 0;
  const began = performance.now();
  const step = (now) => (now - began < ms ? (count++, requestAnimationFrame(step)) : done((1000 * count) / (now - began)));
  requestAnimationFrame(step);
})"""


def free_port() -> int:
    """A port of loopback that nobody has."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def server(folder: Path, home: Path, static: Path | None = None) -> Iterator[tuple[str, str]]:
    """A JupyterLab on a folder, with Notebook 7 under /notebooks: its address and token. Nothing of the person's own settings has a say in it.

    What lies in `static` is served under /static as well.
    """
    port, token = free_port(), secrets.token_hex(16)
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--expose-app-in-browser", "--ServerApp.ip=127.0.0.1"]
    command += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0", f"--ServerApp.root_dir={folder}"]
    command += [f"--IdentityProvider.token={token}", "--JupyterNotebookApp.expose_app_in_browser=True"]
    command += ["--LanguageServerManager.autodetect=False", *(["--allow-root"] if hasattr(os, "geteuid") and os.geteuid() == 0 else [])]
    if static is not None:
        command.append(f"--ServerApp.extra_static_paths={static}")
    environment = {**os.environ, **{name: str(home / name.lower()) for name in HOMES}, "JUPYTER_CONFIG_PATH": str(ROOT)}
    process = subprocess.Popen(
        command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        said = []
        for line in process.stdout:
            said.append(line)
            if "is running at" in line:
                break
        else:
            raise RuntimeError("JupyterLab did not start:\n" + "".join(said[-20:]))
        threading.Thread(target=process.stdout.read, daemon=True).start()  # a full pipe would stop it
        yield f"http://127.0.0.1:{port}", token
    finally:
        process.terminate()
        process.wait(timeout=20)


@contextlib.contextmanager
def page_of(code: str, browser: str) -> Iterator[tuple[Any, str]]:
    """A blank page of Chromium, and the address of a notebook with this one cell in a JupyterLab of its own."""
    from playwright.sync_api import sync_playwright

    cell = {"cell_type": "code", "execution_count": None, "id": "lab", "metadata": {}, "outputs": [], "source": code}
    book = {"cells": [cell], "metadata": {"kernelspec": KERNEL}, "nbformat": 4, "nbformat_minor": 5}
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as home:
        (Path(folder) / "lab.ipynb").write_text(json.dumps(book), encoding="utf-8")
        with server(Path(folder), Path(home)) as (address, token), sync_playwright() as playwright:
            flags = ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage")
            chromium = playwright.chromium.launch(executable_path=browser, args=flags)
            try:
                yield chromium.new_page(viewport={"width": 1920, "height": 1080}), f"{address}/lab/tree/lab.ipynb?token={token}&reset"
            finally:
                chromium.close()
