# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The judgements of the self-test, on frames of a modelled skin whose wiring is broken on purpose."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.frames import SampleFrame, Scheme
from acts_driver.selftest import (
    Finding,
    FrameRecord,
    Level,
    Thresholds,
    judge_high,
    judge_timing,
    judge_touched,
    judge_untouched,
    listed,
    measure_timing,
    measure_touched,
    measure_untouched,
)
from acts_driver.selftest.findings import taxels_listed
from acts_driver.selftest.untouched import noise_of

THRESHOLDS = Thresholds()
SAMPLE_US = 17.7


@dataclass
class Wiring:
    """What is broken; as the virtual board's --hardware-fault."""

    open_rows: tuple[int, ...] = ()
    open_cols: tuple[int, ...] = ()
    short_rows: tuple[tuple[int, ...], ...] = ()
    short_cols: tuple[tuple[int, ...], ...] = ()
    dead: tuple[tuple[int, int], ...] = ()
    stuck: dict[tuple[int, int], float] = field(default_factory=dict)
    address_bit: int | None = None

    def seen(self, images: NDArray[np.float64]) -> NDArray[np.float64]:
        """What the board sees of images (n, rows, cols)."""
        images = images.copy()
        for row, col in self.dead:
            images[:, row, col] = 0
        for (row, col), counts in self.stuck.items():
            images[:, row, col] = counts
        images[:, list(self.open_rows)] = 0
        images[:, :, list(self.open_cols)] = 0
        for group in self.short_rows:
            images[:, list(group)] = images[:, list(group)].sum(axis=1, keepdims=True)
        for group in self.short_cols:
            images[:, :, list(group)] = images[:, :, list(group)].sum(axis=2, keepdims=True)
        if self.address_bit is not None:
            images = images[:, :, np.arange(images.shape[2]) & ~(1 << self.address_bit)]
        return np.clip(images, 0, 1023)


class Skin:
    """A skin of 32 x 32 under a raster board with noise of 1.5 counts."""

    def __init__(
        self, wiring: Wiring | None = None, offset: float = 5.0, seed: int = 1, shape: tuple[int, int] = (32, 32)
    ) -> None:
        self.wiring = wiring or Wiring()
        self.rng = np.random.default_rng(seed)
        self.rows, self.cols = shape
        self.offset = offset
        self.knobs = 200 + 350 * self.rng.random(shape)

    def field(self, share: float) -> NDArray[np.float64]:
        """A rough roller that goes along the columns and then along the rows."""
        row, col = np.indices(self.knobs.shape)
        place, side = (col, self.cols) if share < 0.5 else (row, self.rows)
        centre = -8 + (side + 16) * (share % 0.5) * 2
        return self.knobs * np.exp(-0.5 * ((place - centre) / 2.5) ** 2)

    def record(self, n: int, *, touched: bool, m: int | None = None) -> FrameRecord:
        """Raster frames, or of `m` random taxels, each measured at its own time."""
        record = FrameRecord(self.rows, self.cols)
        size = self.rows * self.cols
        each = np.arange(self.rows)
        shares = (each / self.rows)[:, None, None]
        for k in range(n):
            begin, end = (self.field(min(k + step, n) / n) if touched else 0 * self.knobs for step in (0, 1))
            # Row after row, each at its own time: a shorted row conducts what the other has at that moment.
            image = self.wiring.seen(self.offset * (self.knobs > 0) + begin + shares * (end - begin))[each, each]
            counts = np.clip(np.rint(image + self.rng.normal(0, 1.5, image.shape)), 0, 1023).astype(np.uint16).ravel()
            indices = np.arange(size) if m is None else self.rng.permutation(size)[:m]
            duration_us = round(len(indices) * SAMPLE_US)
            board_us = (k + 1) * duration_us
            frame = SampleFrame(
                k,
                board_us,
                duration_us,
                Scheme.RASTER,
                self.rows,
                self.cols,
                0,
                indices.astype(np.uint16),
                counts[indices],
            )
            record.add(frame, board_us * 1000 + 50_000)
        return record

    def findings(self) -> list[Finding]:
        """What the self-test says, but for timing."""
        untouched = measure_untouched(self.record(120, touched=False))
        touch = measure_touched(self.record(240, touched=True), untouched, THRESHOLDS)
        return [*judge_untouched(untouched, THRESHOLDS), *judge_touched(touch, untouched, THRESHOLDS)]


