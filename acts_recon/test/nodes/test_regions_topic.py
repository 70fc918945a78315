# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic regions over real DDS; ROS_DOMAIN_IDs 212 and 213."""

from collections import Counter
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from rclpy.parameter import Parameter
from recon_bench import Bench, publisher_of, timed

from acts_core.skin import ForceResponse, layout
from acts_msgs.msg import RegionContacts
from acts_recon.nodes.frame_publisher import TopicPublisher
from acts_recon.nodes.impacts_publisher import ImpactsPublisher
from acts_recon.nodes.outlines_publisher import OutlinesPublisher
from acts_recon.nodes.regions_publisher import RegionsPublisher
from acts_recon.nodes.spectra_publisher import SpectraPublisher
from acts_recon.regions import Regions
from acts_ros import qos
from acts_ros.messages import read_regions

HAND = layout("leap_right")


def pressed(moved: float = 0.0) -> np.ndarray:
    """Counts by matrix taxel: a round contact on the palm, and one on the tip of the index finger."""
    picture = np.zeros((HAND.rows, HAND.cols))
    for name, row, col in (("palm", 8.0, 7.0), ("index_distal", 4.0, 3.0 + moved)):
        patch = next(patch for patch in HAND.patches if patch.name == name)
        rows, cols = np.indices((patch.rows, patch.cols))
        patch.of(picture)[:] = 600 * np.exp(-((rows - row) ** 2 + (cols - col) ** 2) / 4)
    return np.rint(HAND.matrix(picture)).astype(np.uint16).ravel()


def test_regions_are_those_of_the_image_while_somebody_listens(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(212, layout="leap_right", regions_slip_rate_hz=0.0)
    everywhere = np.arange(1024)
    bench.send(0, everywhere, pressed(), **timed(0))
    bench.contact(0)
    publisher = publisher_of(bench.node, RegionsPublisher)
    assert not publisher.is_wanted
    raw: list[bytes] = []
    bench.peer.create_subscription(RegionContacts, "regions", raw.append, qos.STREAM, raw=True)
    bench.listen(RegionContacts, "regions", qos.STREAM)
    bench.until(lambda: publisher.is_wanted)

    for k in range(1, 36):
        bench.send(k, everywhere, pressed(0.06 * max(k - 25, 0)), **timed(3 * k))
        bench.contact(k)
    bench.until(lambda: len(raw) == len(bench.received["regions"]) == 35)
    last = bench.received["regions"][-1]
    assert last.header.frame_id == "plate"
    assert (last.header.stamp.sec, last.header.stamp.nanosec, last.sequence) == (100, 105_000_000, 35)
    fields = read_regions(raw[-1])
    assert (fields.stamp_ns, fields.frame_id, fields.sequence) == (100_105_000_000, "plate", 35)
    assert [region.name for region in fields.regions] == [patch.name for patch in HAND.patches]
    assert [region.name for region in fields.regions if region.in_contact] == ["palm", "index_distal"]
    assert [region.name for region in fields.regions if region.slipping] == ["index_distal"]
    first = read_regions(raw[0])
    assert not any(region.slipping for region in first.regions)
    # The same as the plain class makes of the image.
    expected = Regions(HAND, ForceResponse()).step(1.0, bench.node._recovery.image)
    for found, wanted in zip(fields.regions, expected, strict=True):
        assert found[:3] == wanted[:3]
        assert found.force_n == pytest.approx(wanted.force_n)
        assert found.centre_m == pytest.approx(wanted.centre_m)

    assert bench.node.set_parameters([Parameter("regions_rate_hz", value=0.1)])[0].successful
    for k in range(36, 42):
        bench.send(k, everywhere, pressed(), **timed(3 * k))
        bench.contact(k)
    assert len(raw) <= 36


def test_each_topic_forgets_the_frames_before_nobody_listened_and_before_the_board_began_anew(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(212, layout="leap_right", impacts=True, spectra=True, outlines=True)
    node = bench.node
    kept: dict[str, object] = {
        "regions": publisher_of(node, RegionsPublisher)._regions,
        "impacts": publisher_of(node, ImpactsPublisher)._detector,
        "spectra": publisher_of(node, SpectraPublisher)._analyser,
        "outlines": publisher_of(node, OutlinesPublisher)._tracer,
    }
    forgotten: Counter[str] = Counter()
    for name, one in kept.items():
        monkeypatch.setattr(one, "reset", partial(forgotten.update, [name]))
    bench.take(10, np.zeros((32, 32)))
    assert not forgotten
    bench.take(5, np.zeros((32, 32)))
    assert forgotten == dict.fromkeys(kept, 1)
    parts = [part for part in node._parts if isinstance(part, TopicPublisher)]
    listeners = 0
    for part in parts:
        monkeypatch.setattr(part._publisher, "get_subscription_count", lambda: listeners)
    for again in (2, 3):
        listeners = 1
        bench.until(lambda: all(part.is_wanted for part in parts))
        # While they go on listening nothing is.
        node._look_for_subscribers()
        assert forgotten == dict.fromkeys(kept, again)
        listeners = 0
        node._look_for_subscribers()
        assert not any(part.is_wanted for part in parts)


def test_a_skin_of_one_patch_on_no_link_has_no_regions(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(213)
    assert not any(isinstance(one, RegionsPublisher) for one in bench.node._parts)
    names = [name for name, _ in bench.peer.get_topic_names_and_types()]
    assert "/plate/contact" in names
    assert "/plate/regions" not in names
