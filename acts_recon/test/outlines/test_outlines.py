# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines of contacts: contours, what is measured of them, how they are followed, and the surface over time."""

from __future__ import annotations

import errno
import math
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, RecordingError, SettingsError
from acts_core.skin import ForceResponse, layout
from acts_recon.outlines import (
    Outline,
    OutlinesConfig,
    OutlineTracer,
    Surface,
    area,
    contours,
    mean_distance_m,
    surface_of,
    write_ply,
)

GEOMETRY = ArrayGeometry()
RESPONSE = ForceResponse()
ALL = np.arange(1024, dtype=np.uint16)


def disc(row: float, col: float, radius: float, force_n: float = 0.3) -> NDArray[np.uint16]:
    """Counts of a flat disc, its edge blurred over a taxel [taxels]."""
    rows, cols = np.mgrid[0:32, 0:32]
    share = np.clip(radius + 0.5 - np.hypot(rows - row, cols - col), 0, 1)
    return np.rint(RESPONSE.counts(force_n * share)).astype(np.uint16)


def traced(tracer: OutlineTracer, counts: NDArray[np.uint16], end_s: float) -> tuple[Outline, ...]:
    return tracer.step(ALL, counts.ravel(), end_s, 1e-6, counts.astype(np.float32))


def circle(x_m: float, y_m: float, radius_m: float) -> NDArray[np.float64]:
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    return np.column_stack((x_m + radius_m * np.cos(angle), y_m + radius_m * np.sin(angle)))


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10**6), level=st.floats(0.05, 0.95))
def test_contours_are_closed_and_hold_what_is_above(seed: int, level: float) -> None:
    rng = np.random.default_rng(seed)
    field = rng.random(tuple(rng.integers(1, 8, 2)))
    loops = contours(field, level)
    rows, cols = np.mgrid[0 : field.shape[0], 0 : field.shape[1]]
    turns = np.zeros(field.shape)
    for loop in loops:
        # Neighbouring corners lie on edges of one square.
        assert np.abs(loop - np.roll(loop, 1, axis=0)).max() <= 1
        angle = np.arctan2(loop[:, 0, None, None] - rows, loop[:, 1, None, None] - cols)
        turns += np.round(np.angle(np.exp(1j * (np.roll(angle, -1, axis=0) - angle))).sum(axis=0) / (2 * np.pi))
    assert np.array_equal(np.abs(turns) == 1, field > level)


def test_a_hole_has_a_contour_of_its_own_with_a_negative_area() -> None:
    field = np.ones((5, 5))
    field[2, 2] = 0
    assert sorted(area(loop) for loop in contours(field, 0.5)) == [-0.5, 24.5]
    assert contours(np.zeros((4, 4)), 0.5) == []


def test_an_outline_tells_area_perimeter_centre_and_orientation() -> None:
    x_m = np.array([0.02, 0.04, 0.04, 0.02]) * math.cos(0.5) - np.array([0.0, 0.0, 0.01, 0.01]) * math.sin(0.5)
    y_m = np.array([0.02, 0.04, 0.04, 0.02]) * math.sin(0.5) + np.array([0.0, 0.0, 0.01, 0.01]) * math.cos(0.5)
    outline = Outline(1, 0.0, x_m, y_m)
    assert outline.area_m2 == pytest.approx(2e-4)
    assert outline.perimeter_m == pytest.approx(0.06)
    assert outline.centre_m == pytest.approx((x_m.mean(), y_m.mean()))
    assert outline.orientation_rad == pytest.approx(0.5)
    square = Outline(1, 0.0, np.array([0.0, 1.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0, 1.0]))
    assert square.orientation_rad == 0.0
    assert mean_distance_m(circle(0, 0, 0.02), circle(0, 0, 0.023)) == pytest.approx(0.003, rel=0.02)


@pytest.mark.parametrize("fast_s", [0.05, 0.0])
def test_the_outline_is_finer_than_a_taxel(fast_s: float) -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0, OutlinesConfig(outlines_fast_s=fast_s))
    for number in range(12):
        found = traced(tracer, disc(15.3, 12.6, 4.4), 1e-3 * number)
    (outline,) = found
    x_m, y_m = float(GEOMETRY.x_m(12.6)), float(GEOMETRY.y_m(15.3))
    truth = circle(x_m, y_m, 4.4 * GEOMETRY.pitch_m)
    assert mean_distance_m(np.column_stack((outline.x_m, outline.y_m)), truth) < 0.25 * GEOMETRY.pitch_m
    assert outline.centre_m == pytest.approx((x_m, y_m), abs=0.1 * GEOMETRY.pitch_m)
    assert outline.area_m2 > 0
    assert outline.number == 1
    assert outline.time_s == pytest.approx(0.011, abs=1e-5)


