# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The examples of docs/extending.md as they stand there: one module and one line each. ROS_DOMAIN_ID 25."""

from __future__ import annotations

import importlib.util
import re
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from geometry_msgs.msg import TwistStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from waiting import wait_for

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.frames import Scheme
from acts_core.sampling import SamplingConfig
from acts_core.settings import describe
from acts_core.skin import layout
from acts_driver.protocols import PROTOCOLS, Protocol
from acts_msgs.msg import Contact
from acts_recon.classifiers import CLASSIFIERS
from acts_recon.methods import METHODS, Method, SkinSetup
from acts_recon.objects import build_object_library, save_object_library
from acts_ros.qos import STATE, STREAM
from acts_sim.pressing import object_named
from acts_tools.evaluate.classification.trials import Trials, run_trials
from acts_tools.evaluate.estimators.methods import method_named, method_names
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text()
DEADLINE_S = 20.0

Patch = pytest.MonkeyPatch
Names = dict[str, Any]


def section(title: str) -> str:
    """A section of the page."""
    return re.split(rf"^## {title}$", PAGE, flags=re.MULTILINE)[1].split("\n## ")[0]


def code_of(title: str, language: str = "python") -> str:
    """The one block of code in a section."""
    (code,) = re.findall(rf"```{language}\n(.*?)```", section(title), re.DOTALL)
    return str(code)


def module_of(title: str) -> Names:
    """What the module of a section defines."""
    names: Names = {"__name__": __name__}
    # Its own future annotations count, not those of this file.
    exec(compile(code_of(title), "extending.md", "exec", dont_inherit=True), names)
    return names


def register(patch: Patch, title: str, registry: dict[str, Any], names: Names) -> str:
    """Do what the section's line does; the name."""
    (line,) = re.findall(r"^The line, in .*: `(.*),`\.$", section(title), re.MULTILINE)
    ((name, entry),) = eval("{" + line + "}", {**names, "Protocol": Protocol}).items()
    patch.setitem(registry, name, entry)
    return str(name)


def started_anew(module: str) -> Names:
    """What a module of settings holds in a program that is started now."""
    importlib.import_module(module)
    spec = importlib.util.find_spec(module)
    assert spec is not None
    assert spec.loader is not None
    anew = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(anew)
    return vars(anew)


@pytest.fixture
def fading(monkeypatch: Patch) -> type[Method]:
    """The page's method, registered."""
    names = module_of("A method of recovery")
    assert register(monkeypatch, "A method of recovery", METHODS, names) == "fading"
    return METHODS["fading"]


def test_a_method_recovers_in_any_layout_and_fades(fading: type[Method]) -> None:
    glove = layout("glove")
    skin = SkinSetup(glove.geometry(), glove)
    method = fading(skin, fading.Config(fading_memory_s=0.01))
    taxel = int(np.flatnonzero(glove.patch_of_taxel.ravel() == 0)[5])
    one, count = np.array([taxel], dtype=np.uint16), np.array([800], dtype=np.uint16)
    image = method.step(one, count, 1.0, 0.001)
    assert glove.matrix(image).ravel()[taxel] == 800
    other = np.array([taxel + 1], dtype=np.uint16)
    method.step(other, count, 1.01, 0.001)
    assert glove.matrix(image).ravel()[taxel] == pytest.approx(800 / np.e, rel=1e-3)
    with pytest.raises(ArrayError, match="occurs twice"):
        method.step(np.repeat(one, 2), np.repeat(count, 2), 1.02, 0.001)
    method.reset()
    assert not image.any()


def test_its_line_makes_it_a_choice_of_the_node_with_parameters_of_its_own(fading: type[Method]) -> None:
    kind = started_anew("acts_recon.settings")["ReconstructionSettings"]
    assert describe(kind)["fading_memory_s"].maximum == 10.0
    given_but_unused = kind(fading_memory_s=0.2)
    assert given_but_unused.unused == ("fading_memory_s",)
    settings = kind(method="fading", fading_memory_s=0.2, touch_counts=30)
    assert settings.unused == ()
    recovery = settings.recovery()
    assert isinstance(recovery.method, fading)
    rows, cols = np.divmod(np.arange(1024, dtype=np.uint16), 32)
    press = np.where((np.abs(rows - 9.0) < 2) & (np.abs(cols - 20.0) < 2), 500, 0).astype(np.uint16)
    contact = recovery.step(np.arange(1024, dtype=np.uint16), press, 1.0, 0.01)
    geometry = ArrayGeometry()
    assert (contact.x_m, contact.y_m) == pytest.approx((float(geometry.x_m(20)), float(geometry.y_m(9))), abs=1e-4)
    assert (contact.active_taxels, contact.x_sd_m) == (9, 0.0)


