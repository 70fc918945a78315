# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the documents say exists: every launch argument, parameter and topic, and the links between pages."""

import ast
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from acts_tools.export.command import FORMATS

ROOT = Path(__file__).resolve().parent.parent.parent
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])
INDEX = ROOT / "docs" / "README.md"


def test_the_reference_lists_every_parameter_and_launch_argument() -> None:
    finished = subprocess.run(
        [sys.executable, ROOT / "scripts" / "reference.py", "--check"], capture_output=True, text=True, timeout=60
    )
    assert finished.returncode == 0, finished.stdout + finished.stderr


@pytest.mark.parametrize("changelog", sorted(ROOT.glob("*/CHANGELOG.rst")), ids=lambda path: path.parent.name)
def test_a_changelog_holds_no_mark_of_a_merge(changelog: Path) -> None:
    assert not re.findall(r"^(?:<{7}|>{7}) .*", changelog.read_text(), re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}-{page.name}")
def test_links_lead_somewhere(page: Path) -> None:
    text = page.read_text()
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", text):
        assert (page.parent / target).exists(), f"{page.name} links to {target}"
    for name in re.findall(r"`(docs/[a-z0-9_]+\.md)`", text):
        assert (ROOT / name).exists(), f"{page.name} names {name}"


def made_in_code(method: str) -> set[str]:
    """Topics or services that nodes make under a name that stands in the code."""
    found = set()
    for path in ROOT.glob("acts_*/acts_*/**/*.py"):
        if "acts_tools" in path.parts:
            continue  # measures what others publish
        for node in ast.walk(ast.parse(path.read_text())):
            match node:
                case ast.Call(func=ast.Attribute(attr=attr), args=[_, ast.Constant(value=str(name)), *_]) if (
                    attr == method
                ):
                    found.add(name)
    return found


def test_the_readme_names_every_topic_and_service() -> None:
    text = (ROOT / "README.md").read_text()
    topics, services = made_in_code("create_publisher"), made_in_code("create_service")
    assert {"samples", "contact", "hand/status"} <= topics
    assert {"~/calibrate", "~/start"} <= services
    missing = {name for name in topics if not re.search(rf"`/?{re.escape(name.lstrip('/'))}`", text)}
    missing |= {name for name in services if not re.search(rf"`([a-z_]+/)?{name.removeprefix('~/')}`", text)}
    assert not missing


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=lambda page: page.name)
def test_the_index_leads_to_every_page_and_each_begins_with_a_command(page: Path) -> None:
    if page == INDEX:
        return
    assert f"]({page.name})" in INDEX.read_text(), f"{page.name} is missing in docs/README.md"
    begin = page.read_text().splitlines()[:18]
    assert any(re.match(r"```|    \S|.*`\S+ \S+", line) for line in begin), f"{page.name} begins without a command"


def headings(page: Path) -> set[str]:
    """Anchors of a page, as GitHub makes them."""
    lines = re.findall(r"^#+ (.+)$", page.read_text(), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", line.lower()).replace(" ", "-") for line in lines}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}-{page.name}")
def test_links_into_pages_lead_to_a_heading(page: Path) -> None:
    for target, anchor in re.findall(r"\]\((?!https?:)([^)#]*\.md)?#([^)]+)\)", page.read_text()):
        other = page.parent / target if target else page
        assert anchor in headings(other), f"{page.name} links to {target}#{anchor}"


def test_what_pages_call_an_argument_is_one_of_a_launch_file() -> None:
    """Pages gave parameters so, which `ros2 launch` silently ignores."""
    files = (ROOT / "launch").glob("*.launch.xml")
    names = {arg.get("name") for file in files for arg in ElementTree.parse(file).iter("arg")}
    names |= {"sigterm_timeout", "sigkill_timeout", "dictionry"}  # of the launcher; the example of a wrong one
    given = [(page.name, name) for page in PAGES for name in re.findall(r"`([a-z_]+):=[^`]*`", page.read_text())]
    assert len(given) > 30
    assert [(page, name) for page, name in given if name not in names] == []


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_what_the_commands_of_the_pages_write_is_no_change_of_the_checkout(tmp_path: Path) -> None:
    text = "\n".join(page.read_text() for page in PAGES)
    written = set(re.findall(r"acts (?:\S+ )*?(?:-o|--out|--json|--picture|--recordings) ([a-z0-9_./]+)", text))
    # Without -o: named after bag and format.
    written |= {
        f"{bag}.npz" if kind == "npz" else f"{bag}_{kind}"
        for bag in re.findall(r"acts export (\w+) --to \w+ +#", text)
        for kind in FORMATS
    }
    # Without --out.
    written |= {"figures" + "_fast" * ("--fast" in words) for words in re.findall(r"acts figures(?! .*--out).*", text)}
    shown = {"touch", "touch_csv", "touch.npz", "objects.npz", "out/one.json", "scenes", "figures", "figures_fast"}
    assert shown <= written
    shutil.copy(ROOT / ".gitignore", tmp_path)
    subprocess.run(["git", "init", "--quiet", tmp_path], check=True, timeout=60)
    ignored = subprocess.run(
        ["git", "-C", tmp_path, "check-ignore", "--stdin"],
        input="\n".join(written),
        capture_output=True,
        text=True,
        timeout=60,
    ).stdout.split()
    assert [name for name in sorted(written - set(ignored)) if not (ROOT / name).exists()] == []


