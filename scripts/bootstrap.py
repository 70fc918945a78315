# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Set up this checkout on a bare machine: virtual environment, ROS 2 from wheels, colcon build.

Standard library only: it runs before anything is installed. Every step is skipped when its inputs have not changed
since it last succeeded, so calling it again costs a fraction of a second. `make setup` and `./acts` call it. The
variable ROS chooses the distribution; each has a virtual environment and a build of its own.
"""

from __future__ import annotations

import argparse
import fcntl
import hashlib
import importlib.util
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import sysconfig
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import IO

ROOT = Path(__file__).resolve().parent.parent
LOCKS = {"kilted": "requirements.lock", "jazzy": "requirements-jazzy.lock"}
DEFAULT_DISTRIBUTION = "kilted"
DISTRIBUTION = os.environ.get("ROS") or DEFAULT_DISTRIBUTION
STATE = ROOT / ".acts" if DISTRIBUTION == DEFAULT_DISTRIBUTION else ROOT / ".acts" / DISTRIBUTION
VENV = STATE / "venv"
BUILD = STATE / "build"
INSTALL = STATE / "install"
LOCK = ROOT / LOCKS.get(DISTRIBUTION, LOCKS[DEFAULT_DISTRIBUTION])
PYTHON_RECORD = VENV / "acts.python"

PLAIN = re.compile(r"[\w/.+@~-]")
MINIMUM_PYTHON = (3, 10)
# Name of this interpreter's program, and of its folders.
PYTHON = f"python{sys.version_info.major}.{sys.version_info.minor}"
NEWER_THAN_UR_RTDE = (3, 13)
# Raise it when `create_venv` changes, so that existing checkouts make theirs anew.
VENV_RECIPE = "1"
NETWORK_HINT = (
    "The wheels come from the network: if that is away, call the same again when it is back; "
    "behind a mirror or a proxy set PIP_INDEX_URL or HTTPS_PROXY."
)
# Each comes with a package of its name.
TOOLS = ("g++", "cmake", "make")
# A change to one of these, or of this file, asks for a colcon build; Python modules are linked into the installation.
BUILD_INPUTS = (
    *("setup.py", "setup.cfg", "CMakeLists.txt"),
    *(f"*.{kind}" for kind in ("msg", "srv", "cpp", "hpp", "h", "xml", "yaml", "json", "rviz", "npz")),
)


class SetupError(Exception):
    """The machine lacks something; the message names the command that installs it."""


def say(text: str) -> None:
    # What the command after it prints may be read by a program, as `./acts diagnostics --json` is.
    print(f"[setup] {text}", file=sys.stderr, flush=True)


def check_place(root: Path) -> None:
    """Refuse a checkout whose path what is built cannot carry, before anything is downloaded."""
    wrong = sorted({character for character in str(root) if PLAIN.fullmatch(character) is None})
    if wrong:
        raise SetupError(
            f"the path of this checkout holds {', '.join(map(ascii, wrong))}: {root}. What is built cannot carry that. "
            "Move the checkout to a path of letters, digits and / . _ - + @ ~ only, such as ~/acts."
        )


def check_distribution() -> None:
    """Refuse a distribution of which there are no wheels."""
    if DISTRIBUTION not in LOCKS:
        raise SetupError(
            f"ROS={DISTRIBUTION}: {' or '.join(LOCKS)} can be set up here; unset, it is {DEFAULT_DISTRIBUTION}"
        )


def check_machine() -> None:
    """Refuse a machine on which a later step would fail, naming everything that is missing at once."""
    if sys.version_info < MINIMUM_PYTHON:
        raise SetupError(
            f"Python {sys.version.split()[0]} is too old: ACTS needs 3.10 or newer. "
            "Install one and call, once, `make setup PYTHON=/path/to/python3`."
        )
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    packages = list(missing)
    if importlib.util.find_spec("ensurepip") is None or importlib.util.find_spec("venv") is None:
        missing.append("the Python module venv")
        packages.append("python3-venv")
    if not (Path(sysconfig.get_paths()["include"]) / "Python.h").is_file():
        missing.append("Python.h")
        packages.append("python3-dev")
    if missing:
        raise SetupError(f"missing: {', '.join(missing)}. Install with: sudo apt-get install {' '.join(packages)}")


def digest(paths: Iterable[Path], *words: str) -> str:
    """Hash of the names and contents of `paths` and of `words`."""
    total = hashlib.sha256("\0".join(words).encode())
    for path in sorted(paths):
        total.update(str(path).encode() + b"\0" + path.read_bytes())
    return total.hexdigest()


def up_to_date(stamp: Path, value: str) -> bool:
    return stamp.is_file() and stamp.read_text() == value


def run(command: list[str], log_name: str, env: dict[str, str] | None = None) -> None:
    """Run a command with its output in `log/<log_name>` of the state's folder, shown only when it fails."""
    log_path = STATE / "log" / log_name
    log_path.parent.mkdir(parents=True, exist_ok=True)
    with log_path.open("wb") as log:
        code = subprocess.run(command, cwd=ROOT, env=env, stdout=log, stderr=log, close_fds=False).returncode
    if code != 0:
        print("\n".join(log_path.read_text(errors="replace").splitlines()[-40:]), file=sys.stderr)
        failed = f"`{shlex.join(command[:4])} ...` ended with code {code}; its output is in {log_path}"
        free_mb, hint = shutil.disk_usage(STATE).free / 1e6, "If an earlier set-up was killed, run `make clean` first"
        if free_mb < 50:  # The log may be empty then, too.
            hint = f"{free_mb:.0f} MB are free on its disk: make room, the whole needs 1 GB"
        raise SetupError(f"{failed}. {hint}")


