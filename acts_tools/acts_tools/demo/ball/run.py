# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts demo ball_balancing`: run the whole chain with simulated skin, ball and robot; record, score and draw it."""

from __future__ import annotations

import socket
import sys
from importlib.util import find_spec
from pathlib import Path

from acts_control.ball import Trajectory, TrajectoryConfig
from acts_core.array import ArrayGeometry
from acts_core.errors import LaunchError, SettingsError
from acts_core.runtime import is_loopback
from acts_msgs.msg import BalanceStatus
from acts_tools.demo.ball.collector import Collector
from acts_tools.demo.ball.picture import draw
from acts_tools.demo.ball.recording import Recording
from acts_tools.demo.ball.score import score, table
from acts_tools.demo.claims import claimed_folder, claimed_robot
from acts_tools.demo.files import DemoFiles
from acts_tools.percentiles import percentiles
from acts_tools.process_load import LoadMeter
from acts_tools.ros_domain import use_free_domain
from acts_tools.run_folder import run_folder
from acts_tools.running.launched import START_TIMEOUT_S, launched
from acts_tools.running.node import ros
from acts_tools.running.stopping import StopFlag
from acts_tools.running.watcher import Watcher

NAMESPACE = "/plate"
_RTDE_PORT = 30004
# A machine that is busy with the start-up of all processes may stand still for longer than a robot may be silent.
_STARTS = 3
_ANSWER_S = 10.0

_STATE_NAMES = {
    BalanceStatus.STATE_CONNECTING: "connecting",
    BalanceStatus.STATE_HOMING: "levelling",
    BalanceStatus.STATE_WAITING: "waiting",
    BalanceStatus.STATE_BALANCING: "balancing",
    BalanceStatus.STATE_STOPPED: "stopped",
}


def plan(seconds: float | None) -> tuple[str, float]:
    """The longest trajectory of hold, N, B, I that fits into a given time.

    Parameters
    ----------
    seconds : float or None
        Available time [s]; None for the whole trajectory.

    Returns
    -------
    trajectory : str
        Comma list for the launch argument.
    duration_s : float
        Its duration [s].
    """
    segments = ["hold", "N", "B", "I"]
    while True:
        trajectory = ",".join(segments)
        duration_s = Trajectory(TrajectoryConfig(trajectory=trajectory)).duration_s
        if seconds is None or duration_s <= seconds or len(segments) == 1:
            return trajectory, duration_s
        segments.pop()


def _line(collector: Collector, total_s: float) -> str:
    words = [f"{_STATE_NAMES.get(collector.state, '?'):>10}"]
    track = collector.recording.reference.time_s
    if track:
        words.append(f"{track[-1] - track[0]:5.1f}/{total_s:.0f} s {collector.segment:<4}")
    else:
        words.append(collector.reason)
    if collector.latency_s.size:
        latency_ms = percentiles(1e3 * collector.latency_s, ("median", "p99"))
        words.append(f"{collector.rate_hz:6.1f} contacts/s")
        words.append(f"latency {latency_ms['median']:.2f} ms (p99 {latency_ms['p99']:.2f})")
    if collector.ball_m is not None:
        words.append(f"ball {collector.ball_m[0] * 1000:+6.1f} {collector.ball_m[1] * 1000:+6.1f} mm")
    return " | ".join(words)


def check_robot_ip(robot_ip: str) -> None:
    """Refuse an address that a real robot may have, or at which a simulated one is running.

    Raises
    ------
    LaunchError
        In both cases.
    """
    if not is_loopback(robot_ip) or ":" in robot_ip:
        raise LaunchError(
            f"--robot-ip {robot_ip}: the demo moves simulated robots only, at 127.0.0.1 to 127.255.255.254"
        )
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((robot_ip, _RTDE_PORT))
        except OSError as error:
            raise LaunchError(
                f"there is a robot at {robot_ip} already ({error.strerror}); "
                "end that program, or choose another address: --robot-ip 127.0.0.2"
            ) from error


