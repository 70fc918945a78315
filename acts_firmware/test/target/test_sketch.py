# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The Teensy's sketch, run on the host against a model of the Teensy and of the wiring, in virtual time."""

from pathlib import Path

import numpy as np
import pytest
from core_library import installed
from sketch_model import WATCHDOG_ENABLED, run_sketch, upload

from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_core.wire import (
    BoardImage,
    BoardSettings,
    RasterDecoder,
    Reply,
    ReplyStatus,
    StreamDecoder,
    encode_configure,
    encode_query,
    patch_dictionary,
)
from acts_core.wire.commands import HeldModel

PRESSED = [(3, 4, 500), (3, 5, 900), (4, 4, 181), (31, 0, 1023), (0, 31, 700)]
PRESS = [f"0 press {row} {col} {counts}" for row, col, counts in PRESSED]
PERIOD_US = 1000
BOARD_ID = 0x12D6 * 10  # of the model's fuses: 24 bits, and a zero behind where that is below 10 million


def field() -> np.ndarray:
    counts = np.zeros((32, 32), dtype=np.int64)
    for row, col, value in PRESSED:
        counts[row, col] = value
    return counts


def test_it_streams_what_the_reference_samples(tmp_path: Path) -> None:
    run = run_sketch([*PRESS, "20000 open", "120000 end"], tmp_path)
    frames = run.frames()
    assert len(frames) > 80
    reference = Sampler(SamplingConfig())
    for frame in frames:
        indices, counts = reference.frame(measure_in(field()))
        assert frame.indices.tolist() == indices.tolist()
        assert frame.counts.tolist() == counts.tolist()
        assert frame.overruns == 0
    assert np.all(np.diff([frame.sequence for frame in frames]) == 1)
    # Frames begin on the grid of the period; the model's pins take a little of a frame's time.
    starts = [frame.board_us - frame.duration_us for frame in frames]
    assert np.max(np.abs(np.diff(starts) - PERIOD_US)) <= 5
    assert 940 <= frames[0].duration_us <= 960


def test_pins_adc_and_watchdog_are_set_up(tmp_path: Path) -> None:
    report = run_sketch([*PRESS, "20000 open", "60000 end"], tmp_path).report
    assert report["wrong_pins"] == [0]
    assert report["adc"] == [10, 4]
    control, longest_hunger_us = report["watchdog"]
    assert control & WATCHDOG_ENABLED
    half_seconds = (control >> 8) + 1
    assert longest_hunger_us < half_seconds * 500_000 / 10


def test_a_stream_starts_afresh_with_each_opening(tmp_path: Path) -> None:
    run = run_sketch(["20000 open", "50000 close", "300000 open", "330000 end"], tmp_path)
    second = run.read_from(300_000)
    assert second[0] == 0
    frames = run.frames(300_000)
    assert frames[0].board_us >= 300_000
    assert frames[0].overruns == 0  # nobody read: nothing was lost
    assert frames[0].sequence > 290  # but the board went on


def test_what_a_stalled_host_left_behind_does_no_harm(tmp_path: Path) -> None:
    run = run_sketch(["20000 open", "50000 stall", "60000 close", "300000 open", "330000 end"], tmp_path)
    decoder = StreamDecoder()
    decoder.reset()
    frames = list(decoder.feed(run.read_from(300_000)))
    assert decoder.crc_errors + decoder.malformed <= 1  # the one that was cut at the end of what USB held
    assert frames[0].board_us < 60_000
    assert sum(frame.board_us > 300_000 for frame in frames) > 10


def test_a_host_that_stalls_costs_whole_frames_and_no_time(tmp_path: Path) -> None:
    run = run_sketch(["20000 open", "100000 stall", "1500000 read", "1600000 end"], tmp_path)
    frames = run.frames()
    sequence = np.array([frame.sequence for frame in frames])
    gaps = np.diff(sequence) - 1
    assert np.count_nonzero(gaps) == 1  # what fits into the queue is kept, then all is dropped until there is room
    assert frames[-1].overruns == gaps.sum() > 500
    assert np.all(np.abs(np.diff([frame.board_us for frame in frames]) - PERIOD_US * (gaps + 1)) <= 5)