def test_the_evaluation_knows_it_with_its_settings(fading: type[Method]) -> None:
    assert "fading" in method_names()
    method = method_named("fading")(SkinSetup(ArrayGeometry()), None, {"fading_memory_s": 0.02, "patch_step": 4})  # type: ignore[arg-type]
    assert isinstance(method, fading)
    frames = np.zeros((40, 32, 32), dtype=np.uint16)
    frames[5:, 10:14, 10:14] = 400
    recording = Recording(frames, 1000.0, np.ones((32, 32), dtype=bool))
    task = Task(SamplingConfig(scheme="tracking", m=64, threshold_counts=15), "fading", onset_s=0.0)
    result = evaluate([recording], task, None)  # type: ignore[arg-type]
    assert result["method"] == "fading"
    assert 0 < result["relative_error"] < 0.6


def test_two_things_with_a_parameter_of_one_name_are_refused(fading: type[Method], monkeypatch: Patch) -> None:
    class Other(fading):  # type: ignore[misc, valid-type]
        Config = type("OtherConfig", (fading.Config,), {})

    monkeypatch.setitem(METHODS, "other", Other)
    with pytest.raises(SettingsError, match=r"'fading_memory_s' is declared 2 times"):
        started_anew("acts_recon.settings")


def test_a_classifier_is_used_by_the_node_and_by_the_evaluation(monkeypatch: Patch, tmp_path: Path) -> None:
    names = module_of("A classifier")
    name = register(monkeypatch, "A classifier", CLASSIFIERS, names)
    rows, cols = np.indices((32, 32))
    discs = [np.where(np.hypot(rows - 15, cols - 15) < size, 600, 0).astype(np.uint16) for size in (3, 7)]
    save_object_library(build_object_library(discs, ["small", "large"], touch_counts=60), tmp_path / "objects.npz")
    kind = started_anew("acts_recon.settings")["ReconstructionSettings"]
    settings = kind(object_classifier=name, object_library=str(tmp_path / "objects.npz"), overlap_touch_counts=50)
    recovery = settings.recovery()
    recogniser = settings.recogniser(recovery)
    assert isinstance(recogniser, names["OverlapRecogniser"])
    everything = np.arange(1024, dtype=np.uint16)
    for disc, wanted in zip(discs, ("small", "large"), strict=True):
        recovery.reset()
        recovery.step(everything, disc.ravel(), 1.0, 0.01)
        found = recogniser.step(everything, disc.ravel(), 1.0, 0.01)
        assert recogniser.library.names[found.best] == wanted

    trials = Trials(arms=1, presses=1, columns=2, objects=tuple(map(object_named, ("circle", "glass_mug"))))
    results = run_trials(trials, (64,), (20,))
    assert list(results["over_m"]) == list(results["over_time"]) == ["paper", "acts", "overlap"]
    assert results["over_m"]["overlap"][0]["presses"] == 2


def test_a_protocol_is_a_choice_of_the_driver_and_decodes(monkeypatch: Patch) -> None:
    title = "Another board's protocol"
    name = register(monkeypatch, title, PROTOCOLS, module_of(title))
    kind = started_anew("acts_driver.settings")["DriverSettings"]
    assert f"{name} (a board of mine)" in describe(kind)["protocol"].description
    settings = kind(protocol=name, rows=2, cols=2)
    assert not settings.has_dialogue
    decoder = settings.make_decoder(lambda message: None)
    decoder.reset()
    assert decoder.feed(b"8,402;7,7,") == []
    frames = decoder.feed(b"7,7\n12,345678,9000;0,3,118,402\r\n13,354678,9000;0,3,118,1024\n14,363678,9000;1,2,3,4\n")
    assert [(frame.sequence, frame.board_us, frame.counts.tolist()) for frame in frames] == [
        (12, 345678, [0, 3, 118, 402]),
        (14, 363678, [1, 2, 3, 4]),
    ]
    assert (frames[0].duration_us, frames[0].scheme, frames[0].indices.tolist()) == (9000, Scheme.RASTER, [0, 1, 2, 3])
    assert (decoder.partial, decoder.malformed, decoder.frames) == (1, 1, 2)
    assert "needed are 4, 0 to 1023" in decoder.last_error


@given(pieces=st.lists(st.binary(max_size=60) | st.sampled_from([b"1,2,3;4,5,6,7\n", b"1,2,3;", b"4,\n", b";\r\n"])))
def test_its_decoder_takes_any_bytes(pieces: list[bytes]) -> None:
    decoder = module_of("Another board's protocol")["NumberedLines"](2, 2, lambda message: None)
    found = [frame for piece in pieces for frame in decoder.feed(piece)]
    assert decoder.frames == len(found)
    assert all(frame.counts.shape == (4,) and frame.counts.max() <= 1023 for frame in found)


def test_the_layout_is_one(tmp_path: Path) -> None:
    path = tmp_path / "two_fingers.yaml"
    path.write_text(code_of("A layout of a skin", "yaml"))
    arranged = layout(str(path), 16, 16)
    assert [(patch.name, patch.link) for patch in arranged.patches] == [
        ("left_tip", "left_finger"),
        ("right_tip", "right_finger"),
    ]
    matrix = np.arange(256, dtype=np.uint16).reshape(16, 16)
    # The right finger's wires come from the other side.
    np.testing.assert_array_equal(arranged.patches[1].of(arranged.picture(matrix)), matrix[:8, 15:7:-1])
    settings = started_anew("acts_recon.settings")["ReconstructionSettings"](layout=str(path), rows=16, cols=16)
    assert settings.skin().layout is not None


