"""What all tests share: the project's root, its command, a Chromium, and Hypothesis without a clock."""

import importlib.util
import sys
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).resolve().parent.parent

# No deadline: how fast an example runs says nothing on a machine that does other work too.
settings.register_profile("ecsim", settings(), deadline=None)
settings.load_profile("ecsim")


@pytest.fixture(scope="session")
def root():
    """The project's folder."""
    return ROOT


@pytest.fixture(scope="session")
def lab():
    """The module lab.py, which stands beside the packages and is no part of them."""
    spec = importlib.util.spec_from_file_location("lab", ROOT / "lab.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["lab"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def chromium(lab):
    """The path of a Chromium that runs; without one the test is skipped and says so."""
    path = lab.find_chromium()
    if path is None:
        pytest.skip(lab.NO_CHROMIUM)
    return path
