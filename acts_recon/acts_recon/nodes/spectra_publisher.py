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

from acts_core.runtime import background
from acts_msgs.msg import Spectrum as SpectrumMessage
from acts_recon.methods import Recovery
from acts_recon.nodes.frame_publisher import RecoveredFrame, TopicPublisher
from acts_recon.settings import ReconstructionConfig
from acts_recon.spectra import Spectrum
from acts_ros.messages import set_stamp

_SPECTRA_END_WITHIN_S = 4.0
"""Those of 50,000 samples take up to a second of a core [s]; a launch ends the process after 5 s more harshly."""


class SpectraPublisher(TopicPublisher):
    """Keeps the samples of the last second, and publishes acts_msgs/Spectrum of each contact.

    A spectrum takes longer than a frame, so it is made on a thread of its own; it is published with the frame after.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery) -> None:
        super().__init__(node, SpectrumMessage, "spectra", settings)
        self._analyser = settings.spectrum_analyser(recovery)
        self._work: Future[tuple[Spectrum, ...]] | None = None
        self._frame_id, self._stamp_ns, self._sequence = "", 0, 0
        self._ends_s: tuple[float, ...] = ()

    def reset(self) -> None:
        """See `FramePublisher.reset`."""
        self._analyser.reset()
        self._work = None

    def publish(self, frame: RecoveredFrame) -> None:
        """Take the samples of a frame; publish what is ready."""
        every = frame.every
        self._analyser.add(every.indices, every.counts, frame.end_s, every.duration_us * 1e-6, may_repeat=every.repeats)
        if self._work is not None:
            if not self._work.done():
                return
            # Taken before it is looked at: one that failed does so once.
            work, self._work = self._work, None
            found = work.result()
            for contact, spectrum in enumerate(found):
                header = self._header(spectrum.end_s)
                self._publisher.publish(_message(header, self._sequence, contact, len(found), spectrum))
        window = self._analyser.window() if self._limit.due(time.monotonic()) else ()
        if window:
            self._frame_id, self._stamp_ns, self._sequence = frame.header.frame_id, frame.stamp_ns, frame.sequence
            self._ends_s = tuple(placed.end_s for placed in window)
            self._work = background.begin(lambda: self._analyser.spectra(window), ends_within_s=_SPECTRA_END_WITHIN_S)

    def _header(self, last_s: float) -> Header:
        """With the end of the frame that has the last sample of a contact, which may end before the window does [s]."""
        end_s = next((end_s for end_s in self._ends_s if end_s >= last_s), self._ends_s[-1])
        header = Header(frame_id=self._frame_id)
        # Seconds since 1970 leave too few digits: what counts is how long before the window's end.
        set_stamp(header.stamp, self._stamp_ns - round((self._ends_s[-1] - end_s) * 1e9))
        return header

    def _rate_hz(self, settings: ReconstructionConfig) -> float:
        return settings.spectra_rate_hz


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