def test_an_outline_follows_what_grows_though_few_taxels_are_measured() -> None:
    rng = np.random.default_rng(1)
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    image = np.zeros((32, 32), dtype=np.float32)
    errors, growth = [], []
    for number in range(1, 25):
        radius = 1.5 + 0.3 * number
        counts = disc(16, 16, radius)
        taxels = rng.permutation(1024)[:128].astype(np.uint16)
        image.ravel()[taxels] = counts.ravel()[taxels]
        # The image is behind: most of it is some frames old.
        found = tracer.step(taxels, counts.ravel()[taxels], 1e-3 * number, 1e-6, image)
        if number > 6 and found:
            truth = circle(float(GEOMETRY.x_m(16)), float(GEOMETRY.y_m(16)), radius * GEOMETRY.pitch_m)
            largest = max(found, key=lambda one: one.area_m2)
            corners = np.column_stack((largest.x_m, largest.y_m))
            errors.append(mean_distance_m(corners, truth) / GEOMETRY.pitch_m)
            growth.append(largest.growth_m2_s)
    assert len(errors) > 12
    assert np.mean(errors) < 0.6
    assert np.mean(growth) > 0


def test_an_image_that_predicts_too_much_at_the_frames_end_does_not_matter() -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    for number in range(4):
        counts = disc(16, 16, 4.0, 0.05 + 0.05 * number)
        image = np.where(counts > 0, 1023, 0).astype(np.float32)
        (outline,) = tracer.step(ALL, counts.ravel(), 5e-3 * number, 5e-3, image)
        corners = np.column_stack((outline.x_m, outline.y_m))
        truth = circle(float(GEOMETRY.x_m(16)), float(GEOMETRY.y_m(16)), 4.0 * GEOMETRY.pitch_m)
        assert mean_distance_m(corners, truth) < 0.4 * GEOMETRY.pitch_m


def test_a_contact_that_a_frame_has_measured_to_be_none_has_no_outline() -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    image = np.zeros((32, 32), dtype=np.float32)
    image[10, 10:12] = 300.0
    places = np.array([10 * 32 + col for col in (10, 11, 12)], dtype=np.uint16)
    assert tracer.step(places[:2], np.full(2, 300, dtype=np.uint16), 0.0, 1e-3, image) == ()
    image[10, 12] = 300.0
    assert tracer.step(places, np.zeros(3, dtype=np.uint16), 1e-3, 1e-3, image) == ()


@pytest.mark.parametrize("duration_s", [-1e-6, np.nan, np.inf])
def test_a_duration_that_cannot_be_is_refused(duration_s: float) -> None:
    with pytest.raises(ArrayError, match="needed are finite times, none negative"):
        OutlineTracer(GEOMETRY).step(ALL, ALL % 10, 1.0, duration_s, np.zeros((32, 32), dtype=np.float32))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_an_image_that_is_not_finite_is_refused_and_no_contact_is_forgotten(value: float) -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    counts = disc(8, 8, 3)
    for number in range(4):
        traced(tracer, counts, 1e-3 * number)
    wrong = counts.astype(np.float32)
    wrong[8, 9] = value
    with pytest.raises(ArrayError, match="image with NaN or infinity: needed are finite counts"):
        tracer.step(ALL, counts.ravel(), 4e-3, 1e-3, wrong)
    with pytest.raises(ArrayError, match="image with NaN or infinity: needed are finite counts"):
        tracer.skip(4e-3, wrong)
    assert [outline.number for outline in traced(tracer, counts, 5e-3)] == [1]


def test_a_contact_keeps_its_number_and_two_have_two() -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    for number in range(8):
        both = np.maximum(disc(8, 8 + 0.2 * number, 3), disc(24, 24, 3))
        found = traced(tracer, both, 1e-3 * number)
        assert [outline.number for outline in found] == [1, 2]
    assert traced(tracer, np.zeros((32, 32), dtype=np.uint16), 0.009) == ()
    assert [outline.number for outline in traced(tracer, disc(8, 8, 3), 0.010)] == [3]
    assert [outline.number for outline in traced(tracer, disc(8, 8, 3), 5.0)] == [4]
    with pytest.raises(ArrayError, match="needed is"):
        tracer.step(ALL, ALL % 10, 6.0, 1e-3, np.zeros((3, 3), dtype=np.float32))
    with pytest.raises(SettingsError, match="outlines_level"):
        OutlinesConfig(outlines_level=2.0)


