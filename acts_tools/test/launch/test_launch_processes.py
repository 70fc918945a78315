# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts launch` as a process: starting, output, respawn, deaths, and stopping without leaving anything behind.

ROS_DOMAIN_ID 80.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import psutil
import pytest
from fake_prefix import Prefix
from waiting import wait_for

from acts_tools.testing.launch_runner import ProcessLaunch, launched

pytestmark = pytest.mark.slow

# Says when it is ready, and ends by itself neither before nor without a signal.
PATIENT = """
import signal, sys, time
signal.signal(signal.SIGINT, lambda *_: sys.exit(0))
signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
print("ready", *sys.argv[1:], flush=True)
while True:
    time.sleep(60)
"""
# Ignores being asked.
STUBBORN = """
import signal, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print("ready", flush=True)
while True:
    time.sleep(60)
"""


def launch(prefix: Prefix, body: str, **arguments: Any) -> AbstractContextManager[ProcessLaunch]:
    prefix.launch("it.launch.xml", body)
    return launched("fake", "it.launch.xml", domain_id=80, **arguments)


def pids(run: ProcessLaunch) -> list[int]:
    return [int(number) for number in re.findall(r"process started with pid \[(\d+)\]", run.output)]


def all_gone(numbers: list[int]) -> bool:
    return not any(is_alive(number) for number in numbers)


def is_alive(number: int) -> bool:
    try:
        return psutil.Process(number).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def test_ctrl_c_ends_all_nodes_once_each_and_the_exit_code_is_zero(prefix: Prefix) -> None:
    prefix.python("patient", PATIENT)
    node = '<node pkg="fake" exec="patient" output="screen" args="{}"/>'
    with launch(prefix, node.format("one") + node.format("two")) as run:
        run.wait_for_output("[patient-1] ready one --ros-args")
        run.wait_for_output("[patient-2] ready two --ros-args")
        numbers = pids(run)
        assert run.stop() == 0
        assert all_gone(numbers)
        assert run.output.count("sending signal 'SIGINT'") == 2
        assert "SIGTERM" not in run.output
        assert run.output.count("process has finished cleanly") == 2


def test_sigterm_to_the_launcher_stops_the_nodes_as_well(prefix: Prefix) -> None:
    prefix.python("patient", PATIENT)
    with launch(prefix, '<node pkg="fake" exec="patient" output="screen"/>') as run:
        run.wait_for_output("ready")
        numbers = pids(run)
        run.process.terminate()
        assert run.wait() == 0
        assert all_gone(numbers)


def test_a_node_that_dies_is_named_the_others_go_on_and_the_exit_code_tells(prefix: Prefix) -> None:
    prefix.python("patient", PATIENT)
    prefix.script("mortal", "#!/bin/sh\necho last words >&2\nexit 3\n")
    body = '<node pkg="fake" exec="patient" output="screen"/><node pkg="fake" exec="mortal"/>'
    with launch(prefix, body) as run:
        run.wait_for_output("process has died [pid")
        run.wait_for_output("ready")
        assert "[mortal-2] last words" in run.output  # errors reach the screen also with output="log"
        assert run.running
        assert run.stop() == 1
        assert "mortal-2 died: exit code 3" in run.output
        assert "patient-1 died" not in run.output


def test_a_node_killed_by_a_signal_is_named_with_it(prefix: Prefix) -> None:
    prefix.script("crasher", "#!/bin/sh\nkill -SEGV $$\n")
    with launch(prefix, '<node pkg="fake" exec="crasher"/>') as run:
        assert run.wait() == 1
        assert "crasher-1 died: exit code -11 (SIGSEGV)" in run.output


def test_all_nodes_ending_by_themselves_ends_the_launch(prefix: Prefix) -> None:
    prefix.script("short", "#!/bin/sh\nprintf 'no newline at the end'\n")
    with launch(prefix, '<node pkg="fake" exec="short" output="screen"/>') as run:
        assert run.wait() == 0
        assert "[short-1] no newline at the end\n" in run.output


def test_a_node_that_fails_while_it_is_stopped_is_a_failure(prefix: Prefix) -> None:
    prefix.python("patient", PATIENT.replace("sys.exit(0)", "sys.exit(5)"))
    with launch(prefix, '<node pkg="fake" exec="patient" output="screen"/>') as run:
        run.wait_for_output("ready")
        assert run.stop() == 1
        assert "patient-1 died while it was being stopped: exit code 5" in run.output


