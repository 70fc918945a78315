# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics object and view/object over real DDS, by both methods; ROS_DOMAIN_IDs 45 and 125 to 127."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_bench import Bench, publisher_of, timed
from recon_samples import bump, sample

from acts_core.array import ArrayGeometry
from acts_core.errors import ObjectLibraryError
from acts_core.skin import layout
from acts_msgs.msg import ObjectClass
from acts_recon.fusion import FusionEstimator
from acts_recon.nodes.object_publisher import ObjectPublisher
from acts_recon.objects import (
    Classification,
    Classifier,
    ClassifierConfig,
    ImageClassifier,
    ImageClassifierConfig,
    ObjectLibrary,
    build_object_library,
    save_object_library,
)
from acts_ros import qos

GEOMETRY = ArrayGeometry()
PLACES = {"high": (6.0, 16.0), "low": (25.0, 16.0)}


@pytest.fixture
def library_path(tmp_path: Path) -> Path:
    save_object_library(library_of([bump(GEOMETRY, *place) for place in PLACES.values()]), tmp_path / "objects.npz")
    return tmp_path / "objects.npz"


def library_of(frames: list[NDArray[np.uint16]]) -> ObjectLibrary:
    return build_object_library(frames, list(PLACES))


def listen(bench: Bench) -> None:
    bench.listen(ObjectClass, "object", qos.STREAM)
    bench.until(lambda: publisher_of(bench.node, ObjectPublisher).is_wanted)


def test_per_frame_the_object_is_the_one_of_the_samples(make_bench: Callable[..., Bench], library_path: Path) -> None:
    bench = make_bench(45, method="per_frame", object_library=library_path, object_columns=2)
    listen(bench)
    library = library_of([bump(GEOMETRY, *place) for place in PLACES.values()])
    indices, counts = sample(bump(GEOMETRY, 25.5, 16.0, width=2.0), 55)
    expected = Classifier(library, ClassifierConfig(max_columns=2)).step(indices, counts)
    bench.send(7, indices, counts)
    bench.send(8, indices, np.zeros(55))
    bench.until(lambda: len(bench.received["object"]) == 2)
    pressed, untouched = bench.received["object"]
    assert pressed.header.frame_id == "plate"
    assert (pressed.header.stamp.sec, pressed.sequence) == (107, 7)
    assert (pressed.class_number, pressed.name) == (library.names.index("low"), "low")
    assert pressed.residuals.tolist() == pytest.approx(expected.residuals.tolist())
    assert pressed.confidence == pytest.approx(expected.confidence)
    assert untouched == ObjectClass(
        header=untouched.header, sequence=8, class_number=ObjectClass.NO_OBJECT, residuals=[1.0, 1.0]
    )


@pytest.mark.parametrize(("domain_id", "skin"), [(125, "square"), (126, "insole")])
def test_fused_the_object_is_the_one_of_the_image(
    make_bench: Callable[..., Bench], tmp_path: Path, domain_id: int, skin: str
) -> None:
    arranged = layout(skin)
    geometry = arranged.geometry()
    # A library is of the matrix, whatever the layout.
    known = [arranged.matrix(bump(geometry, 8 + 10 * k, 7.0, width=2.0 + k)).astype(np.uint16) for k in (0, 1)]
    library = library_of(known)
    save_object_library(library, tmp_path / "objects.npz")
    bench = make_bench(
        domain_id, layout=skin, object_library=tmp_path / "objects.npz", object_touch_counts=20, object_src_weight=1.0
    )
    listen(bench)

    estimator = FusionEstimator(geometry, layout=arranged)
    config = ImageClassifierConfig(touch_counts=20, src_weight=1.0)
    classifier = ImageClassifier(library, config)
    pressed = arranged.matrix(bump(geometry, 18.3, 7.2, width=2.9)).ravel()
    order = np.random.default_rng(6).permutation(1024)
    expected = []
    for k in range(18):
        indices = order[55 * k : 55 * k + 55].astype(np.uint16)
        counts = pressed[indices].astype(np.uint16)
        estimator.step(indices, counts, 100 + k * 1e-3, 983_235e-9)
        image, sigma, age_s = (
            np.ascontiguousarray(arranged.matrix(field), dtype=np.float32)
            for field in (estimator.image, estimator.sigma, estimator.age_s)
        )
        result = classifier.step(image, sigma, age_s, 1e-3 if k else 983_235e-9)
        expected.append((result.touched, result.best, result.residuals.tolist()))
        bench.send(k, indices, counts, **timed(k))
    bench.until(lambda: len(bench.received["object"]) == 18)
    for message, (touched, best, residuals) in zip(bench.received["object"], expected, strict=True):
        assert message.class_number == (best if touched else ObjectClass.NO_OBJECT)
        assert message.residuals.tolist() == pytest.approx(residuals, abs=2e-3)
    last = bench.received["object"][-1]
    assert (last.sequence, last.name) == (17, "low")
    assert last.residuals[last.class_number] < 0.5 * max(last.residuals)

    # The board begins anew: what pressed before is forgotten.
    corner = np.arange(10)
    bench.send(0, corner, np.zeros(10), **timed(18))
    bench.until(lambda: len(bench.received["object"]) == 19)
    assert bench.received["object"][-1].class_number == ObjectClass.NO_OBJECT