def test_frames_are_skipped_while_contacts_are_old_and_lie_still() -> None:
    tracer = OutlineTracer(GEOMETRY)
    old, new, moved = disc(8, 8, 3), disc(8, 8, 3) + disc(24, 24, 3), disc(8, 14, 3)
    nothing = np.zeros_like(old)

    def skips(counts: NDArray[np.uint16], end_s: float) -> bool:
        return tracer.skip(end_s, counts.astype(np.float32))

    assert not skips(nothing, 10.0)
    for k in range(100):
        traced(tracer, old, 10.001 + 1e-3 * k)
    end_s = 10.1
    assert not any(skips(counts, end_s + 1e-3) for counts in (new, moved, nothing))
    for k in range(2000):
        assert skips(old, end_s + 1e-3 * (k + 1))
    # Seconds after the last look it is the same contact.
    assert [one.number for one in traced(tracer, new, end_s + 2.001)] == [1, 2]
    assert not skips(new, end_s + 2.002)
    # After a pause it is another.
    assert not skips(old, end_s + 4.0)
    assert [one.number for one in traced(tracer, old, end_s + 4.0)] == [3]


def test_no_frame_is_skipped_while_a_contact_is_too_small_for_an_edge_but_young() -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE)
    begun, grown = np.zeros((2, 32, 32), dtype=np.uint16)
    begun[16, 16:18] = 300
    grown[15:18, 15:19] = 300
    assert traced(tracer, begun, 10.0) == ()
    assert not tracer.skip(10.001, grown.astype(np.float32))
    assert len(traced(tracer, grown, 10.001)) == 1
    # One that stays as small is passed over when it is old.
    tracer.reset()
    assert traced(tracer, begun, 20.0) == ()
    assert not tracer.skip(20.04, begun.astype(np.float32))
    assert tracer.skip(20.06, begun.astype(np.float32))


def test_no_frame_is_skipped_in_which_the_patch_beside_an_old_contact_is_touched() -> None:
    """Beside it lay a finger of its own, whose touch was taken for a part of the contact until the next look."""
    glove = layout("glove", 32, 32)
    tracer = OutlineTracer(glove.geometry(), RESPONSE, 40.0, 2.0, layout=glove)
    image = np.zeros((32, 32), dtype=np.float32)
    image[6:10, 4:8] = 300
    for end_s in (1.0, 1.1):
        tracer.step(ALL, glove.matrix(image).ravel().astype(np.uint16), end_s, 1e-6, image)
    wider = image.copy()
    wider[5, 4:8] = 300
    assert tracer.skip(1.101, wider)
    image[6:10, 8:10] = 300
    assert not tracer.skip(1.102, image)


def test_no_outline_reaches_over_a_border() -> None:
    glove = layout("glove", 32, 32)
    geometry = glove.geometry()
    tracer = OutlineTracer(geometry, RESPONSE, 40.0, 2.0, layout=glove)
    image = np.full((glove.rows, glove.cols), 300, dtype=np.float32)
    image[glove.patch_of == 255] = 0
    counts = glove.matrix(image).ravel().astype(np.uint16)
    for number in range(3):
        found = tracer.step(ALL, counts, 1e-3 * number, 1e-6, image)
    assert len(found) == len(glove.patches)
    for outline in found:
        rows, cols = geometry.row_of(outline.y_m), geometry.col_of(outline.x_m)
        within = [
            patch
            for patch in glove.patches
            if patch.first_row - 0.6 <= rows.min() <= rows.max() <= patch.end_row - 0.4
            and patch.first_col - 0.6 <= cols.min() <= cols.max() <= patch.end_col - 0.4
        ]
        assert len(within) == 1


def test_the_contour_of_what_is_pressed_hardest_at_the_edge_of_the_array_does_not_reach_over_it() -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    rows, cols = np.mgrid[0:32, 0:32]
    counts = np.rint(900 * np.exp(-(rows**2 + (cols - 16) ** 2) / 8)).astype(np.uint16)
    for number in range(80):
        found = traced(tracer, counts, 1e-3 * number)
    (outline,) = found
    # It was 0.87 taxels beyond the first row.
    assert GEOMETRY.row_of(outline.y_m).min() == pytest.approx(-0.5)