def faults(findings: list[Finding]) -> dict[str, Finding]:
    return {finding.name: finding for finding in findings if finding.level is not Level.PASS}


@pytest.mark.parametrize(("shape", "offset"), [((32, 32), 0.0), ((32, 32), 30.0), ((9, 16), 5.0)])
def test_a_healthy_skin_passes(shape: tuple[int, int], offset: float) -> None:
    assert faults(Skin(offset=offset, shape=shape).findings()) == {}


@pytest.mark.parametrize("seed", [1, 2])
def test_every_fault_is_found_and_named_among_the_others(seed: int) -> None:
    wiring = Wiring(
        open_rows=(5, 31),
        open_cols=(0, 17),
        short_rows=((2, 29), (13, 14)),
        short_cols=((8, 9, 25),),
        dead=((10, 12), (20, 3)),
        stuck={(4, 4): 700.0, (27, 30): 1023.0},
    )
    found = faults(Skin(wiring, seed=seed).findings())
    assert found.keys() == {
        "open rows", "open columns", "shorted rows", "shorted columns", "dead taxels", "stuck taxels"
    }  # fmt: skip
    assert all(finding.level is Level.FAIL and finding.advice for finding in found.values())
    assert found["open rows"].rows == (5, 31)
    assert found["open columns"].cols == (0, 17)
    assert found["shorted rows"].rows == (2, 13, 14, 29)
    assert "rows 2 and 29; 13 and 14 respond as one" in found["shorted rows"].text
    assert found["shorted columns"].cols == (8, 9, 25)
    assert found["dead taxels"].taxels == ((10, 12), (20, 3))
    assert found["stuck taxels"].taxels == ((4, 4), (27, 30))
    assert "700, 1023 counts" in found["stuck taxels"].text


class RestingSkin(Skin):
    """A hand rests flat on the middle of it for most of the time, and rolls over all of it at the end."""

    def field(self, share: float) -> NDArray[np.float64]:
        if share > 0.92:
            return super().field((share - 0.92) / 0.08)
        flat = np.zeros(self.knobs.shape)
        flat[8:24, 8:24] = 300.0
        return flat


def test_lines_on_which_a_hand_rests_flat_are_not_shorted() -> None:
    for wiring, told in ((Wiring(), set()), (Wiring(short_rows=((13, 14),)), {"shorted rows"})):
        skin = RestingSkin(wiring)
        untouched = measure_untouched(skin.record(120, touched=False))
        touch = measure_touched(skin.record(480, touched=True), untouched, THRESHOLDS)
        found = faults(judge_touched(touch, untouched, THRESHOLDS))
        assert found.keys() & {"shorted rows", "shorted columns"} == told
        if told:
            assert found["shorted rows"].rows == (13, 14)


@pytest.mark.parametrize("bit", range(5))
def test_a_broken_address_line_is_told_from_shorted_columns(bit: int) -> None:
    found = faults(Skin(Wiring(address_bit=bit)).findings())
    assert found.keys() == {"multiplexer"}
    assert f"address bit {bit} (pin {33 + bit})" in found["multiplexer"].text


def test_several_broken_address_lines_are_all_named() -> None:
    untouched = measure_untouched(Skin().record(60, touched=False))
    touch = measure_touched(Skin().record(240, touched=True), untouched, THRESHOLDS)
    (found,) = faults(judge_touched(replace(touch, broken_bits=(1, 3)), untouched, THRESHOLDS)).values()
    words = "address bits 1 (pin 34) and 3 (pin 36) do not switch: columns 2 and 8 apart respond as one"
    assert (found.text, found.advice) == (words, "check those lines from the board to the multiplexer")


def test_a_plug_with_eight_loose_rows() -> None:
    found = faults(Skin(Wiring(open_rows=tuple(range(12, 20)))).findings())
    assert found["open rows"].rows == tuple(range(12, 20))
    assert "rows 12 to 19" in found["open rows"].text


