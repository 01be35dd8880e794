"""The tables that the scripts write into docs/: each has its place between two marks with the script's name."""

from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PERFORMANCE = ROOT / "docs" / "performance.md"
GRADING = ROOT / "docs" / "grading.md"


def put(page: Path, name: str, lines: Iterable[str]) -> None:
    """Write lines between `<!-- name -->` and `<!-- /name -->` of a page, in the place of what stands there."""
    begin, end = f"<!-- {name} -->", f"<!-- /{name} -->"
    before, _, rest = page.read_text(encoding="utf-8").partition(begin)
    _, found, after = rest.partition(end)
    if not found:
        raise SystemExit(f"{page.relative_to(ROOT)} has no `{begin}` with an `{end}` behind it; write them where the table belongs")
    page.write_text("\n".join([before + begin, "", *lines, "", end + after]), encoding="utf-8")
