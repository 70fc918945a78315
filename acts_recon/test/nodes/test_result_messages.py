# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Each number of a result is in its own field of the message; without a node."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from std_msgs.msg import Header
from visualization_msgs.msg import Marker

from acts_core.skin import TrackedBlob
from acts_recon.gait import FootGait, Gait, Step
from acts_recon.impacts import Impact, Kind
from acts_recon.nodes import (
    contacts_publisher,
    gait_node,
    impacts_publisher,
    outlines_publisher,
    spectra_publisher,
)
from acts_recon.nodes.gait_node import GaitNode
from acts_recon.outlines import Outline
from acts_recon.spectra import Peak, Spectrum

HEADER = Header(stamp=Time(sec=1_700_000_000, nanosec=500_000_000), frame_id="plate")
END_S = 1_700_000_000.5


def test_an_outline() -> None:
    # A rectangle of 4 mm by 2 mm, along y.
    x_m, y_m = np.array([0.0, 0.002, 0.002, 0.0]), np.array([0.001, 0.001, 0.005, 0.005])
    outline = Outline(7, END_S - 0.25, x_m, y_m, growth_m2_s=-0.5)
    message = outlines_publisher._message(HEADER, 9, END_S, outline)
    assert message.header == HEADER
    assert (message.sequence, message.number, message.before_stamp) == (9, 7, 0.25)
    assert (message.centre.x, message.centre.y, message.centre.z) == pytest.approx((0.001, 0.003, 0.0))
    assert (message.area, message.growth) == pytest.approx((8e-6, -0.5))
    assert (message.perimeter, message.orientation) == pytest.approx((0.012, math.pi / 2))
    np.testing.assert_array_equal(message.x, x_m.astype(np.float32))
    np.testing.assert_array_equal(message.y, y_m.astype(np.float32))


def test_a_touch() -> None:
    impact = Impact(
        number=7,
        is_over=True,
        kind=Kind.SLIDE,
        onset_s=END_S - 0.25,
        onset_sd_s=0.125,
        duration_s=2.0,
        frames=3,
        x_m=4.0,
        y_m=5.0,
        peak_n=6.0,
        peak_sd_n=7.0,
        bounced=True,
        joined=8,
        impulse_n_s=9.0,
        impulse_sd_n_s=10.0,
        direction_rad=11.0,
        direction_sd_rad=12.0,
        velocity_m_s=(13.0, 14.0),
        velocity_sd_m_s=(15.0, 16.0),
        time_s=END_S + np.array([-0.25, 0.0]),
        force_n=np.array([17.0, 18.0]),
        path_x_m=np.array([19.0, 20.0]),
        path_y_m=np.array([21.0, 22.0]),
    )
    message = impacts_publisher._message(HEADER, 9, END_S, impact)
    assert message.header == HEADER
    assert (message.sequence, message.number, message.is_over, message.kind) == (9, 7, True, message.SLIDE)
    assert (message.bounced, message.joined, message.frames) == (True, 8, 3)
    assert (message.onset.sec, message.onset.nanosec) == (1_700_000_000, 250_000_000)
    assert (message.onset_sigma, message.duration) == (0.125, 2.0)
    assert (message.position.x, message.position.y, message.position.z) == (4.0, 5.0, 0.0)
    assert (message.peak_force, message.peak_force_sigma) == (6.0, 7.0)
    assert (message.impulse, message.impulse_sigma) == (9.0, 10.0)
    assert (message.direction, message.direction_sigma) == (11.0, 12.0)
    assert (message.velocity.x, message.velocity.y) == (13.0, 14.0)
    assert (message.velocity_sigma.x, message.velocity_sigma.y) == (15.0, 16.0)
    # Since the onset.
    assert list(message.time) == [0.0, 0.25]
    assert list(message.force) == [17.0, 18.0]
    assert (list(message.path_x), list(message.path_y)) == ([19.0, 20.0], [21.0, 22.0])


def test_a_spectrum() -> None:
    peaks = (Peak(1.0, 2.0, 3.0, 4.0), Peak(5.0, 6.0, 7.0, 8.0))
    spectrum = Spectrum(
        begin_s=END_S - 0.5,
        end_s=END_S,
        x_m=9.0,
        y_m=10.0,
        force_n=11.0,
        taxels=12,
        sample_rate_hz=13.0,
        step_hz=14.0,
        amplitude_n=np.array([15.0, 16.0]),
        peaks=peaks,
    )
    message = spectra_publisher._message(HEADER, 9, 1, 3, spectrum)
    assert message.header == HEADER
    assert (message.sequence, message.contact, message.contacts, message.duration) == (9, 1, 3, 0.5)
    assert (message.position.x, message.position.y, message.position.z) == (9.0, 10.0, 0.0)
    assert (message.force, message.taxels) == (11.0, 12)
    assert (message.sample_rate, message.step) == (13.0, 14.0)
    assert list(message.amplitude) == [15.0, 16.0]
    assert (list(message.peak_frequency), list(message.peak_frequency_sigma)) == ([1.0, 5.0], [2.0, 6.0])
    assert (list(message.peak_amplitude), list(message.peak_amplitude_sigma)) == ([3.0, 7.0], [4.0, 8.0])


