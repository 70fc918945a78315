# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A checkout where set-up cannot work is told so before anything is downloaded."""

from __future__ import annotations

import errno
import fcntl
import importlib.util
import mmap
import os
import select
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
from waiting import wait_for

BOOTSTRAP = Path(__file__).resolve().parent.parent.parent / "scripts" / "bootstrap.py"


def tried(checkout: Path) -> subprocess.CompletedProcess[str]:
    """Run a copy of the set-up in a checkout of which there is nothing else."""
    (checkout / "scripts").mkdir(parents=True, exist_ok=True)
    script = shutil.copy(BOOTSTRAP, checkout / "scripts")
    return subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=30)


def test_what_the_set_up_says_is_no_output_of_the_command_after_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Such as that of `./acts diagnostics --json | jq`."""
    monkeypatch.delenv("ROS", raising=False)  # each distribution has its own folder
    (tmp_path / "scripts").mkdir()
    (tmp_path / ".acts").mkdir()
    command = [sys.executable, shutil.copy(BOOTSTRAP, tmp_path / "scripts")]
    with (tmp_path / ".acts" / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            assert process.stderr is not None
            said, _, _ = select.select([process.stdout, process.stderr], [], [], 30)
            fcntl.flock(lock, fcntl.LOCK_UN)
            output, errors = process.communicate(timeout=30)
    assert said == [process.stderr]
    assert output == ""
    assert errors.startswith("[setup] waiting for another set-up of this checkout to end")


@pytest.mark.parametrize("name", ["my robots", "it's", "a:b", "a;b", "$HOME", 'a"b', "new\nline"])
def test_a_path_that_the_build_cannot_carry_is_refused_first(tmp_path: Path, name: str) -> None:
    done = tried(tmp_path / name)
    assert done.returncode == 1
    assert done.stderr.startswith("[setup] the path of this checkout holds ")
    assert "Move the checkout" in done.stderr
    assert not (tmp_path / name / ".acts").exists()


@pytest.mark.parametrize("name", ["ros_ws-2/src/acts.git+1@x~", "Prüfstand", "触覚"])
def test_letters_of_any_language_are_not(tmp_path: Path, name: str) -> None:
    # It goes on, to find no list of wheels.
    assert "the path of this checkout" not in tried(tmp_path / name).stderr


def test_a_distribution_without_wheels_is_refused_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS", "humble")
    done = tried(tmp_path / "checkout")
    assert done.returncode == 1
    assert "ROS=humble: kilted or jazzy can be set up here" in done.stderr
    assert not (tmp_path / "checkout" / ".acts").exists()


@pytest.mark.parametrize("is_anothers", [False, True])
def test_a_checkout_that_cannot_be_written_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_anothers: bool
) -> None:
    monkeypatch.delenv("ROS", raising=False)  # each distribution has its own folder
    # As a read-only one, also for root.
    (tmp_path / ".acts" / "lock").mkdir(parents=True)
    if is_anothers:
        if os.getuid():
            pytest.skip("only root can give a folder to another user: sudo ./acts run pytest test/strangers")
        os.chown(tmp_path, 12345, -1)
    done = tried(tmp_path)
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert f"[setup] {tmp_path / '.acts'} cannot be written (Is a directory)" in done.stderr
    advice = f"make a checkout of your own (git clone {tmp_path})" if is_anothers else "make the folder writable"
    assert advice in done.stderr


def test_a_checkout_whose_folder_may_not_be_entered_is_not_told_by_a_traceback(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Refused by the system for root, too.
    monkeypatch.setattr(bootstrap, "PYTHON_RECORD", tmp_path / (300 * "n"))
    bootstrap.hand_over_to_recorded_python()


def test_run_without_a_program_says_what_it_is_for() -> None:
    done = subprocess.run([str(BOOTSTRAP.parents[1] / "acts"), "run"], capture_output=True, text=True, timeout=30)
    assert done.returncode == 2
    assert done.stderr.startswith("usage: ./acts run PROGRAM [ARGUMENT ...], any program inside the environment")


@pytest.mark.skipif(shutil.which("ros2") is not None, reason="with ROS sourced the environment is the user's own")
def test_a_shell_in_the_environment_has_its_python_whatever_bashrc_puts_first(tmp_path: Path) -> None:
    """As `eval "$(pyenv init -)"` in ~/.bashrc does."""
    (tmp_path / "python3").write_text("#!/bin/sh\necho of another\n")
    (tmp_path / "python3").chmod(0o755)
    (tmp_path / ".bashrc").write_text(f'export PATH={tmp_path}:"$PATH"\nalias=of_mine\n')
    master, slave = os.openpty()
    command = [str(BOOTSTRAP.parents[1] / "acts"), "run", "bash"]
    environment = {**os.environ, "HOME": str(tmp_path)}
    with subprocess.Popen(command, stdin=slave, stdout=subprocess.PIPE, stderr=slave, env=environment) as shell:
        os.close(slave)
        os.write(master, b"python3 -c 'import acts_core, numba; print(\"of acts\")'; echo $alias; exit\n")
        try:
            said, _ = shell.communicate(timeout=60)
        finally:
            shell.kill()
            os.close(master)
    assert said.decode().splitlines() == ["of acts", "of_mine"]


@pytest.fixture
def bootstrap() -> ModuleType:
    """The set-up's functions."""
    specification = importlib.util.spec_from_file_location("bootstrap", BOOTSTRAP)
    assert specification is not None
    assert specification.loader is not None
    bootstrap = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(bootstrap)
    return bootstrap