def base_python() -> str:
    """This interpreter; inside a virtual environment, ours perhaps, the one that made that."""
    python = Path(sys.base_prefix) / "bin" / PYTHON
    return str(python) if python.is_file() else sys.executable


def hand_over_to_recorded_python() -> None:
    """Go on in the interpreter the environment was made with, whichever `python3` is first on PATH today."""
    recorded = ""
    # There is none yet, or it may not be read in a checkout of another user, which `open_lock` tells.
    with suppress(OSError):
        recorded = PYTHON_RECORD.read_text()
    if recorded and recorded != base_python() and os.access(recorded, os.X_OK):
        os.execv(recorded, [recorded, __file__, *sys.argv[1:]])


def running_from(folder: Path) -> list[str]:
    """Ids of the processes that have a file of a folder in memory."""
    found = []
    for maps in Path("/proc").glob("[0-9]*/maps"):
        # Of another user, or it has just ended.
        with suppress(OSError):
            if f"{folder}/".encode() in maps.read_bytes():
                found.append(maps.parent.name)
    return found


def create_venv() -> None:
    """Install the locked wheels into a fresh virtual environment and make it a ROS prefix."""
    python = base_python()
    # Not the whole version: an update of the same Python, as by the system at night, changes nothing for the wheels,
    # and a robot without network could not install them again.
    wanted = digest([LOCK], VENV_RECIPE, str(sysconfig.get_config_var("SOABI")), python, str(ROOT))
    stamp = VENV / "acts.stamp"
    if up_to_date(stamp, wanted):
        return
    if stamp.is_file() and (ids := running_from(VENV)):
        # It would go on without its files, and not come again after a crash; and this command may be the one that is to
        # stop a robot.
        used = f"what runs from here (ps {' '.join(ids)}) needs the wheels as they are"
        if PYTHON_RECORD.read_text() != python:
            raise SetupError(f"{used}, and they are not for {python}: end that first")
        say(f"not brought up to date: {used}; end that, and the next command installs the new ones")
        return
    # Gone while the work is under way: an interrupted one must not pass for whole when its inputs change back.
    stamp.unlink(missing_ok=True)
    say(f"virtual environment with Python {sys.version.split()[0]} in {os.path.relpath(VENV, ROOT)}")
    if sys.version_info >= NEWER_THAN_UR_RTDE:
        say("ur_rtde has no wheel for this Python: all but the UR5e will work, and that with Python 3.12 or older")
    # What was built, too: CMake remembers the interpreter and the place of the checkout.
    for folder in (VENV, BUILD, INSTALL):
        shutil.rmtree(folder, ignore_errors=True)
    run([python, "-m", "venv", str(VENV)], "venv.log")
    count = sum(1 for line in LOCK.read_text().splitlines() if line and not line.startswith("#"))
    say(f"installing about {count} wheels, ROS 2 {DISTRIBUTION.capitalize()} among them (one to three minutes, 1 GB)")
    started = time.monotonic()
    pip = [str(VENV / "bin/python"), "-m", "pip", "install", "--prefer-binary", "--no-input", "--progress-bar=off"]
    try:
        run([*pip, "-r", str(LOCK)], "pip.log", env=pip_environment())
    except SetupError as error:
        raise SetupError(f"{error}. {NETWORK_HINT}") from None
    say(f"wheels installed in {time.monotonic() - started:.0f} s")
    relocate_cmake_exports()
    read_paths_as_utf8()
    PYTHON_RECORD.write_text(python)
    stamp.write_text(wanted)


