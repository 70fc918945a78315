"""The arm as the control loop sees it, and the UR5e behind it.

`ur_rtde` and all in which it may wait are in a process of their own (`ur_process`); here nothing but connecting waits,
and that for a stated time. That ``servoJ`` returns True says nothing about the robot: every loss is found by
`RobotWatch` from what is read.
"""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import isfinite
from typing import Protocol

from acts_control.robots.robot_claim import RobotClaim
from acts_control.robots.safety import RUNTIME_PLAYING, RobotReading, safety_stop
from acts_control.robots.ur_probe import probe
from acts_core.errors import RobotError, SettingsError
from acts_core.runtime import is_loopback
from acts_core.settings import setting, validate

# The library itself waits for up to 5 s for its program to start.
_CONNECT_TIMEOUT_S = 10.0
_PROGRAM_TIMEOUT_S = 2.0
_KILL_TIMEOUT_S = 1.0
_POLL_S = 0.002

_STOP_DECELERATION_RAD_S2 = 4.0

_RATES_HZ = (125, 250, 500)

_PACKET_BYTES = 65536


@dataclass(frozen=True)
class RobotConfig:
    """How the robot is reached and moved."""

    robot_ip: str = setting("127.0.0.1", "address of the UR5e's controller")
    loopback_only: bool = setting(
        False, "for a simulated skin: refuse a robot_ip that is no numeric address of this machine"
    )
    control_rate_hz: int = setting(
        125, "control steps and commands a second: 125, 250 or 500", minimum=125, maximum=500
    )
    servo_lookahead_s: float = setting(
        0.05, "lookahead of servoJ: shorter is quicker, longer is smoother [s]", minimum=0.03, maximum=0.2
    )
    servo_gain: float = setting(300.0, "gain of servoJ", minimum=100.0, maximum=2000.0)
    homing_speed_rad_s: float = setting(
        0.6, "joint speed on the way to the level pose [rad/s]", minimum=0.01, maximum=3.0
    )
    homing_acceleration_rad_s2: float = setting(
        1.5, "joint acceleration on the way to the level pose [rad/s^2]", minimum=0.01, maximum=10.0
    )

    def __post_init__(self) -> None:
        validate(self)
        # What a simulated skin feels must not move a real arm.
        if self.loopback_only and not is_loopback(self.robot_ip):
            raise SettingsError(
                f"robot_ip = {self.robot_ip!r}: nothing is controlled, for the skin is simulated and this is no "
                "numeric address of this machine (127.0.0.1 to 127.255.255.254, ::1); "
                "with a real skin and robot give sim:=false"
            )
        if self.control_rate_hz not in _RATES_HZ:
            raise SettingsError(
                f"control_rate_hz = {self.control_rate_hz}: allowed is {', '.join(map(str, _RATES_HZ))}; "
                f"ur_rtde works in whole milliseconds"
            )


class RobotStoppedError(RobotError):
    """A safety function holds the robot; a person has to release it."""


class Robot(Protocol):
    """What the control loop needs of an arm. Nothing but `connect` waits; every method may raise `RobotError`."""

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        """Connect and take control; soon gives up, with a `RobotError`, when it is not wanted any more."""

    def read(self) -> RobotReading:
        """The newest state; costs microseconds."""

    @property
    def is_busy(self) -> bool:
        """Whether something that was asked for has not been carried out yet. (A move counts once it has begun.)"""

    def begin_move(self, q_rad: Sequence[float]) -> None:
        """Start to move to a pose."""

    def end_move(self) -> None:
        """Stop such a move."""

    def servo(self, q_rad: Sequence[float]) -> None:
        """Aim for joint angles; to be called `control_rate_hz` times a second."""

    def end_servo(self) -> None:
        """Stop following; the arm holds its pose."""

    def end_program(self) -> None:
        """Give up control; the robot's program ends."""

    def disconnect(self) -> None:
        """Cut the connection; no command is sent any more."""