@pytest.mark.parametrize(("period_us", "delay"), [(PERIOD_US, "hold"), (PERIOD_US, "delay"), (0, "delay")])
def test_what_holds_the_processor_up_is_counted(tmp_path: Path, period_us: int, delay: str) -> None:
    # Of a millisecond, 20 measurements leave more than half: the processor is held up between two frames.
    configure = encode_configure(1, BoardSettings(m=20, frame_period_us=period_us)).hex()
    run = run_sketch(["20000 open", f"40000 send {configure}", f"100700 {delay} 400000", "600000 end"], tmp_path)
    frames = run.frames()
    gaps = np.diff([frame.sequence for frame in frames]) - 1
    assert np.count_nonzero(gaps) == 1
    assert frames[-1].overruns == gaps.sum()
    if period_us > 0:
        assert 398 <= gaps.sum() <= 400
    else:
        # One directly after another; how long one takes is told in whole microseconds.
        busy_us = frames[-1].duration_us
        assert 400_000 // (busy_us + 2) <= gaps.sum() <= 400_000 // (busy_us - 2)


def test_frames_that_follow_sooner_from_now_on_are_none_that_were_missed(tmp_path: Path) -> None:
    slower = encode_configure(1, BoardSettings(frame_period_us=1_000_000)).hex()
    faster = encode_configure(2, BoardSettings(frame_period_us=PERIOD_US)).hex()
    run = run_sketch(["20000 open", f"40000 send {slower}", f"800000 send {faster}", "900000 end"], tmp_path)
    frames = run.frames()
    assert len(frames) > 100
    assert {frame.overruns for frame in frames} == {0}
    assert np.all(np.diff([frame.sequence for frame in frames]) == 1)


def test_the_published_raster_sketch_can_be_chosen(tmp_path: Path) -> None:
    run = run_sketch([*PRESS, "20000 open", "200000 end"], tmp_path, [str(installed("sketch_raster_ascii"))])
    decoder = RasterDecoder(32, 32)
    frames = list(decoder.feed(run.read_from(0)))
    assert decoder.malformed == 0
    assert len(frames) >= 8
    for frame in frames:
        image = np.zeros(1024, dtype=np.int64)
        image[frame.indices] = frame.counts
        assert np.array_equal(image.reshape(32, 32), field())
        assert 17_500 <= frame.duration_us <= 18_000


def test_a_host_can_ask_and_change_everything(tmp_path: Path) -> None:
    settings = BoardSettings(rows=16, cols=8, scheme="random", m=20, frame_period_us=500, led="on", seed=9)
    commands = [
        "20000 open",
        f"21000 send {encode_query(7).hex()}",  # before the board has seen the port open
        f"60000 send {encode_configure(8, settings).hex()}",
        f"80000 send {encode_configure(9, BoardSettings(rows=33)).hex()}",
        "120000 end",
    ]
    run = run_sketch([*PRESS, *commands], tmp_path)
    frames = run.frames()
    asked, changed, refused = run.messages()
    assert isinstance(asked, Reply)
    assert isinstance(changed, Reply)
    assert isinstance(refused, Reply)
    assert (asked.request, changed.request, refused.request) == (7, 8, 9)
    assert asked.state.board_id == BOARD_ID
    assert asked.state.settings == BoardSettings()
    assert changed.status == ReplyStatus.OK
    assert changed.state.settings == refused.state.settings == settings
    assert refused.status == ReplyStatus.SETTING_REFUSED  # an array that this board has no lines for
    after = [frame for frame in frames if frame.board_us > 62_000]
    assert {(frame.rows, frame.cols, len(frame.indices)) for frame in after} == {(16, 8, 20)}
    starts = np.array([frame.board_us - frame.duration_us for frame in after])
    assert np.max(np.abs(np.diff(starts) - 500)) <= 5
    corner = field()[:16, :8]
    assert all(np.array_equal(frame.counts, corner.ravel()[frame.indices]) for frame in after)
    assert run.report["led"][0] == 1


def test_images_follow_the_samples_once_a_model_is_uploaded(tmp_path: Path) -> None:
    model = patch_dictionary(np.random.default_rng(1).standard_normal((64, 64)))
    configure = encode_configure(4, BoardSettings(output="image", frame_period_us=2000)).hex()
    run = run_sketch([*PRESS, "20000 open", *upload(model, 40_000), f"70000 send {configure}", "120000 end"], tmp_path)
    messages = run.messages()
    ended = next(reply for reply in messages if isinstance(reply, Reply) and reply.request == 3)
    assert ended.status == ReplyStatus.OK
    assert ended.state.model == HeldModel.of(model)
    frames = {frame.sequence: frame for frame in run.frames()}
    assert np.all(np.diff(list(frames)) == 1)  # frames went on during the upload
    images = [message for message in messages if isinstance(message, BoardImage)]
    assert len(images) > 20
    # The watchdog is not only fed at a loop's end: an image may take longer than it waits.
    assert run.report["feeds"][0] >= run.report["loops"][0] - 1 + len(images)
    for image in images:
        frame = frames[image.sequence]
        assert np.array_equal(image.counts.ravel()[frame.indices], frame.counts)
