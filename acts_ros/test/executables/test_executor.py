# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A node process from start to stop; ROS_DOMAIN_ID 11."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from acts_core.errors import REFUSED_EXIT_CODE

pytestmark = pytest.mark.slow

NODE = """
import gc
import os
import sys
import threading
import weakref
from acts_core import errors
from acts_ros.executor import EventsExecutor, call_soon, call_when_done, run
from acts_ros.middleware import announces_often
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.task import Future

class Litter:
    def __init__(self):
        self.itself = self
        weakref.finalize(self, print, "searched for garbage").atexit = False

class Example(Node):
    def __init__(self, name="example"):
        super().__init__(name)
        if "slow" in sys.argv and name == "example":
            Litter()
            print("starting", flush=True)
            while True:
                self.create_timer(1.0, self.tick)
        if "fail" in sys.argv:
            raise getattr(errors, sys.argv[-1])("rate_hz = 0: allowed is 1 to 1000")
        if "settled" in sys.argv:
            print("garbage is collected while nodes are made:", gc.isenabled(), flush=True)
        self.create_timer(0.01, self.tick)
        self.ticks = 0

    def tick(self):
        self.ticks += 1
        if self.ticks == 3 and "unsent" in sys.argv:
            raise rclpy_implementation.RCLError(f"failed to {sys.argv[-1]}: cannot publish data, at x.cpp:68")
        if self.ticks == (9 if "unsent" in sys.argv else 3):
            print("ticking", flush=True)
            if "settled" in sys.argv:
                watched = "acts_dds_watch" in [thread.name for thread in threading.enumerate()]
                print("garbage is collected:", gc.isenabled(), flush=True)
                print("what is there stays:", gc.get_freeze_count() > 10_000, flush=True)
                print("a thread waits for less than a frame:", sys.getswitchinterval() < 0.001, flush=True)
                print("the middleware is watched:", watched == announces_often(os.environ), flush=True)
                quickest = "SingleThreadedExecutor" if EventsExecutor is None else "EventsExecutor"
                print("the quickest executor:", type(self.executor).__name__ == quickest, flush=True)
            if "soon" in sys.argv:
                threading.Thread(target=call_soon, args=(self, self.tell)).start()
            if "done" in sys.argv:
                future = Future(executor=self.executor)
                call_when_done(self, future, lambda answer: self.tell(answer.result()))
                threading.Thread(target=future.set_result, args=("answered",)).start()

    def tell(self, *words):
        print(*words, "on the executor's thread:", threading.current_thread() is threading.main_thread(), flush=True)
        if "failing" in sys.argv:
            raise errors.RobotError("it has gone")

    def begin(self):
        print("begun", flush=True)
        if "late" in sys.argv:
            raise errors.RobotError("it has gone")

    def failed(self):
        print("failed", flush=True)

    def close(self):
        if "stubborn" in sys.argv:
            print("closing", flush=True)
            sys.stdin.readline()
            # The context is there to the end: what ends motion may still tell of it.
            self.get_logger().info("told")
            self.create_publisher(DiagnosticArray, "told", 10).publish(DiagnosticArray())
        print("closed", flush=True)

class Other(Example):
    def __init__(self):
        super().__init__("other")

class Breaking(Other):
    def close(self):
        raise RuntimeError("cannot be closed")

of = {"slow": [Other, Example], "breaking": [Example, Breaking], "two": [Example, Example]}
sys.exit(run(next((nodes for word, nodes in of.items() if word in sys.argv), [Example])))
"""


@contextmanager
def started(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    environment = {**os.environ, "ROS_DOMAIN_ID": "11", "ROS_PYTHON_CHECK_FIELDS": "1"}
    with subprocess.Popen(
        [sys.executable, "-c", NODE, *arguments],
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_node_in_order(number: signal.Signals) -> None:
    with started() as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        assert process.stdout.readline() == "ticking\n"
        process.send_signal(number)
        output, errors = process.communicate(timeout=60)
    assert (output, errors) == ("closed\n", "")
    assert process.returncode == 0


def test_a_process_is_settled_before_it_works() -> None:
    with started("settled") as process:
        assert process.stdout is not None
        told = [process.stdout.readline() for _ in range(8)]
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=60) == ("closed\n", "")
    assert told == [
        "garbage is collected while nodes are made: False\n",
        "begun\n",
        "ticking\n",
        "garbage is collected: True\n",
        "what is there stays: True\n",
        "a thread waits for less than a frame: True\n",
        "the middleware is watched: True\n",
        "the quickest executor: True\n",
    ]


def test_another_error_of_ros_ends_the_process() -> None:
    with started("unsent", "go on") as process:
        output, errors = process.communicate(timeout=60)
    assert output == "begun\nfailed\nclosed\n"
    assert errors.endswith("RCLError: failed to go on: cannot publish data, at x.cpp:68\n")
    assert process.returncode == 1


@pytest.mark.parametrize("what", ["response", "request"])
def test_an_answer_or_a_question_that_cannot_be_sent_is_told_and_ends_nothing(what: str) -> None:
    with started("unsent", f"send {what}") as process:
        assert process.stdout is not None
        for words in ("begun", "ticking"):
            assert process.stdout.readline() == f"{words}\n"
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
    assert output == "closed\n"
    assert "[WARN]" in errors
    assert f"[acts_ros]: failed to send {what}: cannot publish data\n" in errors
    assert process.returncode == 0


def test_another_thread_has_the_executors_thread_call_something() -> None:
    with started("soon") as process:
        assert process.stdout is not None
        for words in ("begun", "ticking", "on the executor's thread: True"):
            assert process.stdout.readline() == f"{words}\n"
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=60) == ("closed\n", "")
    assert process.returncode == 0


