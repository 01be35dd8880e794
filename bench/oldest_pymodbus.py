"""The tests of ecsim.modbus with the oldest pymodbus that pyproject.toml allows; the ordinary tests run with the newest.

`python bench/oldest_pymodbus.py` fetches it into build/ with pip and leaves the environment as it is.
"""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def main():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    (needed,) = [line for line in project["dependencies"] if line.startswith("pymodbus")]
    version = re.search(r">=([\d.]+)", needed)[1]
    version += ".0" * (2 - version.count("."))
    place = ROOT / "build" / f"pymodbus-{version}"
    if not place.exists():
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", str(place), f"pymodbus=={version}"]
        subprocess.run(pip, check=True)
    environment = {**os.environ, "PYTHONPATH": str(place)}
    show = [sys.executable, "-c", "import pymodbus; print('pymodbus', pymodbus.__version__)"]
    said = subprocess.run(show, env=environment, check=True, capture_output=True, text=True).stdout
    print(said, end="", flush=True)
    if version not in said:
        sys.exit(f"expected {version}")
    return subprocess.run([sys.executable, "-m", "pytest", "-q", "tests/modbus"], cwd=ROOT, env=environment).returncode


if __name__ == "__main__":
    raise SystemExit(main())