EXAMPLES = [
    (page, code)
    for page in ("extending.md", "hand.md", "reflexes.md")
    for code in re.findall(r"```python\n(.*?)```", (ROOT / "docs" / page).read_text(), re.DOTALL)
]


@pytest.mark.skipif(shutil.which("ruff") is None, reason="needs ruff: pip install ruff")
@pytest.mark.parametrize("words", [("check", "--quiet"), ("format", "--diff", "--quiet")], ids=["rules", "format"])
@pytest.mark.parametrize(("page", "code"), EXAMPLES, ids=lambda part: part if part.endswith(".md") else "")
def test_modules_to_be_copied_keep_the_rules(page: str, code: str, words: tuple[str, ...]) -> None:
    code = "".join(Path(__file__).read_text().splitlines(keepends=True)[:3]) + code
    command = ["ruff", *words, "--stdin-filename", str(ROOT / "acts_core" / "acts_core" / "example.py"), "-"]
    finished = subprocess.run(command, input=code, capture_output=True, text=True, timeout=60, cwd=ROOT)
    assert finished.returncode == 0, f"{page}: {finished.stdout}{finished.stderr}"


def test_what_is_registered_reaches_the_reference_and_the_launch_files_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    written = runpy.run_path(str(ROOT / "scripts" / "reference.py"))
    written["written_files"]()  # imports the nodes, whose parameters are those of the reflexes that there are
    monkeypatch.setitem(written["LISTED"]["reflexes"], "mine", written["REFLEXES"]["slip"])
    files = {path.name: text for path, text in written["written_files"]().items()}
    names = ", ".join(written["REFLEXES"])
    for name in ("hand_reflexes.launch.xml", "reference.md"):
        assert f"between: {names}; none: " in files[name]


# What the pages on extending have one write.
WRITTEN = {"fading", "overlap", "numbered_lines", "tilting_table", "comb", "tap_to_open", "line_servos", "NAME"}
TRACKED = [
    path for folder in ROOT.iterdir() if not folder.name.startswith(".") for path in [folder, *folder.rglob("*")]
]
SOURCES = [
    path
    for path in TRACKED
    if path.suffix in (".md", ".py", ".hpp", ".cpp", ".ino", ".msg", ".xml")
    and "test" not in path.relative_to(ROOT).parts
]


def is_there(name: str) -> bool:
    """Whether a path or a module with dots, from wherever its reader would begin, exists; of a message's header, it."""
    header = re.fullmatch(r"acts_msgs/msg/(\w+)\.hpp", name)
    if header is not None:
        return header[1] in {
            re.sub(r"(?<=[a-z])(?=[A-Z])", "_", path.stem).lower() for path in ROOT.glob("acts_msgs/msg/*.msg")
        }
    return any(str(path).endswith(f"/{name}") for path in TRACKED)


def is_module(name: str) -> bool:
    """Whether a name with dots is a module, or something that a module names."""
    package, *parts = name.split(".")
    folder = ROOT / package / package
    for k, part in enumerate(parts):
        if (folder / part).is_dir():
            folder /= part
            continue
        own = folder / f"{part}.py"
        wanted = parts[k + 1 :] if own.is_file() else [part]
        text = (own if own.is_file() else folder / "__init__.py").read_text()
        return not wanted or re.search(rf"\b{re.escape(wanted[0])}\b", text) is not None
    return True


def test_files_and_modules_that_pages_and_comments_name_exist() -> None:
    missing = []
    for source in SOURCES:
        for number, line in enumerate(source.read_text().splitlines(), 1):
            paths = re.findall(r"(?<![\w/.~$-])(acts_\w+/(?:\w+/)*\w+\.(?:py|hpp|cpp|ya?ml|xml|md))\b", line)
            modules = re.findall(r"\b(acts_(?!msgs|firmware|config|bringup)[a-z]+(?:\.[A-Za-z_]\w*)+)", line)
            wrong = [name for name in paths if Path(name).stem not in WRITTEN and not is_there(name)]
            wrong += [name for name in modules if not is_module(name)]
            missing += [f"{source.relative_to(ROOT)}:{number} names {name}" for name in wrong]
    assert missing == []


def test_headings_that_messages_and_comments_name_exist() -> None:
    named = [
        (source.relative_to(ROOT), ROOT / page, heading.strip())
        for source in SOURCES
        for page, heading in re.findall(r'\b((?:docs/)?\w+\.md), "?([A-Z][^".`:;)\n]+)', source.read_text())
    ]
    assert len(named) > 5
    missing = [
        f"{source} names {page.name}, {heading}"
        for source, page, heading in named
        if not re.search(rf"^#+ {re.escape(heading)}", page.read_text(), flags=re.MULTILINE)
    ]
    assert missing == []
