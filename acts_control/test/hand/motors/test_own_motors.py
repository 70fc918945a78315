# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The example of docs/hand.md: motors of another make, in one file and one line."""

from __future__ import annotations

import inspect
import os
import pty
import re
import sys
import threading
import tty
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from waiting import wait_for

from acts_control.hand.control import HandLoop, HandLoopConfig, HandPhase
from acts_control.hand.description import HandDescription, hand_description
from acts_control.hand.motors import MOTORS, HandError, HandLostError, MotorKind, make_motors
from acts_core.errors import SettingsError
from acts_core.settings import describe, setting

PAGE = (Path(__file__).resolve().parents[4] / "docs" / "hand.md").read_text()
DEADLINE_S = 20.0


class Controller:
    """The servos behind a pseudo-terminal."""

    def __init__(self, motors: int) -> None:
        self.angles = [3.14159] * motors
        self.has_torque = False
        self.garbles = False
        self.ignored: list[str] = []
        """Words of which the next line each gets no answer."""
        self._master, slave = pty.openpty()
        tty.setraw(self._master)
        self.port = os.ttyname(slave)
        self._slave = slave
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        waiting = b""
        while True:
            try:
                waiting += os.read(self._master, 4096)
            except OSError:
                return
            *lines, waiting = waiting.split(b"\n")
            for line in lines:
                if line == b"end":
                    os.close(self._master)
                    return
                word = line.decode().partition(" ")[0]
                if word in self.ignored:
                    self.ignored.remove(word)
                    continue
                os.write(self._master, self._answer(line.decode()))

    def _answer(self, line: str) -> bytes:
        word, _, rest = line.partition(" ")
        if word == "goal":
            self.angles = [float(angle) for angle in rest.split(",")]
        elif word == "torque":
            self.has_torque = rest == "1"
        elif self.garbles:
            return b"\xff\n"
        return ",".join(map(str, self.angles)).encode() + b"\n"

    def close(self) -> None:
        """The cable is torn off."""
        if self._thread.is_alive():
            os.write(self._slave, b"end\n")
            self._thread.join(DEADLINE_S)
            os.close(self._slave)


@pytest.fixture
def gripper(tmp_path: Path) -> HandDescription:
    """The hand of the same page."""
    code, _skin = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    path = tmp_path / "gripper.yaml"
    path.write_text(code)
    return hand_description(str(path))


@pytest.fixture
def controller() -> Iterator[Controller]:
    controller = Controller(2)
    yield controller
    controller.close()