def test_a_step() -> None:
    step = Step(
        strike_s=0.25,
        strike_sd_s=1.0,
        toe_off_s=0.75,
        toe_off_sd_s=2.0,
        swing_s=3.0,
        peak_force=4.0,
        time_s=np.array([0.25, 0.5]),
        force=np.array([5.0, 6.0]),
        x_m=np.array([7.0, 8.0]),
        y_m=np.array([9.0, 10.0]),
    )
    node: Any = SimpleNamespace(_first_ns=1_700_000_000 * 10**9)
    newest: Any = SimpleNamespace(frame_id="sole", stamp_ns=1_700_000_001 * 10**9)
    message = GaitNode._step_message(node, 1, newest, step)
    assert (message.header.frame_id, message.header.stamp, message.foot) == ("sole", Time(sec=1_700_000_001), 1)
    assert message.strike == Time(sec=1_700_000_000, nanosec=250_000_000)
    assert message.toe_off == Time(sec=1_700_000_000, nanosec=750_000_000)
    assert (message.strike_sigma, message.toe_off_sigma) == (1.0, 2.0)
    assert (message.stance, message.swing, message.peak_force) == (0.5, 3.0, 4.0)
    # Since the strike.
    assert (list(message.time), list(message.force)) == ([0.0, 0.25], [5.0, 6.0])
    assert (list(message.path_x), list(message.path_y)) == ([7.0, 8.0], [9.0, 10.0])


def test_a_gait() -> None:
    left = FootGait(1, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)
    right = FootGait(10, 20.0, 30.0, 12.0, 10.0, 60.0, 70.0, 80.0)
    gait = Gait((left, right), 9.0, 0.125)
    message = gait_node._gait_message(1_700_000_000_500_000_000, gait)
    assert message.header.stamp == HEADER.stamp
    assert (message.cadence, message.double_support) == (9.0, 0.125)
    assert list(message.steps) == [1, 10]
    assert (list(message.stride), list(message.stance), list(message.swing)) == ([3.0, 30.0], [4.0, 12.0], [5.0, 10.0])
    assert (list(message.peak_force), list(message.progress)) == ([6.0, 60.0], [7.0, 70.0])
    asymmetries = [gait.asymmetry("stance_s"), gait.asymmetry("swing_s")]
    assert asymmetries[0] != asymmetries[1]
    assert [message.stance_asymmetry, message.swing_asymmetry] == pytest.approx(asymmetries)
    # What is not known yet is 0.
    unknown = FootGait(0, None, None, None, None, None, None, None)
    message = gait_node._gait_message(0, Gait((unknown, unknown), None, None))
    assert (message.cadence, message.double_support, list(message.stride)) == (0.0, 0.0, [0.0, 0.0])


def test_the_markers_of_contacts_are_seen_for_a_fifth_of_a_second_in_colours_of_their_own() -> None:
    blob = TrackedBlob(*[0] * len(TrackedBlob._fields))._replace(x_m=0.01, y_m=0.02, area_m2=4e-4 * math.pi)
    colours = []
    for number in (1, 2, 3):
        disc, text = contacts_publisher._markers(HEADER, blob._replace(number=number))
        for marker in (disc, text):
            assert (marker.pose.position.x, marker.pose.position.y) == (0.01, 0.02)
            assert (marker.lifetime.sec, marker.lifetime.nanosec) == (0, 200_000_000)
            # A quaternion that viewers take, and colours that are seen.
            assert (marker.pose.orientation.w, marker.action) == (1.0, Marker.ADD)
            assert marker.color.a > 0.5
            assert marker.color == disc.color
        # The number is in front of the disc.
        assert text.pose.position.z > disc.pose.position.z + disc.scale.z
        assert (disc.scale.x, disc.scale.y) == pytest.approx((0.04, 0.04))
        assert text.text == str(number)
        colours.append([disc.color.r, disc.color.g, disc.color.b])
        assert max(colours[-1]) - min(colours[-1]) > 0.5
    for one, other in ((0, 1), (1, 2), (0, 2)):
        assert np.abs(np.subtract(colours[one], colours[other])).max() > 0.5