def test_the_build_reads_paths_as_utf_8(bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bootstrap, "VENV", tmp_path)
    path = tmp_path / "share/rosidl_adapter/cmake/rosidl_adapt_interfaces.cmake"
    path.parent.mkdir(parents=True)
    path.write_text('  file(STRINGS "${idl_output}" idl_tuples)\n')
    bootstrap.read_paths_as_utf8()
    # Otherwise CMake ends a line at such a letter.
    assert path.read_text() == '  file(STRINGS "${idl_output}" idl_tuples ENCODING UTF-8)\n'


@pytest.mark.parametrize("package", ["config", "launch"])
def test_a_change_of_any_file_that_is_installed_asks_for_a_build(bootstrap: ModuleType, package: str) -> None:
    folder = BOOTSTRAP.parents[1] / package
    listed = subprocess.run(["git", "ls-files"], cwd=folder, capture_output=True, text=True)
    if listed.returncode != 0:
        pytest.skip("no checkout of git, which would tell files of the project from others")
    # Its history is not installed.
    names = set(listed.stdout.split()) - {"CHANGELOG.rst"}
    assert len(names) > 5
    assert [name for name in names if not any(map(Path(name).match, bootstrap.BUILD_INPUTS))] == []


def test_a_change_of_the_set_up_itself_asks_for_a_build(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "scripts" / "bootstrap.py"
    script.parent.mkdir()
    script.write_text("one")
    (tmp_path / "acts.stamp").touch()
    built = []
    for name, value in {"__file__": str(script), "ROOT": tmp_path, "STATE": tmp_path, "VENV": tmp_path}.items():
        monkeypatch.setattr(bootstrap, name, value)
    monkeypatch.setattr(bootstrap, "run", lambda *_, **__: built.append(script.read_text()))
    monkeypatch.setattr(bootstrap, "write_first_lines", lambda: None)
    for text in ("one", "one", "two"):
        script.write_text(text)
        bootstrap.build_workspace()
    assert built == ["one", "two"]


def test_what_pip_leaves_in_a_package_asks_for_no_build(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "acts_core"
    (package / "build" / "lib").mkdir(parents=True)
    (package / "package.xml").touch()
    (tmp_path / "acts.stamp").touch()
    built: list[int] = []
    for name in ("ROOT", "STATE", "VENV"):
        monkeypatch.setattr(bootstrap, name, tmp_path)
    monkeypatch.setattr(bootstrap, "run", lambda *_, **__: built.append(len(built)))
    monkeypatch.setattr(bootstrap, "write_first_lines", lambda: None)
    for new in ("setup.py", "build/lib/setup.py", "build/lib/module.py", "build.py"):
        (package / new).touch()
        bootstrap.build_workspace()
    assert len(built) == 2


def test_the_build_is_not_that_of_the_users_own_workspaces(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "acts.stamp").touch()
    (tmp_path / "defaults.yaml").write_text("build: {packages-select: [mine]}\n")
    monkeypatch.setenv("COLCON_HOME", str(tmp_path))
    given: list[dict[str, str]] = []
    for name in ("ROOT", "STATE", "VENV"):
        monkeypatch.setattr(bootstrap, name, tmp_path)
    monkeypatch.setattr(bootstrap, "run", lambda *_, env: given.append(env))
    monkeypatch.setattr(bootstrap, "write_first_lines", lambda: None)
    bootstrap.build_workspace()
    # What colcon would read in place of that in its home.
    assert not Path(given[0]["COLCON_DEFAULTS_FILE"]).is_file()


@pytest.fixture
def made(bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A virtual environment that is up to date."""
    (tmp_path / "venv").mkdir()
    (tmp_path / "requirements.lock").touch()
    monkeypatch.setattr(bootstrap, "LOCK", tmp_path / "requirements.lock")
    monkeypatch.setattr(bootstrap, "PYTHON_RECORD", tmp_path / "venv" / "acts.python")
    for name in ("VENV", "BUILD", "INSTALL"):
        monkeypatch.setattr(bootstrap, name, tmp_path / name.lower())
    with monkeypatch.context() as here:
        for name in ("run", "relocate_cmake_exports", "read_paths_as_utf8"):
            here.setattr(bootstrap, name, lambda *_, **__: (tmp_path / "venv").mkdir(exist_ok=True))
        bootstrap.create_venv()
    (tmp_path / "venv" / "library").write_bytes(b"0" * 4096)
    return tmp_path


def test_an_update_of_the_same_python_does_not_remove_the_environment(
    bootstrap: ModuleType, made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A robot without network could not make it again."""
    numbers = ".".join(map(str, sys.version_info[:2]))
    monkeypatch.setattr(sys, "version", f"{numbers}.99 (main, built last night) [GCC 99.0]")
    bootstrap.create_venv()
    assert (made / "venv" / "library").exists()


@pytest.mark.parametrize("is_another", [False, True])
def test_an_environment_is_not_made_anew_under_what_runs_from_it(
    bootstrap: ModuleType,
    made: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    is_another: bool,
) -> None:
    """As by `./acts echo` beside a robot that moves, after `git pull`."""
    library = made / "venv" / "library"
    bootstrap.LOCK.write_text("another==1.0\n")
    if is_another:
        bootstrap.PYTHON_RECORD.write_text("/of/another/python3")
    with library.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ):
        if is_another:
            with pytest.raises(bootstrap.SetupError, match=rf"\(ps {os.getpid()}\) needs .* end that first"):
                bootstrap.create_venv()
        else:
            bootstrap.create_venv()
            assert f"not brought up to date: what runs from here (ps {os.getpid()}) " in capsys.readouterr().err
        assert library.exists()
    removed: list[bool] = []
    for name in ("run", "relocate_cmake_exports", "read_paths_as_utf8"):
        monkeypatch.setattr(bootstrap, name, lambda *_, **__: removed.append(not library.exists()))
    (made / "requirements.lock").write_text("another==2.0\n")
    with pytest.raises(FileNotFoundError):  # the new one, which nothing has made here
        bootstrap.create_venv()
    assert removed
    assert all(removed)


def test_without_network_the_last_line_speaks_of_it(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def run(command: list[str], *_: object, **__: object) -> None:
        if "pip" in command:
            raise bootstrap.SetupError("`pip ...` ended with code 1")

    monkeypatch.setattr(bootstrap, "run", run)
    for name in ("VENV", "BUILD", "INSTALL"):
        monkeypatch.setattr(bootstrap, name, tmp_path / name)
    with pytest.raises(bootstrap.SetupError, match=r"ended with code 1\. The wheels come from the network"):
        bootstrap.create_venv()


def test_a_full_disk_is_told_in_one_line(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full() -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(sys, "argv", ["bootstrap.py", "--this-python"])
    monkeypatch.setattr(bootstrap, "STATE", tmp_path)
    monkeypatch.setattr(bootstrap, "check_machine", lambda: None)
    monkeypatch.setattr(bootstrap, "create_venv", full)
    assert bootstrap.main() == 1
    assert capsys.readouterr().err.startswith(f"[setup] {tmp_path}: No space left on device; the same command then ")


def test_a_step_that_fails_names_its_log_and_what_helps(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bootstrap, "STATE", tmp_path)
    with pytest.raises(bootstrap.SetupError, match=r"code 1; .*build\.log\. If an .* killed, run `make clean` first"):
        bootstrap.run(["false"], "build.log")


def test_a_step_that_fails_on_a_full_disk_says_so_though_its_log_is_empty(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bootstrap, "STATE", tmp_path)
    monkeypatch.setattr(bootstrap.shutil, "disk_usage", lambda _: SimpleNamespace(free=3_000_000))
    with pytest.raises(bootstrap.SetupError, match=r"code 1; .*\. 3 MB are free on its disk: make room, .* 1 GB$"):
        bootstrap.run(["false"], "pip.log")


def test_a_step_that_outlives_its_set_up_keeps_the_next_one_waiting(tmp_path: Path) -> None:
    """As where the set-up alone is killed: its pip or colcon goes on, and the next would write into the same."""
    lines = (
        f"import sys; from pathlib import Path; sys.path.insert(0, {str(BOOTSTRAP.parent)!r}); import bootstrap",
        f"bootstrap.STATE = Path({str(tmp_path)!r}); lock = bootstrap.open_lock(); bootstrap.acquire(lock)",
        "bootstrap.run(['sh', '-c', 'echo begun; read end'], 'step.log')",
    )
    log = tmp_path / "log/step.log"
    set_up = subprocess.Popen([sys.executable, "-c", "\n".join(lines)], stdin=subprocess.PIPE)
    try:
        wait_for(lambda: log.is_file() and log.read_text() == "begun\n", "the step")
        set_up.kill()
        set_up.wait()
        with (tmp_path / "lock").open("w") as lock, pytest.raises(BlockingIOError):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    finally:
        set_up.kill()
        # The step ends with its input.
        set_up.communicate()
    with (tmp_path / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)


def test_what_is_up_to_date_is_not_written_again(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on a full disk, where every other command would fail."""
    for name in ("STATE", "VENV", "BUILD", "INSTALL"):
        monkeypatch.setattr(bootstrap, name, tmp_path)
    bootstrap.write_environment()
    (tmp_path / "env.sh.new").mkdir()
    bootstrap.write_environment()
    monkeypatch.setattr(bootstrap, "DISTRIBUTION", "another")
    with pytest.raises(IsADirectoryError):
        bootstrap.write_environment()


def test_wheels_are_installed_whatever_the_user_has_on_his_path(
    bootstrap: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither found on PYTHONPATH and so left out, nor refused for a `user = true` in pip.conf."""
    name = "of_a_user"
    own, wheels = tmp_path / "own", tmp_path / "wheels"
    for folder in (own, wheels / name):
        (folder / f"{name}-1.0.dist-info").mkdir(parents=True)
        (folder / f"{name}-1.0.dist-info" / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n"
        )
        (folder / f"{name}.py").touch()
    info = wheels / name / f"{name}-1.0.dist-info"
    (info / "WHEEL").write_text("Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
    (info / "RECORD").touch()
    archive = shutil.make_archive(str(wheels / "archive"), "zip", wheels / name)
    Path(archive).rename(wheels / f"{name}-1.0-py3-none-any.whl")
    lock = tmp_path / "requirements.lock"
    lock.write_text(f"{name}==1.0\n")
    for variable, value in {
        "PYTHONPATH": str(own),
        "PIP_USER": "1",
        "PIP_NO_INDEX": "1",
        "PIP_FIND_LINKS": str(wheels),
    }.items():
        monkeypatch.setenv(variable, value)
    monkeypatch.setattr(bootstrap, "LOCK", lock)
    monkeypatch.setattr(bootstrap, "STATE", tmp_path)
    for part in ("VENV", "BUILD", "INSTALL"):
        monkeypatch.setattr(bootstrap, part, tmp_path / part.lower())
    monkeypatch.setattr(bootstrap, "PYTHON_RECORD", tmp_path / "python")
    monkeypatch.setattr(bootstrap, "read_paths_as_utf8", lambda: None)
    bootstrap.create_venv()
    assert (bootstrap.site_packages() / f"{name}.py").is_file()
