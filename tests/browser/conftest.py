"""A real JupyterLab and a real Chromium on it, each run with a home of its own."""

import importlib.util
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

_spec = importlib.util.spec_from_file_location("labserver", Path(__file__).parents[2] / "bench" / "labserver.py")
labserver = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(labserver)

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--disable-dev-shm-usage",
    "--disable-background-timer-throttling",
    "--disable-renderer-backgrounding",
    "--disable-backgrounding-occluded-windows",
)
IDLE = "() => window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.status === 'idle'"


@dataclass
class Server:
    """A running JupyterLab and the folder that it shows."""

    address: str
    token: str
    folder: Path


@pytest.fixture(scope="session")
def server(root, tmp_path_factory):
    """JupyterLab on an empty folder; nothing of the person's own settings has a say in it. VS Code's widget manager is served if it is there."""
    folder, home = tmp_path_factory.mktemp("notebooks"), tmp_path_factory.mktemp("jupyter")
    static = root / "build" / "vs_code" / "site"
    with labserver.server(folder, home, static if static.exists() else None) as (address, token):
        yield Server(address, token, folder)


@pytest.fixture(scope="session")
def browser(chromium):
    """A headless Chromium."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        yield browser
        browser.close()


class Notebook:
    """An open notebook: its page, its cells, its kernel."""

    def __init__(self, page):
        self.page = page

    def command(self, name, **arguments):
        """One of JupyterLab's own commands."""
        return self.page.evaluate("([name, arguments]) => window.jupyterapp.commands.execute(name, arguments)", [name, arguments])

    def run_all(self):
        """Run all cells and wait until the kernel has nothing more to do."""
        self.command("notebook:run-all-cells")
        self.wait_until_idle()

    def run_cell(self, index):
        """Run one cell again."""
        self.page.evaluate("(index) => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = index }", index)
        self.command("notebook:run-cell")

    def wait_until_idle(self):
        """Wait for the kernel."""
        self.page.wait_for_function(IDLE)

    def kernel(self, code):
        """What the kernel prints for a piece of code."""
        return self.page.evaluate(labserver.EVALUATE, code)

    def errors(self):
        """What cells have raised."""
        cells = """() => [...window.jupyterapp.shell.currentWidget.content.widgets].flatMap((cell) =>
            (cell.model.sharedModel.outputs ?? []).filter((output) => output.output_type === 'error').map((output) => `${output.ename}: ${output.evalue}`))"""
        return self.page.evaluate(cells)

    def sources(self):
        """The text of each cell."""
        cells = "() => [...window.jupyterapp.shell.currentWidget.content.widgets].map((cell) => cell.model.sharedModel.getSource())"
        return self.page.evaluate(cells)


@pytest.fixture(scope="module")
def open_notebook(root, server, browser):
    """Open a copy of a notebook (of notebooks/, or any by its whole path), each with a kernel of its own, ready and connected.

    Behind the module's tests pages are closed and kernels ended: a lab that runs on would slow down all that follows.
    `app` is "lab/tree" for JupyterLab, "notebooks" for Notebook 7.
    """
    pages = []

    def open_it(name, width=1280, height=900, app="lab/tree"):
        copy = f"{len(list(server.folder.glob('*.ipynb')))}-{Path(name).name}"
        shutil.copy(root / "notebooks" / name, server.folder / copy)
        page = browser.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(60_000)
        pages.append(page)
        page.goto(f"{server.address}/{app}/{copy}?token={server.token}&reset")
        page.wait_for_function(labserver.CONNECTED)
        return Notebook(page)

    yield open_it
    for page in pages:
        page.evaluate("() => window.jupyterapp.shell.currentWidget?.sessionContext?.shutdown()")
        page.close()
