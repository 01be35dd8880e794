"""Write the pages of docs/instructions and the examples of ecsim.help from TABLE and the conformance cases.

    python docs/build_instructions.py

`ecsim/help_examples.json` holds one case a mnemonic: the manual's worked example first, else the shortest that shows the
instruction at work. Only a case that passes on all its models and on both engines is taken.
"""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ecsim import help as help_on
from ecsim.help import EXAMPLES, OWN, Page, Section, examples, section_title, sections
from ecsim.help_spelled import Group, SpelledPage, group_title, groups, named, names_of
from ecsim.instructions import TABLE
from ecsim.models import MODELS
from ecsim.scenario import load_cases, run_case

ROOT = Path(__file__).resolve().parent.parent
CASES = ROOT / "tests" / "conformance"
PAGES = ROOT / "docs" / "instructions"
H2U = MODELS["H2U"]
NOTE = "<!-- Written by docs/build_instructions.py from the table of instructions; do not edit. -->"
KEPT = ("id", "models", "il", "scan_ms", "system_block", "data_block", "io", "steps", "note")


def chosen_examples() -> dict[str, dict[str, Any]]:
    """For each mnemonic the best of its cases that pass."""
    candidates: dict[str, list[dict[str, Any]]] = {}
    for path in sorted(CASES.glob("*.json")):
        for case in load_cases(path):
            mnemonic = case["mnemonic"].partition(" ")[0]  # "SET Sxx": SET in a step
            if case.get("compile_error") or "modules" in case:  # a page tells of modules that exist
                continue
            model = MODELS[case["models"][0]]
            if model.spelling:
                name = named(mnemonic, model)
                if name in (named(word, model) for word in case["il"].split()):
                    candidates.setdefault(f"FX {name}", []).append(case)
            elif mnemonic in TABLE:
                candidates.setdefault(mnemonic, []).append(case)
    found = {}
    for mnemonic in sorted(candidates):
        best = next((case for case in sorted(candidates[mnemonic], key=_rank) if _passes(case)), None)
        if best is not None:
            found[mnemonic] = {key: best[key] for key in KEPT if key in best}
    return found


def _rank(case: dict[str, Any]) -> tuple:
    """Cases of the instruction's own section, its plain name and worked examples first; then cases without an error, on more models, short ones."""
    steps, model = case["steps"], MODELS[case["models"][0]]
    row = TABLE.get(case["mnemonic"].partition(" ")[0])
    own = bool(model.spelling) or row is None or case["section"] == row.section
    size = len(case["il"].split("\n")) + sum(1 + len(step.get("set", ())) + len(step.get("expect", ())) for step in steps)
    fault = "{}{}".format(*model.flag("fault"))
    fails = any(step.get("error") or step.get("expect", {}).get(fault) for step in steps)
    shows = any(value for step in steps for value in step.get("expect", {}).values()) and not any("expect_range" in step for step in steps)
    plain = case["mnemonic"].partition(" ")[0] in case["il"].split()
    shortest = () if model.spelling else (size, case["id"])  # the cases of H1U and H2U begin with the usual one
    return not own, not plain, ("example", "text", "derived").index(case["source"]), fails, not shows, -len(case["models"]), *shortest


def _passes(case: dict[str, Any]) -> bool:
    return all(run_case(case, model, tracing).passed for model in case["models"] for tracing in (False, True))


def examples_text(found: dict[str, dict[str, Any]]) -> str:
    """The file of examples, a mnemonic a line."""
    rows = ",\n".join(f"{json.dumps(mnemonic)}: {json.dumps(case, ensure_ascii=False)}" for mnemonic, case in found.items())
    return f"{{\n{rows}\n}}\n"


def pages() -> dict[str, str]:
    """File name -> text of every page."""
    found = {f"{section}.md": _section_page(section, names) for section, names in sections().items()}
    of_fx = {_file(group): _group_page(group, names) for group, names in groups(H2U).items()}
    return {"index.md": _index(), **found, **of_fx}


def _file(group: str) -> str:
    return f"fx-{group.removeprefix('FNC ')}.md"


def _group_page(group: str, names: Iterable[str]) -> str:
    head = f"{NOTE}\n\n{Group(group, H2U)._repr_markdown_()}\n[All instructions](index.md)\n"
    return "\n".join([head, *(_deeper(SpelledPage(name, H2U)._repr_markdown_()) for name in names)])


def _section_page(section: str, names: Iterable[str]) -> str:
    head = f"{NOTE}\n\n{Section(section)._repr_markdown_()}\n[All instructions](index.md)\n"
    return "\n".join([head, *(_deeper(Page(TABLE[name])._repr_markdown_()) for name in names)])


def _deeper(text: str) -> str:
    """A page below a section's heading."""
    return "#" + text.replace("\n## ", "\n### ")


def _index() -> str:
    lines = [
        NOTE,
        "",
        "# Instructions",
        "",
        f'{len(OWN)} mnemonics of EC, in the order of the manual. In Python `ecsim.help("ADD")` shows the same,',
    ]
    lines += ["in a shell `ecsim help ADD`.", "", "| section | about | instructions |", "| --- | --- | --- |"]
    lines += [f"| [{section}]({section}.md) | {section_title(section)} | {' '.join(names)} |" for section, names in sections().items()]
    lines += ["", "## H1U and H2U", ""]
    lines += [f'{len(names_of(H2U))} instructions, with their 32-bit and pulse forms under one name: `ecsim.help("ROR", model="H2U")`,']
    lines += ["`ecsim help ROR --model H2U`. Each page says how sure it is.", "", "| group | instructions |", "| --- | --- |"]
    lines += [f"| [{group_title(group)}]({_file(group)}) | {' '.join(names)} |" for group, names in groups(H2U).items()]
    lines += ["", "## Devices", "", f"| area | kind | {' | '.join(MODELS)} |", "| --- | --- |" + " --- |" * len(MODELS)]
    kinds = {area.name: area.kind for model in MODELS.values() for area in model.areas.values()}
    for name, kind in kinds.items():
        spans = [model.areas[name].span if name in model.areas else "" for model in MODELS.values()]
        lines.append(f"| {name} | {kind} | {' | '.join(spans)} |")
    lines += [
        "",
        "KnX, KnY, KnM and so on are 4n bit devices taken as one number (K4M0); an operand with index may be followed by Z0 to Z15 (D0Z1).",
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the examples, then the pages that show them."""
    EXAMPLES.write_text(examples_text(chosen_examples()), encoding="utf-8")
    examples.cache_clear()
    PAGES.mkdir(exist_ok=True)
    texts = pages()
    for path in PAGES.glob("*.md"):
        if path.name not in texts:
            path.unlink()
    for name, text in texts.items():
        (PAGES / name).write_text(text, encoding="utf-8")
    print(f"{len(OWN) + len(names_of(H2U))} instructions on {len(texts)} pages, {len(examples())} examples")
    shown = [help_on(name) for name in OWN] + [help_on(name, "H2U") for name in names_of(H2U)]
    print("without an example:", " ".join(repr(page) for page in shown if page.example is None) or "none")


if __name__ == "__main__":
    main()
