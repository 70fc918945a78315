# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The acts command itself: help, version, errors, and what importing it costs."""

from __future__ import annotations

import argparse
import contextlib
import errno
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from fake_prefix import Prefix

from acts_core.stop_signals import STOP_SIGNALS
from acts_tools import INTERRUPTED, __version__
from acts_tools.__main__ import run
from acts_tools.cli import COMMANDS, _build_parser, main
from acts_tools.launch import command

PACKAGE = Path(__file__).parents[2]


def test_help_names_every_command_and_imports_none_of_them(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    assert ended.value.code == 0
    text = capsys.readouterr().out
    for name, (_, summary) in COMMANDS.items():
        # A long name has a line of its own.
        assert re.search(rf"^    {name}\s+{re.escape(summary)}$", text, re.MULTILINE)


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_each_command_has_examples_that_it_takes(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    parser, _ = _build_parser(name)
    with pytest.raises(SystemExit):
        parser.parse_args([name, "--help"])
    after = capsys.readouterr().out.partition("\nexamples:\n")[2].split("\n\n")[0]
    examples = re.findall(r"^  acts (.+?)(?:  .*)?$", after, re.MULTILINE)
    assert examples
    for example in examples:
        words = shlex.split(example.partition(" | ")[0])
        assert words[0] == name
        if name == "launch":  # as `main` does
            words.sort(key=lambda word: word.startswith("-"))
        parser.parse_args(words)


def _subcommands(parser: argparse.ArgumentParser) -> list[argparse.ArgumentParser]:
    """Those of a parser, and those of each of them; of several words, such as ``evaluate slip``, too."""
    found = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for child in action.choices.values():
                found += [child, *_subcommands(child)]
    return found


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_each_command_says_what_it_is_for_and_what_options_are_by_default(name: str) -> None:
    # Others have a line only, until they are chosen.
    for parser in _subcommands(_build_parser(name)[0]):
        if parser.prog.split()[1] != name:
            continue
        assert parser.description, parser.prog
        for action in parser._actions:
            if isinstance(action, argparse._HelpAction | argparse._SubParsersAction):
                continue
            says_it = "default" in (action.help or "")
            assert says_it or action.default in (None, False, "", []), f"{parser.prog} {action.option_strings}"


def test_without_a_command_it_shows_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert capsys.readouterr().out.startswith("usage: acts")


def test_an_unknown_command_is_refused_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["fly"])
    assert ended.value.code == 2
    assert "launch" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "command"),
    [
        (["info", "touch", "--seeds", "2"], "acts info"),
        (["evaluate", "events", "--seeds", "2"], "acts evaluate events"),
        (["--seeds", "info", "touch"], "acts"),
    ],
)
def test_an_unknown_option_is_refused_with_the_usage_of_its_command(
    words: list[str], command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    told = capsys.readouterr().err
    assert told.startswith(f"usage: {command} [-h]")
    assert f"\n{command}: error: " in told
    assert "--seeds" in told


def test_the_version_is_the_package_s(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out == f"acts {__version__}\n"
    assert f"<version>{__version__}</version>" in (PACKAGE / "package.xml").read_text()
    assert f'version="{__version__}"' in (PACKAGE / "setup.py").read_text()


def test_it_is_on_the_path_of_the_environment() -> None:
    said = subprocess.run(["acts", "--version"], capture_output=True, text=True, check=True).stdout
    assert said == f"acts {__version__}\n"


@pytest.mark.parametrize(("file", "about"), [("results.json", "results.json: "), (None, "")])
def test_a_full_disk_is_told_in_one_line(
    file: str | None, about: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fill_the_disk(_arguments: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device", file)

    monkeypatch.setattr("acts_tools.doctor.command.run", fill_the_disk)
    assert main(["doctor"]) == 1
    assert capsys.readouterr().err == f"error: {about}No space left on device: make room and try again\n"


@pytest.fixture
def nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """No folder for temporary files, as on a full disk."""
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setattr(tempfile, "_candidate_tempdir_list", lambda: ["/proc/nowhere"])


def test_without_room_for_temporary_files_it_is_told_in_one_line(
    nowhere: None, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("acts_tools.doctor.command.run", lambda _: tempfile.mkdtemp())
    assert main(["doctor"]) == 1
    told = "error: No usable temporary directory found in ['/proc/nowhere']: make room and try again\n"
    assert capsys.readouterr().err == told


def test_without_room_for_temporary_files_what_needs_none_is_launched(
    prefix: Prefix, nowhere: None, capsys: pytest.CaptureFixture[str]
) -> None:
    prefix.script("node", "#!/bin/sh\nexit 0\n")
    prefix.launch("it.launch.xml", '<node pkg="fake" exec="node"/>')
    assert main(["launch", "--own", "fake", "it.launch.xml"]) == 0
    assert "[node-1]: process has finished cleanly" in capsys.readouterr().out


@pytest.mark.parametrize(
    "words",
    [
        "export {} --to csv",
        "record -a -o {}",
        "train -o out.npz --frames {}",
        "evaluate convert slips {} -o out.npz",
        "launch --own {}",
        "doctor --root {}",
        "selftest {}",
    ],
)
def test_a_name_that_is_too_long_is_told_in_one_line(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words.format("a" * 300).split()) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert re.fullmatch(r"error: \S*a{300}\S*: File name too long", line)


@pytest.mark.parametrize("number", STOP_SIGNALS)
def test_ctrl_c_is_no_error_even_where_a_library_makes_one_of_it(
    number: signal.Signals, monkeypatch: pytest.MonkeyPatch
) -> None:
    def import_numpy() -> int:
        try:
            signal.raise_signal(number)
        except KeyboardInterrupt:
            raise ImportError("we have compiled some common reasons") from None
        return 0

    monkeypatch.setattr("acts_tools.cli.main", import_numpy)
    handlers = {number: signal.getsignal(number) for number in STOP_SIGNALS}
    try:
        assert run() == INTERRUPTED
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


@pytest.mark.parametrize("number", STOP_SIGNALS)
def test_ctrl_c_while_a_module_makes_code_of_text_ends_a_command_like_any_other(
    number: signal.Signals, tmp_path: Path
) -> None:
    """As a dataclass does while it is defined, so that it meets most who interrupt the start of a command."""
    (tmp_path / "scipy.py").write_text(f"exec('import signal; signal.raise_signal({int(number)})')\n")
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}
    command = [sys.executable, "-m", "acts_tools", "evaluate", "recovery", "--presses", "1"]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60.0, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (INTERRUPTED, "", "")


@pytest.mark.parametrize("number", STOP_SIGNALS)
def test_a_signal_leaves_nothing_that_is_half_made(number: signal.Signals, tmp_path: Path) -> None:
    # The reader never comes, so that the command is in the middle of its work for as long as the test takes.
    pipe = tmp_path / "frames.npz"
    os.mkfifo(pipe)
    code = (
        "import sys\nfrom pathlib import Path\nfrom unittest import mock\nfrom acts_core.errors import ActsError\n"
        "from acts_core.files import write_whole\nfrom acts_tools.__main__ import run\n"
        "def work(_):\n"
        "    with write_whole(Path('out'), error=ActsError) as file:\n"
        "        print('begun', flush=True)\n"
        f"        Path({str(pipe)!r}).read_bytes()\n"
        "sys.argv = ['acts', 'doctor']\nwith mock.patch('acts_tools.doctor.command.run', work):\n    sys.exit(run())\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], cwd=tmp_path, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"begun\n"
        try:
            # Python notices one that comes in the moment before it opens the pipe only when that is done.
            for _ in range(12):
                process.send_signal(number)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(5.0)
                    break
        finally:
            process.kill()
    assert process.returncode == INTERRUPTED
    assert list(tmp_path.iterdir()) == [pipe]


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_a_command_works_where_nobody_listens(closed: str, tmp_path: Path) -> None:
    command = f'"{sys.executable}" -m acts_tools'
    doctor = f"{command} doctor --json report.json {closed}"
    assert subprocess.run(["sh", "-c", doctor], cwd=tmp_path, check=False, capture_output=True).returncode in (0, 1)
    assert (tmp_path / "report.json").is_file()
    gait = f"{command} evaluate gait --seeds 1 --rate 8 {closed}"
    assert subprocess.run(["sh", "-c", gait], cwd=tmp_path, check=False, capture_output=True).returncode == 0


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
def test_what_a_command_opens_does_not_take_the_place_of_a_closed_stream(closed: str, tmp_path: Path) -> None:
    """A bag would get what libraries in C write to the error stream."""
    opened = (
        "import sys\nfrom acts_tools import __main__, cli\n"
        "cli.main = lambda: open('told.txt', 'w').write(str(open('told.txt').fileno()))\n__main__.run()\n"
    )
    subprocess.run(["sh", "-c", f'"{sys.executable}" -c "{opened}" {closed}'], cwd=tmp_path, check=True)
    assert int((tmp_path / "told.txt").read_text()) > 2


@pytest.mark.parametrize(
    ("encoding", "name", "written"),
    [("ascii:strict", "gr\u00fcn", b"gr\\xfcn"), ("utf-8:strict", "gr\udcfcn", b"gr\\udcfcn")],
    ids=["another locale", "name of another encoding"],
)
def test_a_name_that_the_output_has_no_characters_for_is_told(
    encoding: str, name: str, written: bytes, tmp_path: Path
) -> None:
    """The command goes on; its work would be lost."""
    words = [sys.executable, "-m", "acts_tools", "library", "--objects", "circle", "-o", name]
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    said = subprocess.run(words, cwd=tmp_path, env=environment, check=True, capture_output=True).stdout
    assert said.startswith(written + b": 1 object, 5 frames")
    assert (tmp_path / name).is_file()


def test_errors_are_one_line_on_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "--own", "/no/such.launch.xml"]) == 1
    assert capsys.readouterr().err == "error: the launch file '/no/such.launch.xml' does not exist\n"


def test_starting_a_launch_imports_neither_ros_nor_numerics() -> None:
    code = (
        "import sys\nfrom acts_tools.cli import main\nimport acts_tools.launch.evaluate, acts_ros.processes.launcher\n"
        "try:\n    main(['launch', '--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numba', 'matplotlib', 'scipy', 'rclpy', 'rosbags'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


@pytest.mark.parametrize("word", ["sim", "sim=true", ":=true", "sim:="])
def test_malformed_launch_arguments_are_refused(prefix: Prefix, capsys: pytest.CaptureFixture[str], word: str) -> None:
    path = prefix.launch("it.launch.xml", '<arg name="sim" default="true"/>')
    assert main(["launch", "--own", str(path), word]) == 1
    assert f"malformed launch argument '{word}', expected format '<name>:=<value>'" in capsys.readouterr().err


def test_of_duplicate_arguments_the_last_one_wins() -> None:
    assert command.parse_arguments(["a:=1", "b:=x:=y", "a:=2"]) == {"a": "2", "b": "x:=y"}


def test_a_package_without_the_file_says_which_files_it_has(prefix: Prefix, capsys: pytest.CaptureFixture[str]) -> None:
    prefix.launch("it.launch.xml", "")
    assert main(["launch", "--own", "fake", "other.launch.xml"]) == 1
    assert "(launch files there: it.launch.xml)" in capsys.readouterr().err
    assert main(["launch", "--own", "fake"]) == 1
    assert "(there: it.launch.xml)" in capsys.readouterr().err
    prefix.share("more/it.launch.xml", "")
    assert main(["launch", "--own", "fake", "it.launch.xml"]) == 1
    assert "was found more than once" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [("--own", "--print", "fake", "it.launch.xml", "a:=7"), ("fake", "it.launch.xml", "--own", "--print", "a:=7")],
    ids=["options first", "options in between"],
)
def test_printing_shows_the_commands_with_their_parameters(
    words: tuple[str, ...], prefix: Prefix, capsys: pytest.CaptureFixture[str]
) -> None:
    node = prefix.script("node", "#!/bin/sh\nexit 1\n")
    prefix.launch(
        "it.launch.xml",
        '<arg name="a" default="1"/><log message="a is $(var a)"/>'
        '<node pkg="fake" exec="node"><param name="p" value="$(var a)"/></node>',
    )
    assert main(["launch", *words]) == 0
    printed = capsys.readouterr()
    assert f"[node-1] {node} --ros-args --params-file /" in printed.out
    assert "        p: 7\n" in printed.out
    assert printed.err == "a is 7\n"


@pytest.mark.parametrize("options", [[], ["--print"]])
def test_an_argument_that_no_file_declares_starts_nothing(
    options: list[str], prefix: Prefix, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    prefix.script("node", f"#!/bin/sh\ntouch {tmp_path}/started\n")
    prefix.launch("it.launch.xml", '<arg name="trajectory" default="1"/><node pkg="fake" exec="node"/>')
    assert main(["launch", "--own", *options, "fake", "it.launch.xml", "trajectry:=N"]) == 1
    printed = capsys.readouterr()
    assert "no argument 'trajectry'; did you mean 'trajectory'? declared: trajectory" in printed.err
    assert printed.out == ""
    assert not (tmp_path / "started").exists()


def test_the_real_launch_takes_over_where_it_is_installed(prefix: Prefix, monkeypatch: pytest.MonkeyPatch) -> None:
    executed: list[list[str]] = []

    def execute(_file: str, words: list[str]) -> None:
        executed.append(words)
        raise SystemExit(0)

    monkeypatch.setattr(command, "real_launch_installed", lambda: True)
    monkeypatch.setattr(os, "execvp", execute)
    with pytest.raises(SystemExit):
        main(["launch", "acts_bringup", "tactile.launch.xml", "sim:=true"])
    with pytest.raises(SystemExit):
        main(["launch", "-s", "acts_bringup", "tactile.launch.xml"])
    assert executed == [
        ["ros2", "launch", "acts_bringup", "tactile.launch.xml", "sim:=true"],
        ["ros2", "launch", "--show-args", "acts_bringup", "tactile.launch.xml"],
    ]
    path = prefix.launch("it.launch.xml", "")
    assert main(["launch", "--own", str(path)]) == 0
    monkeypatch.setenv("ACTS_LAUNCH_OWN", "1")
    assert main(["launch", str(path)]) == 0
    assert len(executed) == 2