def test_an_edge_that_is_followed_beyond_the_array_has_no_outline() -> None:
    """It was a line along the edge of the array, with no area."""
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0, OutlinesConfig(outlines_fast_s=10.0))
    counts = np.zeros((32, 32), dtype=np.uint16)
    counts[14:19, 0] = 300
    found = [traced(tracer, counts, 1e-3 * number) for number in range(3)]
    # From now on only what lies beside it is measured, and untouched.
    beside = ALL.reshape(32, 32)[10:22, 3:6].ravel()
    for number in range(3, 25):
        untouched = np.zeros(beside.size, dtype=np.uint16)
        found.append(tracer.step(beside, untouched, 1e-3 * number, 1e-3, counts.astype(np.float32)))
    assert [len(outlines) for outlines in found[:10]] == [1] * 10
    areas = [outline.area_m2 / GEOMETRY.taxel_area_m2 for outlines in found for outline in outlines]
    assert len(areas) < len(found)
    assert min(areas) > 0.25


def test_what_rests_does_not_grow_when_it_is_too_old_for_its_edge_to_be_followed() -> None:
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0, OutlinesConfig(outlines_fast_s=0.0505))
    found = [traced(tracer, disc(15.3, 12.6, 4.4), 1e-3 * number)[0] for number in range(100)]
    # Frame 51 is the first with a contour.
    assert found[51].area_m2 != found[50].area_m2
    assert [outline.growth_m2_s for outline in found[51:]] == [0.0] * 49


def test_an_outline_goes_on_in_a_frame_of_the_time_of_the_one_before() -> None:
    """So stamps are that lie a nanosecond apart."""
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    before, same, after = (
        traced(tracer, disc(15.3, 12.6, 3.0 + 0.1 * number), 1.7e9 + time_s)[0]
        for number, time_s in enumerate((0.0, 0.0, 1e-3))
    )
    assert before.number == same.number == after.number
    assert same.growth_m2_s == before.growth_m2_s
    assert 0.0 < after.growth_m2_s < 1.0


@settings(max_examples=10, deadline=None)
@given(data=st.data())
def test_any_frames_have_finite_outlines(data: st.DataObject) -> None:
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    tracer = OutlineTracer(GEOMETRY, RESPONSE, 40.0, 2.0)
    top, size, end_s = data.draw(st.sampled_from([60, 1023])), data.draw(st.sampled_from([1, 55, 1024])), 0.0
    for _ in range(5):
        end_s += rng.exponential(0.003)
        image = (rng.random((32, 32)) * top * (rng.random((32, 32)) > 0.9)).astype(np.float32)
        taxels = rng.permutation(1024)[:size].astype(np.uint16)
        for outline in tracer.step(taxels, rng.integers(0, top, size).astype(np.uint16), end_s, 1e-3, image):
            assert np.isfinite([*outline.x_m, *outline.y_m, outline.growth_m2_s]).all()
            assert outline.area_m2 >= 0


def test_outlines_over_time_are_a_closed_surface_in_a_file(tmp_path: Path) -> None:
    rings = [circle(0.0, 0.0, radius) for radius in (0.01, 0.02, 0.015)]
    outlines = [Outline(1, 1e-3 * k, *ring.T) for k, ring in enumerate(rings)]
    surface = surface_of(outlines, speed_m_s=5.0)
    assert surface.points_m[:, 2].max() == pytest.approx(0.010)
    # Closed: every edge belongs to two triangles, once in each direction.
    edges = [(int(t[k]), int(t[(k + 1) % 3])) for t in surface.triangles for k in range(3)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    first, second, third = (surface.points_m[surface.triangles[:, k]] for k in range(3))
    volume_m3 = float(np.sum(first * np.cross(second, third))) / 6
    frusta = [np.pi * 0.005 / 3 * (a * a + a * b + b * b) for a, b in ((0.01, 0.02), (0.02, 0.015))]
    assert volume_m3 == pytest.approx(sum(frusta), rel=0.01)
    path = tmp_path / "touch.ply"
    write_ply(surface, path)
    lines = path.read_text().splitlines()
    assert lines[0] == "ply"
    assert len(lines) == lines.index("end_header") + 1 + len(surface.points_m) + len(surface.triangles)
    with pytest.raises(RecordingError, match="two or more"):
        surface_of(outlines[:1])
    with pytest.raises(RecordingError, match="cannot be written"):
        write_ply(surface, tmp_path / "no" / "touch.ply")


def test_a_surface_is_written_as_a_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fill_the_disk(_number: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    corners = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]])
    path = tmp_path / "touch.ply"
    write_ply(Surface(corners, np.array([[0, 1, 2]])), path)
    before = path.read_text()
    monkeypatch.setattr(os, "fsync", fill_the_disk)
    with pytest.raises(RecordingError, match=r"touch\.ply: cannot be written \(No space left on device\)"):
        write_ply(Surface(2.0 * corners, np.array([[0, 1, 2]])), path)
    assert path.read_text() == before
    assert list(tmp_path.iterdir()) == [path]
