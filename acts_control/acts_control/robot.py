"""The UR5e through `ur_rtde`, which no other module of this package imports.

What is particular about that library: the constructors hold Python's global lock, so an address is tried with plain
sockets first; ``servoJ`` returns True whether or not anybody listens, so every loss is found by `RobotWatch` from what
is read; after a loss its control interface must not be called any more, for it blocks for seconds.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import isfinite
from typing import Any, Protocol

from acts_control.robot_claim import RobotClaim
from acts_control.safety import RUNTIME_PLAYING, RobotReading, safety_stop
from acts_core.addresses import is_loopback
from acts_core.errors import RobotError, SettingsError
from acts_core.settings import setting, validate

# Dashboard, script upload, real-time data exchange.
_PORTS = (30004, 29999, 30003)
_CONNECT_TIMEOUT_S = 2.0
_PROGRAM_TIMEOUT_S = 2.0

# What is asked of the robot. With the library's own list of 58 variables its threads take several times the CPU.
_VARIABLES = ["timestamp", "actual_q", "safety_status_bits", "runtime_state", "robot_status_bits"]

_STOP_DECELERATION_RAD_S2 = 4.0

_RATES_HZ = (125, 250, 500)


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
    """What the control loop needs of an arm. Every method may raise `RobotError`."""

    def connect(self) -> None:
        """Connect and take control."""

    def read(self) -> RobotReading:
        """The newest state; costs microseconds and never blocks."""

    def begin_move(self, q_rad: Sequence[float]) -> None:
        """Start to move to a pose; returns at once."""

    def end_move(self) -> None:
        """Stop such a move."""

    def servo(self, q_rad: Sequence[float]) -> None:
        """Aim for joint angles; to be called `control_rate_hz` times a second."""

    def end_servo(self) -> None:
        """Stop following; the arm holds its pose."""

    def disconnect(self, *, lost: bool) -> None:
        """Give up control. With `lost` no command is sent any more."""


class UrRobot:
    """A UR5e, real or simulated."""

    def __init__(self, config: RobotConfig) -> None:
        self._config = config
        self._control: Any = None
        self._receive: Any = None
        self._claim: RobotClaim | None = None

    def connect(self) -> None:
        """Connect and upload the control script.

        Raises
        ------
        RobotError
            When a port cannot be reached, or another program controls the robot.
        RobotStoppedError
            When a safety function holds it.
        RobotTakenError
            When another program of this machine controls it.
        """
        if self._claim is None:
            self._claim = RobotClaim(self._config.robot_ip)
        try:
            import rtde_control
            import rtde_receive
        except ImportError as error:
            raise RobotError(f"ur_rtde cannot be imported ({error}); install it with: pip install ur-rtde") from error
        config = self._config
        for port in _PORTS:
            _try_port(config.robot_ip, port)
        rate_hz = float(config.control_rate_hz)
        try:
            self._receive = rtde_receive.RTDEReceiveInterface(config.robot_ip, rate_hz, _VARIABLES)
            reading = self.read()
            stop = safety_stop(reading)
            if stop:
                raise RobotStoppedError(f"{config.robot_ip}: {stop}; release it at the robot, then start again")
            self._control = rtde_control.RTDEControlInterface(config.robot_ip, rate_hz)
            self._await_program()
        except (RuntimeError, ValueError) as error:
            self.disconnect(lost=True)
            hint = "; is another program controlling the robot?" if "in use" in str(error) else ""
            raise RobotError(f"{config.robot_ip}: {str(error).strip()}{hint}") from error
        except RobotError:
            self.disconnect(lost=True)
            raise

    def _await_program(self) -> None:
        """The control interface knows that its program runs a packet or two before the receive interface does."""
        deadline = time.monotonic() + _PROGRAM_TIMEOUT_S
        while self.read().runtime_state != RUNTIME_PLAYING:
            if time.monotonic() > deadline:
                raise RobotError(
                    f"{self._config.robot_ip}: the control script does not run; is the robot in remote control?"
                )
            time.sleep(0.002)

    def read(self) -> RobotReading:
        """The newest state; costs microseconds and never blocks."""
        receive = self._receive
        return RobotReading(
            bool(receive.isConnected()),
            float(receive.getTimestamp()),
            tuple(receive.getActualQ()),
            int(receive.getSafetyStatusBits()),
            int(receive.getRuntimeState()),
        )

    def begin_move(self, q_rad: Sequence[float]) -> None:
        """Start to move to a pose; returns at once."""
        speed, acceleration = self._config.homing_speed_rad_s, self._config.homing_acceleration_rad_s2
        # Asynchronous: a blocking moveJ would wait for minutes after the connection was lost.
        if not self._call("moveJ", _finite(q_rad), speed, acceleration, True):
            raise RobotError(f"{self._config.robot_ip}: moveJ refused; is the robot on and in remote control?")

    def end_move(self) -> None:
        """Stop such a move."""
        self._call("stopJ", _STOP_DECELERATION_RAD_S2)

    def servo(self, q_rad: Sequence[float]) -> None:
        """Aim for joint angles."""
        config = self._config
        # Speed and acceleration are ignored by the script.
        step_s = 1.0 / config.control_rate_hz
        if not self._call("servoJ", _finite(q_rad), 0.0, 0.0, step_s, config.servo_lookahead_s, config.servo_gain):
            raise RobotError(f"{config.robot_ip}: servoJ refused; the robot's program is not running")

    def end_servo(self) -> None:
        """Stop following; the arm holds its pose."""
        self._call("servoStop", _STOP_DECELERATION_RAD_S2)

    def disconnect(self, *, lost: bool) -> None:
        """Give up control. With `lost` no command is sent any more."""
        control, receive, self._control, self._receive = self._control, self._receive, None, None
        # Whatever these say, both are done with: errors of a connection that is being given up mean nothing.
        if control is not None:
            with suppress(RuntimeError):
                if not lost:
                    control.stopScript()
            with suppress(RuntimeError):
                control.disconnect()
        if receive is not None:
            with suppress(RuntimeError):
                receive.disconnect()
        # Last: another program may take the robot from here on.
        claim, self._claim = self._claim, None
        if claim is not None:
            claim.close()

    def _call(self, name: str, *arguments: object) -> bool:
        try:
            return bool(getattr(self._control, name)(*arguments))
        except (RuntimeError, ValueError) as error:
            raise RobotError(f"{self._config.robot_ip}: {name}: {str(error).strip()}") from error


def _finite(q_rad: Sequence[float]) -> list[float]:
    # ur_rtde sends NaN and vectors of any length; the gate has looked before, this is the very last place to.
    q = [float(angle) for angle in q_rad]
    if len(q) != 6 or not all(map(isfinite, q)):
        raise RobotError(f"joint angles {q} cannot be sent: six finite numbers are needed")
    return q


def _try_port(host: str, port: int) -> None:
    try:
        socket.create_connection((host, port), timeout=_CONNECT_TIMEOUT_S).close()
    except OSError as error:
        raise RobotError(
            f"no UR controller at {host} port {port} ({error.strerror or error}); is it on, and robot_ip right?"
        ) from error