@pytest.mark.parametrize("shape", [(1, 8), (8, 1)])
def test_a_stuck_taxel_that_is_a_whole_line_is_not_told_as_an_open_line_too(shape: tuple[int, int]) -> None:
    stuck, dead = ((3, 0), (6, 0)) if shape[1] == 1 else ((0, 3), (0, 6))
    found = faults(Skin(Wiring(stuck={stuck: 700.0}), shape=shape).findings())
    assert found.keys() == {"stuck taxels"}
    assert found["stuck taxels"].taxels == (stuck,)
    found = faults(Skin(Wiring(stuck={stuck: 700.0}, dead=(dead,)), shape=shape).findings())
    assert found.keys() == {"stuck taxels", "open rows" if shape[1] == 1 else "open columns"}
    assert found["stuck taxels"].taxels == (stuck,)
    line = found["open rows"].rows if shape[1] == 1 else found["open columns"].cols
    assert line == (6,)


def test_a_skin_that_reads_high_and_never_responds_is_told_with_what_it_reads() -> None:
    found = faults(Skin(Wiring(stuck={(0, 0): 700.0}), shape=(1, 1)).findings())
    assert found.keys() == {"touch", "high taxels"}
    assert found["high taxels"].taxels == ((0, 0),)


def test_what_was_not_pressed_is_not_judged() -> None:
    skin = Skin()
    untouched = measure_untouched(skin.record(60, touched=False))
    nothing = judge_touched(
        measure_touched(skin.record(60, touched=False), untouched, THRESHOLDS), untouched, THRESHOLDS
    )
    assert [(finding.level, finding.name) for finding in nothing] == [(Level.FAIL, "touch")]
    skin.knobs[:, 8:] = 0.001  # pressed at the left only
    found = faults(
        judge_touched(measure_touched(skin.record(240, touched=True), untouched, THRESHOLDS), untouched, THRESHOLDS)
    )
    assert found.keys() == {"coverage"}
    assert found["coverage"].level is Level.WARN
    assert "columns 8 to 31" in found["coverage"].text


def test_small_random_frames_show_open_rows_and_nothing_that_is_not_there() -> None:
    skin = Skin(Wiring(open_rows=(3,)))
    untouched = measure_untouched(skin.record(120, touched=False, m=512))
    touch = measure_touched(skin.record(1500, touched=True, m=512), untouched, THRESHOLDS)
    found = faults(judge_touched(touch, untouched, THRESHOLDS))
    assert found.keys() == {"open rows"}
    assert found["open rows"].rows == (3,)


def test_noise_is_measured_at_zero_and_among_spikes() -> None:
    rng = np.random.default_rng(2)
    for mean in (0, 20, 1023):
        counts = np.clip(np.rint(rng.normal(mean, 3, 400)), 0, 1023)
        counts[7] = 500
        assert noise_of(counts) == pytest.approx(3, rel=0.15)
    assert noise_of(np.array([4.0])) == 0
    assert noise_of(np.full(50, 7.0)) == 0


def test_noisy_high_and_unmeasured_taxels() -> None:
    skin = Skin()
    record = skin.record(200, touched=False)
    for frame in record.frames:
        frame.counts[40] = skin.rng.integers(0, 100)
        frame.counts[50] = 300
    found = faults(
        [*judge_untouched(measure_untouched(record), THRESHOLDS), judge_high(measure_untouched(record), THRESHOLDS)]
    )
    assert found["noise"].taxels == ((1, 8),)
    assert found["noise"].level is Level.FAIL
    assert found["high taxels"].taxels == ((1, 18),)
    few = FrameRecord(32, 32)
    for frame, arrival_ns in zip(record.frames, record.arrivals_ns, strict=True):
        few.add(SampleFrame(0, 0, 0, Scheme.ADAPTIVE, 32, 32, 0, frame.indices[:30], frame.counts[:30]), arrival_ns)
    assert "994 of 1024 taxels" in faults(judge_untouched(measure_untouched(few), THRESHOLDS))["measured"].text