sys.path.insert(0, str(ROOT / "examples" / "ros"))
CONTROLLER = vars(importlib.import_module("contact_controller"))
sys.path.pop(0)


@given(
    steps=st.lists(
        st.tuples(
            st.floats(0, 1e6),
            st.floats(allow_nan=True, allow_infinity=True),
            st.floats(allow_nan=False, max_value=10.0),
        )
    )
)
def test_whatever_comes_in_the_controllers_speed_and_its_changes_stay_within_their_limits(
    steps: list[tuple[float, float, float]],
) -> None:
    settings = CONTROLLER["GiveWaySettings"]()
    behaviour = CONTROLLER["GiveWay"](settings)
    before = 0.0
    for force_n, age_s, dt_s in steps:
        speed = behaviour.step(force_n, age_s, dt_s)
        assert -settings.max_speed_m_s <= speed <= 0.0
        assert abs(speed - before) <= settings.max_acceleration_m_s2 * 0.02 + 1e-12
        before = speed


class Bench:
    """The controller, and a skin beside it that publishes contacts and hears speeds."""

    def __init__(self, domain_id: int, *words: str) -> None:
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain_id)
        arguments = ["--ros-args", *(part for word in words for part in ("-p", word))]
        try:
            self.node = CONTROLLER["GiveWayNode"](context=self.context, namespace="/plate", cli_args=arguments)
        except SettingsError:
            rclpy.try_shutdown(context=self.context)
            raise
        self.skin = Node("skin", namespace="/plate", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        for node in (self.node, self.skin):
            self.executor.add_node(node)
        self.publisher = self.skin.create_publisher(Contact, "contact", STREAM)
        self.heard: list[TwistStamped] = []
        self.skin.create_subscription(TwistStamped, "twist", self.heard.append, STATE)
        self.until(lambda: self.publisher.get_subscription_count() == 1 and bool(self.heard))

    def until(self, condition: Callable[[], bool], force_n: float | None = None, age_s: float = 0.0) -> None:
        """Go on until something is the case, with a contact each round where there is a force."""

        def turn() -> None:
            if force_n is not None:
                sec, nanosec = divmod(time.time_ns() - int(age_s * 1e9), 1_000_000_000)
                contact = Contact(in_contact=True, force=force_n)
                contact.header.frame_id = "plate"
                contact.header.stamp.sec, contact.header.stamp.nanosec = sec, nanosec
                self.publisher.publish(contact)
            self.executor.spin_once(timeout_sec=0.01)

        wait_for(condition, "", DEADLINE_S, turn, lambda: f"the last speed is {self.speed()}")

    def speed(self) -> float:
        """The last speed that was heard [m/s]."""
        return float(self.heard[-1].twist.linear.z) if self.heard else 0.0

    def rounds(self, number: int) -> Callable[[], bool]:
        """Whether so many more speeds have been heard."""
        wanted = len(self.heard) + number
        return lambda: len(self.heard) >= wanted

    def close(self) -> None:
        self.executor.shutdown()
        self.node.destroy_node()
        self.skin.destroy_node()
        rclpy.try_shutdown(context=self.context)


@pytest.fixture
def bench() -> Iterator[Bench]:
    # A machine that is busy holds contacts up; that is not what is tested here.
    bench = Bench(25, "touch_stale_after_s:=0.5", "max_acceleration_m_s2:=10.0")
    yield bench
    bench.close()


def test_the_controller_gives_way_while_it_is_pushed_and_stops_where_touch_is_stale(bench: Bench) -> None:
    assert bench.speed() == 0.0
    bench.until(lambda: bench.speed() == pytest.approx(-0.04), force_n=5.0)
    assert bench.heard[-1].header.frame_id == "plate"
    bench.until(lambda: bench.speed() == pytest.approx(-0.1), force_n=1000.0)
    # Light touch, and then none at all: the motion ends each time.
    bench.until(lambda: bench.speed() == 0.0, force_n=0.5)
    bench.until(lambda: bench.speed() < 0.0, force_n=5.0)
    bench.until(lambda: bench.speed() == 0.0)
    bench.until(bench.rounds(10), force_n=5.0, age_s=2.0)
    assert bench.speed() == 0.0


def test_what_is_no_number_never_moves_it_and_it_ends_standing_still(bench: Bench) -> None:
    bench.until(bench.rounds(20), force_n=float("nan"))
    bench.until(bench.rounds(20), force_n=float("inf"))
    assert not any(message.twist.linear.z for message in bench.heard)
    assert bench.node._refused > 0
    bench.until(lambda: bench.speed() < 0.0, force_n=5.0)
    bench.node.close()
    bench.executor.remove_node(bench.node)
    bench.until(lambda: bench.speed() == 0.0)


def test_a_misspelt_parameter_of_the_controller_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"'max_speed'.*did you mean 'max_speed_m_s'"):
        Bench(25, "max_speed:=0.2")