def test_respawn_starts_again_after_the_delay_and_deaths_are_forgiven(prefix: Prefix, tmp_path: Path) -> None:
    marker = tmp_path / "lives"
    prefix.python(
        "cat",
        f"from pathlib import Path\nlives = Path({str(marker)!r})\n"
        "lives.write_text((lives.read_text() if lives.exists() else '') + 'x')\n"
        f"if len(lives.read_text()) < 3:\n    raise SystemExit(1)\n{PATIENT}",
    )
    body = '<node pkg="fake" exec="cat" output="screen" respawn="true" respawn_delay="0.1"/>'
    with launch(prefix, body) as run:
        run.wait_for_output("ready")
        assert marker.read_text() == "xxx"
        assert run.output.count("process has died") == 2
        assert run.stop() == 0
        assert marker.read_text() == "xxx"


def test_a_node_that_refuses_what_it_was_given_ends_the_launch(prefix: Prefix) -> None:
    # A signal while Python itself starts would count as a death.
    patient = prefix.python(
        "patient", PATIENT.replace("while True:", "open(__file__ + '.up', 'w').close()\nwhile True:")
    )
    refusal = "echo 'rate = 0: allowed is 1' >&2\nexit 2\n"
    prefix.script("choosy", f"#!/bin/sh\nuntil [ -e {patient}.up ]; do sleep 0.02; done\n{refusal}")
    body = '<node pkg="fake" exec="patient"/><node pkg="fake" exec="choosy" respawn="true" respawn_delay="0.01"/>'
    with launch(prefix, body) as run:
        assert run.wait() == 1
        assert "[choosy-2] rate = 0: allowed is 1" in run.output
        assert "choosy-2 refuses what it was given, see its message; ending" in run.output
        assert len(pids(run)) == 2
        assert all_gone(pids(run))
        assert "patient-1 died" not in run.output


def test_stopping_while_a_respawn_is_due_starts_nothing(prefix: Prefix) -> None:
    prefix.script("mortal", "#!/bin/sh\nexit 1\n")
    with launch(prefix, '<node pkg="fake" exec="mortal" respawn="true" respawn_delay="600"/>') as run:
        run.wait_for_output("process has died")
        assert run.stop() == 0
        assert len(pids(run)) == 1


def test_what_does_not_end_is_terminated_then_killed_and_repeated_ctrl_c_leaks_nothing(prefix: Prefix) -> None:
    prefix.python("stubborn", STUBBORN)
    body = '<node pkg="fake" exec="stubborn" output="screen"/>'
    with launch(prefix, body, sigterm_timeout="2", sigkill_timeout="0.2") as run:
        run.wait_for_output("ready")
        numbers = pids(run)
        run.process.send_signal(signal.SIGINT)
        run.wait_for_output("user interrupted with ctrl-c (SIGINT)")
        run.process.send_signal(signal.SIGINT)
        run.wait_for_output("again, ignoring...")
        assert run.wait() == 1
        assert all_gone(numbers)
        assert "failed to terminate '2' seconds after receiving 'SIGINT', escalating to 'SIGTERM'" in run.output
        assert "escalating to 'SIGKILL'" in run.output
        assert "stubborn-1 had to be killed" in run.output


def test_what_a_node_has_started_itself_ends_with_it(prefix: Prefix) -> None:
    prefix.script("wrapper", "#!/bin/sh\nsleep 600 &\necho child $! \nwait\n")
    prefix.script("leaver", "#!/bin/sh\nsleep 600 &\necho child $! \n")
    body = '<node pkg="fake" exec="wrapper" output="screen"/><node pkg="fake" exec="leaver" output="screen"/>'
    with launch(prefix, body) as run:
        run.wait_for(lambda: run.output.count("child ") == 2)
        children = [int(number) for number in re.findall(r"child (\d+)", run.output)]
        assert run.stop() == 0
        wait_for(lambda: all_gone(children), timeout_s=10.0)


def test_nodes_end_when_the_launcher_is_killed(prefix: Prefix) -> None:
    prefix.python("patient", PATIENT)
    with launch(prefix, '<node pkg="fake" exec="patient" output="screen"/>') as run:
        run.wait_for_output("ready")
        numbers = pids(run)
        run.process.kill()
        run.process.wait()
        wait_for(lambda: all_gone(numbers), timeout_s=10.0)