@pytest.fixture
def servos(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The module of the page, and its line in the registry."""
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    module = ModuleType("line_servos")
    monkeypatch.setitem(sys.modules, "line_servos", module)  # dataclasses look their module up
    exec(compile(code, "hand.md", "exec", dont_inherit=True), vars(module))
    (line,) = re.findall(r"^The line, in `MOTORS` of .*?: `(.*?),`", PAGE, re.MULTILINE)
    ((name, kind),) = eval("{" + line + "}", {**vars(module), "MotorKind": MotorKind}).items()
    monkeypatch.setitem(MOTORS, name, kind)
    return module


def settings(servos: ModuleType, controller: Controller) -> Any:
    # A machine that is busy answers late.
    return servos.LineServosConfig(port=controller.port, line_servos_timeout_s=1.0)


def test_the_loop_of_a_hand_moves_them_and_releases_them_in_the_end(
    servos: ModuleType, controller: Controller, gripper: HandDescription
) -> None:
    bus = make_motors("line_servos", gripper, settings(servos, controller))
    config = HandLoopConfig(rate_hz=50.0, command_stale_after_s=10.0, silence_s=10.0)
    loop = HandLoop(gripper, bus, config, lambda *_told: None)
    loop.launch()
    try:
        wait_for(lambda: loop.status.phase is HandPhase.ENABLED)
        assert controller.has_torque
        loop.command({"left": 0.5})

        def is_there() -> bool:
            reading = loop.status.reading
            return reading is not None and reading.q_rad[0] == pytest.approx(0.5, abs=1e-3)

        wait_for(is_there)
        # The example's motor of this joint is at 2 rad where the joint is at 0, and turns against it.
        assert controller.angles[0] == pytest.approx(1.5, abs=1e-3)
    finally:
        loop.close()
    assert not controller.has_torque


def test_a_lost_answer_to_a_goal_does_not_let_go_of_what_is_held(
    servos: ModuleType, controller: Controller, gripper: HandDescription
) -> None:
    config = HandLoopConfig(rate_hz=50.0, command_stale_after_s=10.0, silence_s=10.0, connect_retry_s=0.05)
    told: list[str] = []
    controller.angles = [2.0, 2.0]  # where the joints are at 0
    bus = make_motors("line_servos", gripper, settings(servos, controller))
    loop = HandLoop(gripper, bus, config, lambda _level, sentence: told.append(sentence))
    loop.launch()
    try:
        wait_for(lambda: loop.status.phase is HandPhase.ENABLED)
        controller.ignored.append("goal")
        wait_for(lambda: loop.status.unanswered == 1)
        cycles = loop.status.cycles
        wait_for(lambda: loop.status.cycles > cycles + 3)
        assert told == []
        assert controller.has_torque
        loop.command({"left": 0.5})
        wait_for(lambda: controller.angles[0] == pytest.approx(1.5, abs=1e-3))
    finally:
        loop.close()


def test_who_does_not_answer_at_first_is_reached_later(
    servos: ModuleType, controller: Controller, gripper: HandDescription
) -> None:
    # The port is open by then, and taken by this program alone.
    controller.ignored.append("torque")
    config = HandLoopConfig(rate_hz=50.0, silence_s=10.0, connect_retry_s=0.05)
    loop = HandLoop(gripper, make_motors("line_servos", gripper, settings(servos, controller)), config, lambda *_: None)
    loop.launch()
    try:
        wait_for(lambda: loop.status.phase is HandPhase.ENABLED)
        assert controller.ignored == []
    finally:
        loop.close()


def test_what_it_answers_and_a_cable_that_is_torn_off_are_errors_of_the_hand(
    servos: ModuleType, controller: Controller, gripper: HandDescription
) -> None:
    hand = servos.LineServos(gripper, settings(servos, controller))
    with pytest.raises(HandLostError, match="not connected"):
        hand.read()
    assert hand.connect() == []
    controller.garbles = True
    with pytest.raises(HandError, match="is not 2 angles"):
        hand.read()
    controller.close()
    with pytest.raises(HandLostError, match="is gone"):
        hand.read()


def test_their_settings_become_parameters_of_both_nodes(servos: ModuleType) -> None:
    from acts_control.hand.motors import with_motors
    from acts_control.hand.nodes import reflexes_node
    from acts_control.hand.nodes.motor_node import MotorSettings

    for kind in (with_motors(MotorSettings), reflexes_node.settings_class()):
        assert describe(kind)["line_servos_timeout_s"].maximum == 1.0
        assert list(describe(kind)).count("port") == 1


def test_motors_whose_line_comes_first_are_not_the_default(servos: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    from acts_control.hand import motors
    from acts_control.hand.nodes import motor_node

    monkeypatch.setattr(motors, "MOTORS", {"line_servos": MOTORS["line_servos"], **MOTORS})
    anew = ModuleType("motor_node_anew")
    monkeypatch.setitem(sys.modules, anew.__name__, anew)
    exec(compile(inspect.getsource(motor_node), "motor_node.py", "exec", dont_inherit=True), vars(anew))
    assert describe(anew.MotorSettings)["interface"].choices[0] == "line_servos"
    assert motors.with_motors(anew.MotorSettings)().interface == "dynamixel"


def test_a_setting_that_others_have_is_refused(servos: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import dataclass

    from acts_control.hand.motors import BusConfig, with_motors
    from acts_control.hand.nodes.motor_node import MotorSettings

    @dataclass(frozen=True)
    class Config(BusConfig):
        baud: int = setting(115200, "bits a second")

    monkeypatch.setitem(MOTORS, "line_servos", MotorKind(Config, servos.LineServos))
    with pytest.raises(SettingsError, match="'baud' is declared 2 times"):
        with_motors(MotorSettings)
