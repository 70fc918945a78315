# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``spectra`` of the reconstruction node: how what touches the skin vibrates."""

from __future__ import annotations

import time
from array import array
from collections.abc import Iterable
from concurrent.futures import Future

from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.frames import SampleFrame
from acts_core.runtime import RateLimit, background
from acts_msgs.msg import Spectrum as SpectrumMessage
from acts_recon.spectra import Spectrum, SpectrumAnalyser
from acts_ros import qos
from acts_ros.messages import ns_of, set_stamp


class SpectraPublisher:
    """Keeps the samples of the last second, and publishes acts_msgs/Spectrum of each contact, while somebody listens.

    A spectrum takes longer than a frame, so it is made on a thread of its own; it is published with the frame after.

    Parameters
    ----------
    node : Node
    analyser : SpectrumAnalyser
    rate_hz : float
        Largest rate [Hz].
    """

    def __init__(self, node: Node, analyser: SpectrumAnalyser, rate_hz: float) -> None:
        self._analyser = analyser
        self._publisher = node.create_publisher(SpectrumMessage, "spectra", **qos.overridable(qos.STREAM))
        self._limit = RateLimit(rate_hz)
        self.is_wanted = False
        self._work: Future[tuple[Spectrum, ...]] | None = None
        self._header, self._sequence = Header(), 0

    def set_rate(self, rate_hz: float) -> None:
        """Change the largest rate [Hz]."""
        self._limit.set_rate(rate_hz)

    def reset(self) -> None:
        """Forget all samples: the next ones are not of the same board, or long after."""
        self._analyser.reset()
        self._work = None

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        send = self._publisher.get_subscription_count() > 0
        if send and not self.is_wanted:
            self.reset()
        self.is_wanted = send

    def publish(self, header: Header, frame: SampleFrame, end_s: float) -> None:
        """Take the samples of a frame; publish what is ready.

        Parameters
        ----------
        header : Header
            Of the frame.
        frame : SampleFrame
            With all samples, less the baseline; `Method.step` has accepted what it has of each taxel.
        end_s : float
            Time of the last measurement [s].
        """
        if not self.is_wanted:
            return
        self._analyser.add(frame.indices, frame.counts, end_s, frame.duration_us * 1e-6, may_repeat=frame.repeats)
        if self._work is not None:
            if not self._work.done():
                return
            found = self._work.result()
            for contact, spectrum in enumerate(found):
                self._publisher.publish(_message(self._header, self._sequence, contact, len(found), spectrum))
            self._work = None
        window = self._analyser.window() if self._limit.due(time.monotonic()) else ()
        if window:
            self._header = Header(frame_id=header.frame_id)
            set_stamp(self._header.stamp, ns_of(header.stamp))
            self._sequence = frame.sequence
            self._work = background.begin(lambda: self._analyser.spectra(window))


def _message(header: Header, sequence: int, contact: int, contacts: int, spectrum: Spectrum) -> SpectrumMessage:
    message = SpectrumMessage(header=header, sequence=sequence, contact=contact, contacts=contacts)
    message.duration = spectrum.end_s - spectrum.begin_s
    message.position.x, message.position.y = spectrum.x_m, spectrum.y_m
    message.force, message.taxels = spectrum.force_n, spectrum.taxels
    message.sample_rate, message.step = spectrum.sample_rate_hz, spectrum.step_hz
    message.amplitude = _floats(spectrum.amplitude_n)
    message.peak_frequency = _floats(peak.frequency_hz for peak in spectrum.peaks)
    message.peak_frequency_sigma = _floats(peak.frequency_sd_hz for peak in spectrum.peaks)
    message.peak_amplitude = _floats(peak.amplitude_n for peak in spectrum.peaks)
    message.peak_amplitude_sigma = _floats(peak.amplitude_sd_n for peak in spectrum.peaks)
    return message


def _floats(values: Iterable[float]) -> array[float]:
    return array("f", values)