def test_a_reader_that_goes_away_stops_the_nodes(prefix: Prefix) -> None:
    prefix.python("chatty", "import time\nwhile True:\n    print('x', flush=True)\n    time.sleep(0.01)\n")
    path = prefix.launch("it.launch.xml", '<node pkg="fake" exec="chatty" output="screen"/>')
    command = [sys.executable, "-m", "acts_tools", "launch", "--own", str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        line = next(line for line in process.stdout if "started with pid" in line)
        (number,) = re.findall(r"pid \[(\d+)\]", line)
        process.stdout.close()
        process.wait(20)
    assert all_gone([int(number)])


def test_output_goes_to_the_screen_the_log_or_both(prefix: Prefix, tmp_path: Path) -> None:
    prefix.script("say", '#!/bin/sh\necho "out $1"\necho "err $1" >&2\n')
    body = "".join(
        f'<node pkg="fake" exec="say" output="{output}" args="{output}"/>' for output in ("screen", "log", "both")
    )
    with launch(prefix, body) as run:
        assert run.wait() == 0
        screen = re.findall(r"^\[say-\d\] (.*)", run.output, re.MULTILINE)
    (log_path,) = (tmp_path / "log").glob("*/launch.log")
    log = re.findall(r"^[\d.]+ \[say-\d\] (.*)", log_path.read_text(), re.MULTILINE)
    assert sorted(screen) == ["err both", "err log", "err screen", "out both", "out screen"]
    assert sorted(log) == ["err both", "err log", "out both", "out log"]


def test_the_environment_is_passed_on_with_what_the_file_sets(prefix: Prefix) -> None:
    prefix.script("say", '#!/bin/sh\necho "$GIVEN $SET"\n')
    prefix.launch("it.launch.xml", '<set_env name="SET" value="two"/><node pkg="fake" exec="say" output="screen"/>')
    with launched("fake", "it.launch.xml", domain_id=80, environment={"GIVEN": "one"}) as run:
        assert run.wait() == 0
        assert "[say-1] one two" in run.output


def test_a_program_that_cannot_be_run_is_a_failure_that_stops_nothing(prefix: Prefix) -> None:
    prefix.script("broken", "#!/no/such/interpreter\n")
    prefix.script("fine", "#!/bin/sh\necho I ran\n")
    body = '<node pkg="fake" exec="broken"/><node pkg="fake" exec="fine" output="screen"/>'
    with launch(prefix, body) as run:
        assert run.wait() == 1
        assert "I ran" in run.output
        assert "broken-1 could not be started" in run.output


def test_an_invalid_file_starts_nothing(prefix: Prefix) -> None:
    prefix.python("patient", PATIENT)
    with launch(prefix, '<node pkg="fake" exec="patient"/>\n<foo/>') as run:
        assert run.wait() == 1
        assert run.output.startswith("error: ")
        assert "it.launch.xml:3: Unrecognized entity of the type: foo" in run.output
        assert not pids(run)


def test_an_argument_without_effect_starts_nothing_and_the_reason_is_told(prefix: Prefix) -> None:
    prefix.launch("inner.launch.xml", '<arg name="port" default="a"/>')
    body = '<arg name="sim" default="1"/><include file="$(dirname)/inner.launch.xml" unless="$(var sim)"/>'
    with launch(prefix, body, port="b") as run:
        assert run.wait() == 1
        reason = "the argument 'port' has no effect here: it is declared under a condition that does not hold"
        assert run.output == f"error: {reason}\n"
    with launch(prefix, body, port="b", sim="0") as run:
        assert run.wait() == 0
    with launch(prefix, body, prot="b") as run:
        assert run.wait() == 1
        assert "the launch file declares no argument 'prot'; declared: sim" in run.output


def test_the_temporary_parameter_files_are_removed(prefix: Prefix) -> None:
    prefix.script("show", '#!/bin/sh\ncat "$3"\necho "path $3"\n')
    with launch(prefix, '<node pkg="fake" exec="show" output="screen"><param name="a" value="5"/></node>') as run:
        assert run.wait() == 0
        assert "[show-1]     a: 5" in run.output
        (path,) = re.findall(r"path (.*)", run.output)
        assert not os.path.exists(path)  # noqa: PTH110 - a plain string of the output


def test_a_launcher_that_is_killed_leaves_temporary_files_only_where_the_file_has_parameters(
    prefix: Prefix, tmp_path: Path
) -> None:
    prefix.python("patient", PATIENT)
    body = '<node pkg="fake" exec="patient" output="screen">{}</node>'
    for parameters, count in (("", 0), ('<param name="a" value="5"/>', 1)):
        folder = tmp_path / f"temporary_{count}"
        folder.mkdir()
        with launch(prefix, body.format(parameters), environment={"TMPDIR": str(folder)}) as run:
            run.wait_for_output("ready")
            run.process.kill()
            run.process.wait()
        assert len(list(folder.iterdir())) == count