def test_an_answer_is_handed_on_by_the_executors_thread() -> None:
    with started("done") as process:
        assert process.stdout is not None
        for words in ("begun", "ticking", "answered on the executor's thread: True"):
            assert process.stdout.readline() == f"{words}\n"
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=60) == ("closed\n", "")
    assert process.returncode == 0


@pytest.mark.parametrize(("called", "words"), [("soon", ""), ("done", "answered ")])
def test_an_error_of_what_the_executors_thread_was_to_call_ends_the_process_in_order(called: str, words: str) -> None:
    with started(called, "failing") as process:
        output, errors = process.communicate(timeout=60)
    assert output == f"begun\nticking\n{words}on the executor's thread: True\nfailed\nclosed\n"
    assert errors.endswith("error: it has gone\n")
    assert process.returncode == 1


def test_a_node_whose_end_fails_does_not_keep_the_others_from_theirs() -> None:
    with started("breaking") as process:
        assert process.stdout is not None
        for words in ("begun", "begun", "ticking", "ticking"):
            assert process.stdout.readline() == f"{words}\n"
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
    assert output == "closed\n"
    assert "RuntimeError: cannot be closed" in errors
    assert process.returncode == 1


def test_a_signal_while_a_node_is_made_is_an_orderly_end() -> None:
    with started("slow") as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "starting\n"
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
    # What a start has left that was broken off is not searched for garbage: after a compiler that takes seconds.
    # The node that was made before is closed; nothing has failed.
    assert (output, errors) == ("closed\n", "")
    assert process.returncode == 0


def test_signals_on_the_way_out_change_nothing() -> None:
    with started("stubborn") as process:
        assert process.stdout is not None
        assert [process.stdout.readline() for _ in range(2)] == ["begun\n", "ticking\n"]
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "closing\n"
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGINT):
            process.send_signal(number)
        output, errors = process.communicate("go on\n", timeout=60)
    assert output == "closed\n"
    assert errors.count("\n") == 1
    assert "told" in errors
    assert process.returncode == 0


def test_a_signal_during_the_imports_is_an_orderly_end(tmp_path: Path) -> None:
    (tmp_path / "slow_module.py").write_text('print("importing", flush=True)\nwhile True:\n    pass\n')
    with subprocess.Popen(
        [sys.executable, "-m", "acts_ros.executables.program", "slow_module"],
        env={**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "importing\n"
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=60) == ("", "")
    assert process.returncode == 0


@pytest.mark.parametrize(("error", "code"), [("SettingsError", 2), ("DictionaryError", 2), ("RobotError", 1)])
def test_an_error_at_start_is_one_line_and_the_exit_code_tells_whether_to_try_again(error: str, code: int) -> None:
    with started("fail", error) as process:
        output, errors = process.communicate(timeout=60)
    assert process.returncode == code
    assert errors == "error: rate_hz = 0: allowed is 1 to 1000\n"
    assert output == ""


def test_a_node_is_told_that_an_error_ends_it_before_it_is_closed() -> None:
    with started("late") as process:
        output, errors = process.communicate(timeout=60)
    assert (output, errors) == ("begun\nfailed\nclosed\n", "error: it has gone\n")
    assert process.returncode == 1


@pytest.mark.parametrize("value", ["1", "[]", "maybe"])
def test_a_parameter_of_ros_of_the_wrong_type_is_refused_in_one_line(value: str) -> None:
    with started("--ros-args", "-p", f"use_sim_time:={value}") as process:
        output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (REFUSED_EXIT_CODE, "")
    assert errors.startswith("error: ")
    assert "'use_sim_time'" in errors
    assert errors.count("\n") == 1


def test_two_nodes_of_one_name_are_refused() -> None:
    with started("two") as process:
        output, errors = process.communicate(timeout=60)
    assert output == "failed\nclosed\nfailed\nclosed\n"
    error = errors.splitlines()[-1]
    assert error.startswith("error: two nodes of this process are named /example: __node, ")
    assert process.returncode == REFUSED_EXIT_CODE
