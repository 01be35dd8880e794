"""Which packages the project installs; everything else about it stands in pyproject.toml.

The folders `widgets` and `exercises` have names too general for other people's environments, so they
are installed as `ecsim_widgets` and `ecsim_exercises`; pyproject.toml has no way to find the packages
below a renamed folder.
"""

from pathlib import Path

from setuptools import find_namespace_packages, setup

ROOT = Path(__file__).parent
FOLDERS = {"ecsim": "ecsim", "ecsim_widgets": "widgets", "ecsim_exercises": "exercises"}
NOT_CODE = ["*.js", "*.css", "*.il", "*.md", "*.svg", "*.json", "*.toml", "*.txt", "*.html"]

packages = []
for package, folder in FOLDERS.items():
    below = find_namespace_packages(str(ROOT / folder), exclude=["*__pycache__*", "*.ipynb_checkpoints*"])
    packages += [package, *(f"{package}.{name}" for name in below)]

setup(packages=packages, package_dir=FOLDERS, package_data={"": NOT_CODE})