@pytest.mark.parametrize("method", ["fusion", "per_frame"])
def test_the_topic_keeps_its_rate(make_bench: Callable[..., Bench], library_path: Path, method: str) -> None:
    bench = make_bench(127, method=method, object_library=library_path, object_rate_hz=0.1)
    listen(bench)
    everything, pressed = np.arange(1024), bump(GEOMETRY, *PLACES["low"]).ravel()
    for k in range(20):
        bench.send(k, everything, pressed, **timed(20 * k))
    bench.contact(19)
    bench.until(lambda: bool(bench.received["object"]))
    assert [(message.sequence, message.name) for message in bench.received["object"]] == [(0, "low")]


def test_frames_that_are_not_classified_are_not_forgotten(
    make_bench: Callable[..., Bench], library_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(127, object_library=library_path, object_rate_hz=0.1)
    listen(bench)
    objects = publisher_of(bench.node, ObjectPublisher)
    ends_s: dict[str, list[float]] = {"update": [], "step": []}
    resets = []

    def noted(name: str) -> Callable[..., Any]:
        method = getattr(objects._recogniser, name)

        def call(*samples: Any) -> Any:
            ends_s[name].append(samples[2])
            return method(*samples)

        return call

    for name in ends_s:
        monkeypatch.setattr(objects._recogniser, name, noted(name))
    monkeypatch.setattr(objects._recogniser, "reset", lambda: resets.append(True))
    everything, pressed = np.arange(1024), bump(GEOMETRY, *PLACES["low"]).ravel()
    for k in range(5):
        bench.send(k, everything, pressed, **timed(20 * k))
        # Whether somebody still listens is looked at again and again.
        bench.node._look_for_subscribers()
    assert ends_s == {"step": [100.0], "update": pytest.approx([100.02, 100.04, 100.06, 100.08])}
    assert not resets
    objects.is_wanted = False
    bench.node._look_for_subscribers()
    assert resets == [True]


def test_for_viewers_no_more_frames_are_classified_than_they_are_told_of(
    make_bench: Callable[..., Bench], library_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(127, object_library=library_path, image_rate_hz=0.1)
    bench.listen(ObjectClass, "view/object", qos.VIEW)
    objects = publisher_of(bench.node, ObjectPublisher)
    bench.until(lambda: bool(objects.viewed))
    steps, step = [0], objects._recogniser.step

    def counted(*samples: Any) -> Classification:
        steps[0] += 1
        return step(*samples)

    monkeypatch.setattr(objects._recogniser, "step", counted)
    # Where the frame at which they are due is none that is classified, they are told of the next one.
    allowed = iter([False, True])
    monkeypatch.setattr(objects._limit, "due", lambda _: next(allowed))
    everything, pressed = np.arange(1024), bump(GEOMETRY, *PLACES["low"]).ravel()
    for k in range(20):
        bench.send(k, everything, pressed, **timed(20 * k))
    bench.until(lambda: bool(bench.received["view/object"]))
    assert [(message.sequence, message.name) for message in bench.received["view/object"]] == [(1, "low")]
    assert steps == [1]


@pytest.mark.parametrize("method", ["fusion", "per_frame"])
def test_a_library_of_another_array_is_refused_at_start(
    make_bench: Callable[..., Bench], library_path: Path, method: str
) -> None:
    with pytest.raises(ObjectLibraryError, match="made for an array of 32 x 32; this one has 16 x 32"):
        make_bench(127, method=method, rows=16, object_library=library_path)