class UrRobot:
    """A UR5e, real or simulated, through `ur_process`."""

    def __init__(self, config: RobotConfig) -> None:
        self._config = config
        self._claim: RobotClaim | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._link: socket.socket | None = None
        self._reading: RobotReading | None = None
        # Commands that have not been answered yet, oldest first: name, and when it was sent [s].
        self._pending: deque[tuple[str, float]] = deque()

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        """Connect and upload the control script.

        Raises
        ------
        RobotError
            When the controller does not answer, another program controls the robot, or it is not wanted any more.
        RobotStoppedError
            When a safety function holds it.
        RobotTakenError
            When another program of this machine controls it.
        """
        host = self._config.robot_ip
        if self._claim is None:
            self._claim = RobotClaim(host)
        self._await_former_end()
        probe(host)
        try:
            self._start_process()
            self._carry_out("watch", is_wanted)
            stop = safety_stop(self.read())
            if stop:
                raise RobotStoppedError(f"{host}: {stop}; release it at the robot, then start again")
            self._carry_out("take_control", is_wanted)
            # The library knows that its program runs a packet or two before it can be read.
            self._await(
                lambda: self.read().runtime_state == RUNTIME_PLAYING,
                is_wanted,
                _PROGRAM_TIMEOUT_S,
                "the control script does not run; is the robot in remote control?",
            )
        except RobotError as error:
            self.disconnect()
            if "already in use" in str(error):
                raise RobotError(f"{error} Is another program controlling the robot?") from error
            raise

    def read(self) -> RobotReading:
        """The newest state; costs microseconds."""
        self._take_in()
        if self._reading is None:
            raise RobotError(f"{self._config.robot_ip}: nothing has been read yet")
        waiting_s = time.monotonic() - self._pending[0][1] if self._pending else 0.0
        return self._reading._replace(waiting_s=waiting_s)

    @property
    def is_busy(self) -> bool:
        """Whether something that was asked for has not been carried out yet. (A move counts once it has begun.)"""
        if self._link is not None:
            self._take_in()
        return bool(self._pending)

    def begin_move(self, q_rad: Sequence[float]) -> None:
        """Start to move to a pose."""
        # Asynchronous: a blocking moveJ would answer at its end only.
        self._send(
            "moveJ", _finite(q_rad), self._config.homing_speed_rad_s, self._config.homing_acceleration_rad_s2, True
        )

    def end_move(self) -> None:
        """Stop such a move."""
        self._send("stopJ", _STOP_DECELERATION_RAD_S2)

    def servo(self, q_rad: Sequence[float]) -> None:
        """Aim for joint angles."""
        config = self._config
        # Speed and acceleration are ignored by the script.
        step_s = 1.0 / config.control_rate_hz
        self._send("servoJ", _finite(q_rad), 0.0, 0.0, step_s, config.servo_lookahead_s, config.servo_gain)

    def end_servo(self) -> None:
        """Stop following; the arm holds its pose."""
        self._send("servoStop", _STOP_DECELERATION_RAD_S2)

    def end_program(self) -> None:
        """Give up control; the robot's program ends."""
        if self._link is not None:
            self._send("stopScript")

    def disconnect(self) -> None:
        """Cut the connection; no command is sent any more."""
        # Killed first: what sees the link closed ends the robot's program, which is a command.
        if self._process is not None:
            self._process.kill()
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_KILL_TIMEOUT_S)
        if self._link is not None:
            self._link.close()
        self._link, self._reading = None, None
        self._pending.clear()
        if self._claim is not None and (self._process is None or self._process.poll() is not None):
            # Last: another program may take the robot from here on.
            self._claim.close()
            self._claim = None

    def _await_former_end(self) -> None:
        """Two connections at once would be refused, and both might command."""
        if self._process is None:
            return
        if self._process.poll() is None:
            raise RobotError(
                f"{self._config.robot_ip}: waiting for the end of the former connection (process {self._process.pid})"
            )
        self._process = None

    def _start_process(self) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            ours.setblocking(False)
            self._link = ours
            words = [str(theirs.fileno()), self._config.robot_ip, str(self._config.control_rate_hz)]
            try:
                self._process = subprocess.Popen(
                    [sys.executable, "-m", "acts_control.robots.ur_process", *words],
                    stdin=subprocess.DEVNULL,
                    pass_fds=[theirs.fileno()],
                    # A Ctrl-C in the terminal is for this process, which ends motion in order.
                    start_new_session=True,
                )
            except OSError as error:
                raise RobotError(f"the process for the robot cannot be started: {error}") from error

    def _carry_out(self, name: str, is_wanted: Callable[[], bool]) -> None:
        self._send(name)
        self._await(lambda: not self.is_busy, is_wanted, _CONNECT_TIMEOUT_S, f"{name}: no answer")

    def _await(self, condition: Callable[[], bool], is_wanted: Callable[[], bool], timeout_s: float, what: str) -> None:
        deadline = time.monotonic() + timeout_s
        while not condition():
            if not is_wanted():
                raise RobotError(f"{self._config.robot_ip}: connecting was given up")
            if time.monotonic() > deadline:
                raise RobotError(f"{self._config.robot_ip}: {what} (waited for {timeout_s:g} s)")
            time.sleep(_POLL_S)

    def _send(self, name: str, *arguments: object) -> None:
        self._take_in()
        assert self._link is not None
        try:
            self._link.send(json.dumps([name, *arguments]).encode())
        except OSError as error:
            raise RobotError(f"{self._config.robot_ip}: {name} cannot be handed over ({error.strerror})") from error
        self._pending.append((name, time.monotonic()))

    def _take_in(self) -> None:
        """Read what the other process has told since.

        Raises
        ------
        RobotError
            When something that was asked for has failed, or the process has ended.
        """
        if self._link is None:
            raise RobotError(f"{self._config.robot_ip}: not connected")
        while True:
            try:
                packet = self._link.recv(_PACKET_BYTES)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                raise RobotError(f"{self._config.robot_ip}: {self._how_it_ended()}")
            kind, *words = json.loads(packet)
            if kind == "reading":
                connected, timestamp_s, q_rad, safety_bits, runtime_state = words
                self._reading = RobotReading(connected, timestamp_s, tuple(q_rad), safety_bits, runtime_state)
                continue
            name, _ = self._pending.popleft()
            if kind == "failed":
                raise RobotError(f"{self._config.robot_ip}: {words[0]}")
            if words[0] is False and name in _REFUSALS:
                raise RobotError(f"{self._config.robot_ip}: {name} refused; {_REFUSALS[name]}")

    def _how_it_ended(self) -> str:
        assert self._process is not None
        try:
            code = self._process.wait(_KILL_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            return "the process of the connection does not answer any more"
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        return f"the process of the connection has ended ({how}); what ur_rtde said is above"


# What refuses to stop something has nothing to stop.
_REFUSALS = {
    "moveJ": "is the robot on and in remote control?",
    "servoJ": "the robot's program is not running",
}


def _finite(q_rad: Sequence[float]) -> list[float]:
    # ur_rtde sends NaN and vectors of any length; the gate has looked before, this is the very last place to.
    q = [float(angle) for angle in q_rad]
    if len(q) != 6 or not all(map(isfinite, q)):
        raise RobotError(f"joint angles {q} cannot be sent: six finite numbers are needed")
    return q