def test_timing_of_a_good_and_of_a_bad_stream() -> None:
    record = Skin(shape=(16, 16)).record(1000, touched=False)
    good = measure_timing(record, has_board_clock=True)
    assert {finding.level for finding in judge_timing(good, THRESHOLDS)} == {Level.PASS}
    assert good.taxel_us == pytest.approx(SAMPLE_US, rel=1e-3)
    assert good.rate_hz == pytest.approx(1e6 / (256 * SAMPLE_US), rel=1e-3)
    bad = FrameRecord(16, 16)
    for k, (frame, arrival_ns) in enumerate(zip(record.frames, record.arrivals_ns, strict=True)):
        if k % 50 != 7:
            late_us = 2 * frame.board_us + (700 if k % 20 == 3 else 0)
            changed = SampleFrame(k, late_us, 11_000, Scheme.RASTER, 16, 16, 0, frame.indices, frame.counts)
            bad.add(changed, round(2 * arrival_ns * 1.0004))
    found = faults(judge_timing(measure_timing(bad, has_board_clock=True), THRESHOLDS))
    assert found.keys() == {"lost frames", "time per taxel", "clock jitter", "clock drift"}
    assert found["lost frames"].level is Level.FAIL
    assert "20 of" in found["lost frames"].text
    slow = measure_timing(record, has_board_clock=True, frame_period_us=1000.0)
    assert slow.possible_hz == pytest.approx(good.possible_hz)
    assert {finding.name for finding in judge_timing(measure_timing(record, has_board_clock=False), THRESHOLDS)} == {
        "frame rate", "lost frames", "time per taxel"
    }  # fmt: skip


def test_a_board_without_clock_and_durations_whose_numbers_begin_anew() -> None:
    record = Skin(shape=(16, 16)).record(1000, touched=False)
    told = FrameRecord(16, 16)
    for k, (frame, arrival_ns) in enumerate(zip(record.frames, record.arrivals_ns, strict=True)):
        told.add(SampleFrame(k % 256, 0, 0, Scheme.RASTER, 16, 16, 0, frame.indices, frame.counts), arrival_ns)
    timing = measure_timing(told, has_board_clock=False)
    assert (timing.lost, timing.restarts) == (0, (len(told.frames) - 1) // 256)
    assert timing.rate_hz == pytest.approx(1e6 / (256 * SAMPLE_US), rel=1e-3)
    findings = judge_timing(timing, THRESHOLDS)
    assert [finding.name for finding in findings] == ["frame rate", "lost frames", "frame numbers"]
    assert faults(findings).keys() == {"frame numbers"}


def test_a_frame_that_comes_twice_makes_up_for_none_that_is_missing() -> None:
    record = Skin(shape=(16, 16)).record(1000, touched=False)
    told = FrameRecord(16, 16)
    for k, (frame, arrival_ns) in enumerate(zip(record.frames, record.arrivals_ns, strict=True)):
        for _ in range({10: 2, 20: 0}.get(k, 1)):
            told.add(frame, arrival_ns)
    timing = measure_timing(told, has_board_clock=True)
    assert (timing.lost, timing.restarts) == (1, 0)
    assert "lost frames" in faults(judge_timing(timing, THRESHOLDS))


def test_a_restart_within_the_test_changes_neither_rate_nor_jitter() -> None:
    record = Skin(shape=(16, 16)).record(1000, touched=False)
    told = FrameRecord(16, 16)
    began_us = record.frames[500].board_us - record.frames[500].duration_us
    for k, (frame, arrival_ns) in enumerate(zip(record.frames, record.arrivals_ns, strict=True)):
        # On for 1000 s before.
        number, board_us = (100_000 + k, 10**9 + frame.board_us) if k < 500 else (k - 500, frame.board_us - began_us)
        told.add(frame._replace(sequence=number, board_us=board_us), arrival_ns)
    timing = measure_timing(told, has_board_clock=True)
    assert (timing.lost, timing.restarts) == (0, 1)
    assert timing.rate_hz == pytest.approx(1e6 / (256 * SAMPLE_US), rel=1e-3)
    assert faults(judge_timing(timing, THRESHOLDS)).keys() == {"frame numbers"}


def test_numbers_are_listed_for_a_person() -> None:
    assert listed((3,)) == "3"
    assert listed((3, 4, 7, 8, 9)) == "3, 4, 7 to 9"
    assert taxels_listed(((1, 2), (3, 4), (5, 6)), most=2) == "(1, 2), (3, 4) and 1 more"