def pip_environment() -> dict[str, str]:
    """The variables that pip gets: those of the user, but for what would keep a wheel out of our environment."""
    # What is on PYTHONPATH counts as installed for pip, but our programs have a path of their own.
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    # A `user = true` in the user's pip.conf is refused in a virtual environment.
    return {**kept, "PIP_USER": "0", "PYTHONDONTWRITEBYTECODE": ""}


def site_packages() -> Path:
    return VENV / "lib" / PYTHON / "site-packages"


def relocate_cmake_exports() -> None:
    """Replace the build machine's Python paths in the wheels' exported CMake files by this interpreter's.

    The wheels were built against `/opt/python/cpXY-cpXY`; without this, interface packages cannot be built on them.
    """
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    built_with = f"/opt/python/{tag}-{tag}"
    replacements = {
        f"{built_with}/include/{PYTHON}": sysconfig.get_paths()["include"],
        f"{built_with}/lib/{PYTHON}/site-packages": str(site_packages()),
    }
    for path in (VENV / "share").rglob("*.cmake"):
        text = path.read_text(encoding="utf-8")
        changed = text
        for old, new in replacements.items():
            changed = changed.replace(old, new)
        if changed != text:
            path.write_text(changed, encoding="utf-8")


def read_paths_as_utf8() -> None:
    """Let the build of interfaces read paths with letters beyond ASCII, where CMake would end a line otherwise."""
    path = VENV / "share/rosidl_adapter/cmake/rosidl_adapt_interfaces.cmake"
    text = path.read_text(encoding="utf-8")
    old = 'file(STRINGS "${idl_output}" idl_tuples)'
    path.write_text(text.replace(old, f"{old[:-1]} ENCODING UTF-8)"), encoding="utf-8")


def environment() -> dict[str, str]:
    """The variables that make the venv and the installed workspace one ROS environment, overlay first."""
    # Python packages are linked (--symlink-install): the modules are found through their build folders.
    linked = [str(BUILD / package.name) for package in packages() if (package / "setup.py").is_file()]
    vendored = sorted(str(folder) for folder in site_packages().glob("ros_*.libs"))
    return {
        "VIRTUAL_ENV": str(VENV),
        "AMENT_PREFIX_PATH": f"{INSTALL}:{VENV}",
        "CMAKE_PREFIX_PATH": f"{INSTALL}:{VENV}",
        "LD_LIBRARY_PATH": ":".join([f"{INSTALL}/lib", f"{VENV}/lib", *vendored]),
        "PYTHONPATH": ":".join([f"{INSTALL}/lib/{PYTHON}/site-packages", *linked]),
        "PATH": f"{INSTALL}/bin:{VENV}/bin",
        # The wheels' start-up hook would re-execute Python and order LD_LIBRARY_PATH at random.
        "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
        # Also where it is forbidden elsewhere: without it, each start of a node compiles a hundred modules of ours.
        "PYTHONDONTWRITEBYTECODE": "",
        "ROS_DISTRO": DISTRIBUTION,
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
    }


def write_environment() -> None:
    lines = ["# Written by scripts/bootstrap.py; source it to enter the ACTS environment."]
    for name, value in environment().items():
        lines.append(f"export {name}={shlex.quote(value)}" + (':"$PATH"' if name == "PATH" else ""))
    # What the user has set stays: these are defaults only.
    lines.append('export ROS_AUTOMATIC_DISCOVERY_RANGE="${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}"')
    lines.append(f'export ROS_LOG_DIR="${{ROS_LOG_DIR:-{STATE}/log/ros}}"')
    text, path = "\n".join(lines) + "\n", STATE / "env.sh"
    # Only where it has changed: on a full disk nothing could be written, and no command would run any more.
    if up_to_date(path, text):
        return
    # In one step: another command may be reading it.
    fresh = path.with_name("env.sh.new")
    fresh.write_text(text)
    fresh.replace(path)


def packages() -> list[Path]:
    return sorted(path.parent for path in ROOT.glob("*/package.xml"))


def sources(*patterns: str) -> list[Path]:
    """Files of the packages that match, but for what Python or pip has left there."""
    found = ((package, path) for package in packages() for pattern in patterns for path in package.rglob(pattern))
    return [path for package, path in found if not {"__pycache__", "build"} & set(path.relative_to(package).parts)]


