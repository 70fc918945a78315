# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic spectra over real DDS; ROS_DOMAIN_ID 20."""

from collections.abc import Callable
from concurrent.futures import Future
from itertools import count
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_bench import DEADLINE_S, FIRST_NS, Bench, publisher_of
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_core.skin import ForceResponse
from acts_msgs.msg import Spectrum
from acts_recon import spectra as analysed
from acts_recon.nodes import spectra_publisher
from acts_recon.nodes.spectra_publisher import SpectraPublisher
from acts_ros import qos
from acts_ros.messages import ns_of

GEOMETRY = ArrayGeometry()
RESPONSE = ForceResponse()


def counts_of(sequence: int) -> NDArray[np.floating]:
    """Something that vibrates at 90 Hz."""
    still = RESPONSE.force_n(bump(GEOMETRY, 15.0, 12.0))
    return RESPONSE.counts((1 + 0.1 * np.cos(2 * np.pi * 0.09 * sequence)) * still)


def test_the_node_tells_how_a_contact_vibrates_while_somebody_listens(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=0.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.take(0, counts_of(0))
    assert not spectra._analyser._frames
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    for sequence in range(1, 200):
        bench.take(sequence, counts_of(sequence))
    told = bench.received["spectra"]
    sequences = count(200)

    def take_another() -> None:
        # What is made beside is published with a frame after it.
        sequence = next(sequences)
        bench.take(sequence, counts_of(sequence))

    bench.until(lambda: bool(told), take_another)
    first = told[0]
    assert (first.header.frame_id, first.contact, first.contacts) == ("plate", 0, 1)
    assert (first.header.stamp.sec, first.header.stamp.nanosec) == (1_700_000_000, 1_000_000 * first.sequence)
    assert first.duration == pytest.approx(0.1, abs=0.01)
    assert first.sample_rate == pytest.approx(1000, rel=1e-3)
    assert first.position.x == pytest.approx(float(GEOMETRY.x_m(12.0)), abs=1e-3)
    assert first.peak_frequency[0] == pytest.approx(90, abs=0.5)
    assert 0 < first.peak_frequency_sigma[0] < 0.5
    assert first.peak_amplitude[0] == pytest.approx(0.1 * first.force, rel=0.05)
    assert 0 < first.peak_amplitude_sigma[0] < first.peak_amplitude[0]
    assert np.argmax(first.amplitude) * first.step == pytest.approx(90, abs=2)


def test_of_several_contacts_each_has_a_spectrum_with_its_number(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=0.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    places = ((6.0, 8.0), (24.0, 26.0))
    pressed = np.maximum(*(bump(GEOMETRY, row, col) for row, col in places))
    for sequence in range(1, 200):
        bench.take(sequence, pressed)
    assert spectra._work is not None
    spectra._work.result(DEADLINE_S)
    bench.take(200, pressed)
    told = bench.received["spectra"]
    bench.until(lambda: len(told) >= 2)
    assert [(one.contact, one.contacts) for one in told[:2]] == [(0, 2), (1, 2)]
    found = sorted((one.position.x, one.position.y) for one in told[:2])
    for one, (row, col) in zip(found, places, strict=True):
        assert one == pytest.approx((float(GEOMETRY.x_m(col)), float(GEOMETRY.y_m(row))), abs=1e-3)


def test_the_spectrum_of_what_was_lifted_has_the_stamp_at_which_it_was(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=0.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    for sequence in range(1, 200):
        bench.take(sequence, counts_of(sequence) if sequence < 160 else np.zeros((32, 32)))
    # The next frame publishes what is being made, and begins anew with the frames up to it.
    for sequence in (200, 201):
        assert spectra._work is not None
        spectra._work.result(DEADLINE_S)
        bench.take(sequence, np.zeros((32, 32)))
    told = bench.received["spectra"]
    bench.until(lambda: any(message.sequence == 200 for message in told))
    lifted = next(message for message in told if message.sequence == 200)
    # The part of the window in which it was lifted is left out: the 16th of 20.
    assert ns_of(lifted.header.stamp) - FIRST_NS == pytest.approx(150_000_000, abs=1000)
    assert lifted.duration == pytest.approx(0.149, abs=0.001)


def test_a_spectrum_that_cannot_be_made_is_told_once_and_the_next_is_made(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=0.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    bench.take(0, counts_of(0))
    failed: Future[tuple[analysed.Spectrum, ...]] = Future()
    failed.set_exception(MemoryError("no room"))
    spectra._work = failed
    with pytest.raises(MemoryError, match="no room"):
        bench.take(1, counts_of(1))
    bench.take(2, counts_of(2))
    assert spectra._work is not failed


def test_of_a_taxel_that_is_measured_many_times_in_a_frame_all_samples_are_taken(
    make_bench: Callable[..., Bench],
) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=0.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    taxels, pressed = np.full(10, 500, dtype=np.uint16), np.full(10, 400, dtype=np.uint16)
    for sequence in range(1, 200):
        frame = SampleFrame(sequence, 1000 * sequence, 1000, Scheme.FIXED, 32, 32, 0, taxels, pressed)
        bench.node.take([(frame, FIRST_NS + 1_000_000 * sequence)], "plate")
        if spectra._work is not None:
            spectra._work.result(DEADLINE_S)
    told = bench.received["spectra"]
    bench.until(lambda: bool(told))
    assert told[0].sample_rate == pytest.approx(10_000, rel=1e-3)


def test_spectra_keep_their_rate(make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=10.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    now_s, begun = 100.0, [0]
    monkeypatch.setattr(spectra_publisher, "time", SimpleNamespace(monotonic=lambda: now_s))

    def begin(*_: Any, **__: Any) -> Future[tuple[analysed.Spectrum, ...]]:
        begun[0] += 1
        done: Future[tuple[analysed.Spectrum, ...]] = Future()
        done.set_result(())
        return done

    monkeypatch.setattr(spectra_publisher, "background", SimpleNamespace(begin=begin))
    for sequence in range(1, 1201):
        now_s += 0.001
        bench.take(sequence, counts_of(sequence))
    assert begun[0] == pytest.approx(11, abs=1)


def test_a_spectrum_of_before_the_board_began_anew_is_not_told(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(20, spectra_window_s=0.2, spectra_rate_hz=0.0)
    spectra = publisher_of(bench.node, SpectraPublisher)
    bench.listen(Spectrum, "spectra", qos.STREAM)
    bench.until(lambda: spectra.is_wanted)
    told: list[Spectrum] = []
    monkeypatch.setattr(spectra._publisher, "publish", told.append)
    for sequence in range(1001, 1151):
        bench.take(sequence, counts_of(sequence))
    assert spectra._work is not None
    spectra._work.result(DEADLINE_S)
    told.clear()
    # Its clock begins anew, the stamps go on.
    bench.take(1, counts_of(1), 1_151_000_000)
    assert not told
    # Nor is one made of samples of before.
    assert len(spectra._analyser._frames) == 1
    assert spectra._work is None


def test_without_the_parameter_there_is_no_topic(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(20, spectra=False)
    assert "/plate/spectra" not in dict(bench.node.get_topic_names_and_types())
