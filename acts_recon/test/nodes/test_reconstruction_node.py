# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node over real DDS; ROS_DOMAIN_IDs 28, 40 to 42, 44, 110 to 112 and 191."""

import os
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from contact_reference import find_contact
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from numpy.typing import NDArray
from rclpy.parameter import Parameter
from recon_bench import Bench, Listener, publisher_of, timed
from recon_samples import bump, sample
from sensor_msgs.msg import Image

from acts_core.array import ArrayGeometry
from acts_core.errors import REFUSED_EXIT_CODE, ArrayError, DictionaryError, ObjectLibraryError, SettingsError
from acts_core.skin import ForceResponse, layout
from acts_msgs.msg import Contact
from acts_recon.frame_pipeline import FramePipeline
from acts_recon.fusion import FusionEstimator
from acts_recon.nodes import reconstruction_node
from acts_recon.nodes.images_publisher import ImagesPublisher
from acts_recon.settings import ReconstructionSettings
from acts_recon.sparse import Dictionary, Reconstructor
from acts_ros import qos

pytestmark = pytest.mark.slow


def test_rates_of_images_change_while_it_runs(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(191)
    images = publisher_of(bench.node, ImagesPublisher)
    parameters = {"image_raw_rate_hz": 20.0, "image_rate_hz": 5.0, "image_full_scale_counts": 500.0}
    results = bench.node.set_parameters([Parameter(name, value=value) for name, value in parameters.items()])
    assert all(result.successful for result in results)
    assert [limit.due(0.0) for limit in (images._raw_limit, bench.node._view_limit)] == [True, True]
    assert not images._raw_limit.due(0.049)
    assert images._raw_limit.due(0.051)
    assert not bench.node._view_limit.due(0.199)
    assert bench.node._view_limit.due(0.201)
    for refused in (Parameter("image_rate_hz", value=0.0), Parameter("rows", value=16)):
        assert not bench.node.set_parameters([refused])[0].successful


def test_diagnostics_say_that_it_compiles_while_it_does(
    make_peers: Callable[..., Listener], monkeypatch: pytest.MonkeyPatch
) -> None:
    peers = make_peers(191)
    told: list[DiagnosticArray] = []
    peers.peer.create_subscription(DiagnosticArray, "/diagnostics", told.append, 10)

    def compiles_for_long(*arguments: Any) -> FramePipeline:
        peers.until(lambda: bool(told))
        return FramePipeline(*arguments)

    monkeypatch.setattr(reconstruction_node, "FramePipeline", compiles_for_long)
    peers.add(reconstruction_node.ReconstructionNode(cli_args=[], context=peers.context, namespace="/plate"))
    (status,) = told[0].status
    assert status.name == "plate/reconstruction"
    assert status.message.startswith("compiling")


def test_contact_cop_and_images_are_those_of_the_samples(
    make_bench: Callable[..., Bench], dictionary: Dictionary
) -> None:
    bench = make_bench(40, method="per_frame", image_scale=4, image_rate_hz=1000.0)
    images = publisher_of(bench.node, ImagesPublisher)
    bench.listen(PointStamped, "cop", qos.STREAM)
    bench.listen(Image, "image_raw", qos.STREAM)
    bench.listen(Image, "image", qos.VIEW)
    bench.until(lambda: bench.node._send_cop and images._send_raw and "image" in images.viewed)

    reconstructor = Reconstructor(ArrayGeometry(), dictionary)
    frame = sample(bump(ArrayGeometry(), 20.2, 11.7), 55)
    expected = find_contact(reconstructor.recover(*frame), ArrayGeometry(), ForceResponse())
    bench.send(3, *frame)
    contact = bench.contact(3)
    assert contact.header.frame_id == "plate"
    assert (contact.header.stamp.sec, contact.header.stamp.nanosec) == (103, 7)
    assert contact.in_contact
    assert contact.centre_of_pressure.x == pytest.approx(expected.x_m)
    assert contact.centre_of_pressure.y == pytest.approx(expected.y_m)
    assert contact.centre_of_pressure.z == 0
    assert contact.force == pytest.approx(expected.force_n, rel=1e-6)
    assert contact.peak == expected.peak_counts
    assert contact.area == pytest.approx(expected.area_m2, rel=1e-6)
    assert contact.active_taxels == expected.active_taxels
    assert contact.spread == pytest.approx(expected.spread_m, rel=1e-6)
    assert contact.centre_of_pressure_sigma.x == contact.force_sigma == contact.spread_sigma == 0

    bench.until(lambda: all(bench.received[topic] for topic in ("cop", "image_raw", "image")))
    (cop,) = bench.received["cop"]
    assert cop.header == contact.header
    assert cop.point == contact.centre_of_pressure
    (raw,) = bench.received["image_raw"]
    assert raw.header == contact.header
    assert (raw.height, raw.width, raw.encoding, raw.step, raw.is_bigendian) == (32, 32, "mono16", 64, 0)
    pixels = np.frombuffer(raw.data, dtype="<u2").reshape(32, 32)
    assert np.abs(pixels - reconstructor.image).max() <= 0.5
    (view,) = bench.received["image"]
    assert view.header == contact.header
    assert (view.height, view.width, view.encoding, view.step) == (128, 128, "rgb8", 384)
    assert len(view.data) == 128 * 384

    # Untouched: a contact message that says so, and no centre of pressure.
    bench.send(4, frame[0], np.zeros(55))
    assert bench.contact(4) == Contact(header=bench.contact(4).header, sequence=4)
    bench.until(lambda: len(bench.received["image_raw"]) == 2)
    assert len(bench.received["cop"]) == 1


def test_fusion_keeps_what_earlier_frames_showed_and_says_how_sure_it_is(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(110, layout="glove")
    images = publisher_of(bench.node, ImagesPublisher)
    bench.listen(Image, "image_raw", qos.STREAM)
    bench.listen(Image, "confidence", qos.STREAM)
    bench.until(lambda: images._send_raw and images._send_confidence)

    glove = layout("glove")
    geometry = glove.geometry()
    picture = bump(geometry, 20.2, 11.7)
    matrix = glove.matrix(picture).ravel()
    estimator = FusionEstimator(geometry, layout=glove)
    order = np.random.default_rng(6).permutation(1024)
    for k in range(15):
        indices = order[55 * k : 55 * k + 55]
        end_s = 100 + k * 1e-3
        estimator.step(indices.astype(np.uint16), matrix[indices].astype(np.uint16), end_s, 983_235e-9)
        bench.send(k, indices, matrix[indices], **timed(k))
    contact = bench.contact(14)
    expected = find_contact(estimator.image, geometry, ForceResponse(), touch_counts=60, sigma=estimator.sigma)
    assert contact.in_contact
    assert contact.centre_of_pressure_sigma.x == pytest.approx(expected.x_sd_m, rel=1e-2) != 0
    assert contact.centre_of_pressure_sigma.y == pytest.approx(expected.y_sd_m, rel=1e-2) != 0
    assert contact.centre_of_pressure_sigma.z == 0
    assert contact.force_sigma == pytest.approx(expected.force_sd_n, rel=1e-2) != 0
    assert contact.area_sigma == pytest.approx(expected.area_sd_m2, rel=1e-2) != 0
    assert contact.spread_sigma == pytest.approx(expected.spread_sd_m, rel=1e-2) != 0
    assert contact.active_taxels == expected.active_taxels
    assert contact.centre_of_pressure.x == pytest.approx(expected.x_m, abs=1e-5)
    assert contact.force == pytest.approx(expected.force_n, rel=1e-3)
    bench.until(lambda: len(bench.received["image_raw"]) == len(bench.received["confidence"]) == 15)
    raw, confidence = bench.received["image_raw"][-1], bench.received["confidence"][-1]
    assert raw.header == confidence.header == contact.header
    pixels = np.frombuffer(raw.data, dtype="<u2").reshape(32, 32)
    assert np.abs(pixels - estimator.image).max() <= 1
    assert (confidence.height, confidence.width, confidence.encoding, confidence.step) == (32, 32, "mono8", 32)
    sure = np.frombuffer(confidence.data, dtype=np.uint8).reshape(32, 32).astype(int)
    assert np.abs(sure - estimator.confidence()).max() <= 1
    assert sure.min() < 5
    assert sure.max() > 250


@pytest.mark.parametrize(
    ("domain_id", "sequence", "time_ms"),
    [
        pytest.param(111, 3, 1002, id="dropout"),
        pytest.param(112, 0, 2, id="restart"),
    ],
)
def test_a_dropout_and_a_restart_of_the_board_begin_anew(
    make_bench: Callable[..., Bench], domain_id: int, sequence: int, time_ms: int
) -> None:
    bench = make_bench(domain_id)
    pressed = bump(ArrayGeometry(), 20.2, 11.7).ravel()
    everything, corner = np.arange(1024), np.arange(10)
    bench.send(1, everything, pressed, **timed(0))
    bench.send(2, corner, pressed[corner], **timed(1))
    assert bench.contact(1).in_contact
    assert bench.contact(2).active_taxels == bench.contact(1).active_taxels
    bench.send(sequence, corner, pressed[corner], **timed(time_ms))
    assert not bench.contact(sequence).in_contact


def test_images_and_contacts_are_those_of_the_layout(make_bench: Callable[..., Bench], dictionary: Dictionary) -> None:
    bench = make_bench(28, method="per_frame", layout="insole", image_scale=2, image_rate_hz=1000.0)
    images = publisher_of(bench.node, ImagesPublisher)
    bench.listen(Image, "image_raw", qos.STREAM)
    bench.listen(Image, "image", qos.VIEW)
    bench.until(lambda: images._send_raw and "image" in images.viewed)

    insole = layout("insole")
    geometry = insole.geometry()
    picture = bump(geometry, 50.0, 5.0, width=2.0)
    matrix = insole.matrix(picture).ravel()
    indices = np.random.default_rng(5).permutation(1024)[:600]
    bench.send(1, indices, matrix[indices])
    contact = bench.contact(1)
    # In the frame of the sole, 85 mm x 280 mm: right and up of its middle are positive.
    assert contact.centre_of_pressure.x == pytest.approx((5.0 - 7.5) * 0.085 / 16, abs=5e-4)
    assert contact.centre_of_pressure.y == pytest.approx((31.5 - 50.0) * 0.280 / 64, abs=5e-4)

    bench.until(lambda: bool(bench.received["image_raw"] and bench.received["image"]))
    (raw,) = bench.received["image_raw"]
    assert (raw.height, raw.width, raw.step) == (64, 16, 32)
    pixels = np.frombuffer(raw.data, dtype="<u2").reshape(64, 16)
    measured = np.isin(insole.taxels, indices)
    assert np.array_equal(pixels[measured], np.where(picture > 60, picture, 0)[measured])
    (view,) = bench.received["image"]
    assert (view.height, view.width) == (128, 32)


def test_bad_messages_are_dropped_and_counted_and_nothing_else_is_lost(
    make_bench: Callable[..., Bench], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = make_bench(41)
    indices, counts = sample(bump(ArrayGeometry(), 5, 5), 55)
    out_of_range, too_high, twice = indices.copy(), counts.copy(), indices.copy()
    out_of_range[-1], too_high[0], twice[0] = 1024, 1024, twice[1]
    bad: list[tuple[NDArray, NDArray, dict[str, int]]] = [
        (indices, counts[:-1], {}),
        (out_of_range, counts, {}),
        (indices, too_high, {}),
        (twice, counts, {}),
        (indices[:0], counts[:0], {}),
        (indices, counts, {"rows": 16}),
        (indices, counts, {"cols": 33}),
    ]
    sequence = 0
    for indices_sent, counts_sent, fields in bad:
        bench.send(sequence, indices_sent, counts_sent, **fields)
        bench.send(sequence + 1, indices, counts)
        sequence += 2
    bench.until(lambda: len(bench.received["contact"]) == len(bad))
    assert [message.sequence for message in bench.received["contact"]] == list(range(1, sequence, 2))
    assert all(message.in_contact for message in bench.received["contact"])
    bench.diagnostics(
        lambda status, values: (
            values["rejected.bad_frame"] == "5"
            and values["rejected.wrong_array_size"] == "2"
            and values["frames"] == "7"
            # Those of another array are not counted among this one's.
            and values["lost"] == "2"
        )
    )
    # In one report or, on a slow machine, in several; all came with or before that one.
    told = [status for message in bench.received["/diagnostics"] for status in message.status]
    dropped = [one for one in told if " dropped that do" in one.message]
    assert {one.level for one in dropped} == {b"\x01"}
    assert sum(int(one.message.split()[0]) for one in dropped) == 7
    # The log has each kind, though they came within a moment.
    log = capfd.readouterr().err
    assert "samples dropped: 55 indices and 54 counts" in log
    assert "samples dropped: frame of 16 x 32 taxels, expected are 32 x 32 by the parameters rows and cols" in log


def test_samples_that_come_twice_are_dropped_and_told(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(42)
    indices, counts = np.arange(55), np.full(55, 500)
    for sequence in (0, 1, 1, 2):
        bench.send(sequence, indices, counts)
    bench.contact(2)
    assert [message.sequence for message in bench.received["contact"]] == [0, 1, 2]
    bench.diagnostics(lambda _, values: (values["rejected.repeated"], values["lost"]) == ("1", "0"))


def test_a_second_publisher_of_contacts_is_told(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(42)
    bench.peer.create_publisher(Contact, "contact", qos.STREAM)
    words = "/plate/contact has 2 publishers (/plate/"
    bench.diagnostics(lambda status, _: status.level == b"\x01" and words in status.message)


def test_frames_lost_are_counted_over_the_wrap_and_not_over_a_restart(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(42)
    indices = np.arange(10)
    for sequence in (2**32 - 1, 2, 3, 0):  # lost: 0 and 1; then the board begins anew
        bench.send(sequence, indices, indices, header=Contact().header)
    bench.until(lambda: len(bench.received["contact"]) == 4)
    words = "2 frames lost before they came here"
    bench.diagnostics(lambda status, _: status.level == b"\x01" and status.message.startswith(words))
    bench.diagnostics(
        lambda status, values: (
            (status.level, status.message) == (b"\x01", "no samples")
            and (values["frames"], values["lost"]) == ("4", "2")
        )
    )


def test_frames_of_two_boards_that_mix_are_not_lost(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(42)
    indices = np.arange(10)
    for step in range(20):
        for first in (1000, 500_000):
            bench.send(first + step, indices, indices)
    bench.until(lambda: len(bench.received["contact"]) == 40)
    bench.diagnostics(lambda status, values: values["frames"] == "40" and values["lost"] == "0")
    words = "frames of two sources come in turn"
    bench.diagnostics(lambda status, _: status.level == b"\x01" and status.message.startswith(words))


def test_frames_whose_numbers_stand_still_are_told(make_bench: Callable[..., Bench]) -> None:
    """As of a node that leaves them 0: all that the frames before have shown was forgotten, without a word."""
    bench = make_bench(42)
    indices = np.arange(10)
    for step in range(20):
        bench.send(0, indices + 10 * step, indices, **timed(step))
    bench.until(lambda: len(bench.received["contact"]) == 20)
    bench.diagnostics(lambda status, values: (values["frames"], values["restarts"]) == ("20", "19"))
    words = "with a number that is not above that of the frame before"
    bench.diagnostics(lambda status, _: status.level == b"\x01" and words in status.message)


@pytest.mark.parametrize(
    ("parameters", "error", "word"),
    [
        ({"method": "guess"}, SettingsError, "method = 'guess'"),
        (
            {"method": "per_frame", "dictionary": "/no/such/file.npz"},
            DictionaryError,
            "/no/such/file.npz: cannot be read",
        ),
        ({"method": "per_frame", "dictionary": __file__}, DictionaryError, "not an npz file"),
        ({"dictionary": "/no/such/file.npz"}, SettingsError, "file.npz.*the method fusion uses none"),
        ({"object_library": "/no/such/objects.npz"}, ObjectLibraryError, "/no/such/objects.npz: cannot be read"),
        ({"object_columns": 1025}, SettingsError, "object_columns = 1025"),
        ({"method": "per_frame", "rows": 7}, ArrayError, "do not fit a side of 7"),
        ({"layout": "sock"}, ArrayError, "layout 'sock': allowed is one of square"),
        ({"layout": "/dev/zero"}, SettingsError, "/dev/zero: not a regular file"),
        ({"layout": "glove", "rows": 16}, ArrayError, "16 x 32.*set rows to 32"),
        ({"touch_count": 60}, SettingsError, "'touch_count'.*'touch_counts'"),
        ({"touch_counts": 1024}, SettingsError, "touch_counts = 1024"),
        ({"image_rate_hz": "fast"}, SettingsError, "image_rate_hz = 'fast'"),
        ({"force_half_n": ".nan"}, SettingsError, "force_half_n"),
        ({"regions_slip_rate_hz": 1.9}, SettingsError, "regions_slip_rate_hz = 1.9: allowed are 0.* and 2 and more"),
        ({"force_response": "/no/response.csv"}, SettingsError, "/no/response.csv: cannot be read"),
    ],
)
def test_wrong_parameters_are_refused_at_start(
    make_bench: Callable[..., Bench], parameters: dict[str, object], error: type[Exception], word: str
) -> None:
    with pytest.raises(error, match=word):
        make_bench(44, **parameters)


def test_what_the_method_does_not_use_is_known_by_name() -> None:
    assert ReconstructionSettings().unused == ()
    assert ReconstructionSettings(patch_step=2, keep_measured=False).unused == ("patch_step", "keep_measured")
    assert ReconstructionSettings(method="per_frame", patch_step=2, object_src_weight=0.5).unused == (
        "object_src_weight",
    )


def test_the_program_ends_with_one_line_and_its_exit_code() -> None:
    command = [sys.executable, "-m", "acts_ros.executables.program", "acts_recon.nodes.reconstruction_node"]
    environment = {**os.environ, "ROS_DOMAIN_ID": "44"}
    result = subprocess.run(
        [*command, "--ros-args", "-p", "dictionary:=/no/such.npz", "-p", "method:=per_frame"],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert result.returncode == REFUSED_EXIT_CODE
    assert "error: /no/such.npz: cannot be read" in result.stderr
    assert "Traceback" not in result.stderr