def build_workspace() -> None:
    """`colcon build` of every package, merged into one installation; Python modules are linked, not copied."""
    # New and removed modules and executables count as well as changed build files.
    modules = " ".join(str(path.relative_to(ROOT)) for path in sorted(sources("*.py")))
    wanted = digest([*sources(*BUILD_INPUTS), Path(__file__).resolve()], modules, (VENV / "acts.stamp").read_text())
    stamp = STATE / "build.stamp"
    if up_to_date(stamp, wanted):
        return
    stamp.unlink(missing_ok=True)
    say(f"colcon build of {len(packages())} packages (half a minute)")
    started = time.monotonic()
    # Not as the user's own workspaces: ~/.colcon/defaults.yaml may choose packages, or where they go.
    env = {**os.environ, **environment(), "COLCON_DEFAULTS_FILE": os.devnull}
    env["PATH"] = f"{environment()['PATH']}:{os.environ['PATH']}"
    colcon = [f"{VENV}/bin/colcon", "--log-base", f"{STATE}/log/colcon", "build"]
    places = ["--base-paths", *map(str, packages()), "--build-base", f"{BUILD}", "--install-base", f"{INSTALL}"]
    cmake = ["--cmake-args", "-DCMAKE_BUILD_TYPE=Release", f"-DPython3_EXECUTABLE={VENV}/bin/python"]
    run([*colcon, *places, "--merge-install", "--symlink-install", *cmake], "build.log", env=env)
    write_first_lines()
    say(f"built in {time.monotonic() - started:.0f} s")
    stamp.write_text(wanted)


def write_first_lines() -> None:
    """Let the nodes' scripts take Python from PATH: their first line cannot hold a path that is long or has a space.

    Where `env` can do that, they start with the stop signals blocked, and `acts_core.stop_signals` (of `acts` its
    `__main__`) unblocks them. So an early signal waits, and does not end Python with a traceback.
    """
    block = "--block-signal=INT,TERM,HUP"
    is_able = subprocess.run(["/usr/bin/env", block, "true"], capture_output=True, check=False).returncode == 0
    for script in INSTALL.glob("lib/*/*"):
        if script.is_dir() or script.is_symlink():
            continue
        first, _, rest = script.read_bytes().partition(b"\n")
        if first.startswith(b"#!") and bytes(VENV) in first:
            line = f"#!/usr/bin/env -S {block} python3" if is_able else "#!/usr/bin/env python3"
            script.write_bytes(line.encode() + b"\n" + rest)


def open_lock() -> IO[str]:
    """Open the file that set-ups of this checkout lock, in the folder they write to."""
    try:
        STATE.mkdir(parents=True, exist_ok=True)
        return (STATE / "lock").open("w")
    except OSError as error:
        owner, own = ROOT.stat().st_uid, os.getuid()
        advice = "free the disk, or make the folder writable"
        if owner != own:
            advice = f"it belongs to user {owner}, you are user {own}: make a checkout of your own (git clone {ROOT})"
        raise SetupError(
            f"{STATE} cannot be written ({error.strerror}), and every command keeps it up to date; {advice}"
        ) from None


def acquire(lock: IO[str]) -> None:
    """Take the lock; say so where that takes longer than another command's look at what is up to date."""
    # A step holds it, too: where this process alone is killed, what it has started goes on for minutes.
    os.set_inheritable(lock.fileno(), True)
    deadline_s = time.monotonic() + 2.0
    while time.monotonic() < deadline_s:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            time.sleep(0.02)
    say("waiting for another set-up of this checkout to end")
    fcntl.flock(lock, fcntl.LOCK_EX)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quiet", action="store_true", help="say nothing when there is nothing to do")
    parser.add_argument("--this-python", action="store_true", help="use this interpreter, whatever was used before")
    arguments = parser.parse_args()
    if not arguments.this_python:
        hand_over_to_recorded_python()
    try:
        # scripts/enter.sh has kept Ctrl-C back until now.
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        check_distribution()
        check_place(ROOT)
        check_machine()
        # Two commands at once must not build into one another.
        with open_lock() as lock:
            acquire(lock)
            create_venv()
            write_environment()
            build_workspace()
    except SetupError as error:
        print(f"[setup] {error}", file=sys.stderr)
        return 1
    except OSError as error:
        where = error.filename or STATE
        print(f"[setup] {where}: {error.strerror}; the same command then does what is not finished", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("[setup] interrupted; the same command does again what is not finished", file=sys.stderr)
        return 130
    if not arguments.quiet:
        say("ready: ./acts --help")
    # Ctrl-C while Python ends would be an exception that nobody catches, exit code 0, and the shell would go on.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return 0


if __name__ == "__main__":
    sys.exit(main())