def watch(arguments: list[str], duration_s: float, recording: Recording, log_path: Path, stop: StopFlag) -> None:
    """Launch the chain and record it to the end of the trajectory, or until the user stops it (KeyboardInterrupt).

    Raises
    ------
    LaunchError
        When the launch ended, or the control loop was not closed in time or after some starts.
    """
    with launched("ball_balancing.launch.xml", arguments, log_path) as launch, ros():
        collector = Collector(NAMESPACE, recording)
        watcher = Watcher(collector.take_in, launch, stop, lambda: _line(collector, duration_s))
        try:
            _close_loop(watcher, collector)
            meter = LoadMeter(launch.pid)
            meter.start()
            watcher.until(
                lambda: recording.finished or recording.has_fallen or bool(recording.stop_reason), duration_s + 10.0
            )
            recording.cpu_percent = meter.percent()
            watcher.end()
        finally:
            collector.destroy_node()


def _close_loop(watcher: Watcher, collector: Collector) -> None:
    """Wait until the ball is balanced; a controller that stops before is started again, as a user would."""
    ends = (BalanceStatus.STATE_BALANCING, BalanceStatus.STATE_STOPPED)
    for _ in range(_STARTS):
        if not watcher.until(lambda: collector.state in ends, START_TIMEOUT_S):
            raise LaunchError(f"the control loop was not closed within {START_TIMEOUT_S:.0f} s")
        if collector.state == BalanceStatus.STATE_BALANCING:
            return
        watcher.end()
        print(f"stopped before the ball was balanced: {collector.reason}; starting again", flush=True)
        watcher.until(collector.ask_to_start, _ANSWER_S)
        watcher.until(lambda: collector.state != BalanceStatus.STATE_STOPPED, _ANSWER_S)
    raise LaunchError(f"the controller stopped {_STARTS} times before the ball was balanced: {collector.reason}")


def run(seconds: float | None, out: Path, robot_ip: str, realtime_priority: int = 0) -> int:
    """Run the demo and return the exit code, 0 if the trajectory came to its end within the limits.

    Parameters
    ----------
    seconds : float or None
        Trace only the letters that fit into this time [s]; None for all.
    out : Path
        Folder for the results.
    robot_ip : str
        Loopback address of the simulated robot; no other is accepted.
    realtime_priority : int
        SCHED_FIFO priority of all processes; 0 for ordinary scheduling.
    """
    check_robot_ip(robot_ip)
    files = DemoFiles.made(out, "ball_balancing")
    with claimed_folder(out), claimed_robot(robot_ip):
        require_ur_rtde()
        return _run(seconds, files, robot_ip, realtime_priority)


def require_ur_rtde() -> None:
    """Raise SettingsError where the library is missing by which the arm is moved: without it nothing would."""
    if find_spec("rtde_control") is None:
        raise SettingsError(
            "the UR5e needs the library ur_rtde, which is not installed: pip install ur-rtde. Python "
            f"{sys.version_info[0]}.{sys.version_info[1]} may be too new for its wheels. On a bare machine: "
            "make clean; make setup PYTHON=/path/to/python3.12"
        )


def _run(seconds: float | None, files: DemoFiles, robot_ip: str, realtime_priority: int) -> int:
    trajectory, duration_s = plan(seconds)
    use_free_domain()
    print(f"Ball balancing with simulated skin, ball and UR5e: {trajectory.replace(',', ', ')}; {duration_s:.0f} s")
    print("The same nodes run on the real robot; only launch arguments differ. Everything below is measured live.")
    recording = Recording()
    with StopFlag() as stop, run_folder("acts_demo_") as run_dir:
        launch_arguments = [
            f"trajectory:={trajectory}",
            f"run_dir:={run_dir}",
            f"robot_ip:={robot_ip}",
            # Enough for a map of the pressure.
            "image_raw_rate_hz:=20",
            # A crash is to be seen, not bridged.
            "standby:=false",
            f"realtime_priority:={realtime_priority}",
        ]
        with files.log_shown():
            watch(launch_arguments, duration_s, recording, files.log, stop)
    results = score(recording)
    # Before what a full disk may not take.
    print(table(results))
    files.write(results)
    draw(recording, results, ArrayGeometry(), files.picture)
    print(f"  wrote {files}")
    return 0 if results["ok"] else 1
