# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the reconstruction node tells of touch besides images and contacts: impacts, spectra and outlines."""

from __future__ import annotations

from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.frames import SampleFrame
from acts_recon.methods import Recovery
from acts_recon.nodes.impacts_publisher import ImpactsPublisher
from acts_recon.nodes.outlines_publisher import OutlinesPublisher
from acts_recon.nodes.spectra_publisher import SpectraPublisher
from acts_recon.settings import ReconstructionConfig


class Abilities:
    """The publishers of these topics, as far as the settings offer them.

    Topics ``impacts`` (acts_msgs/Impact), ``spectra`` (acts_msgs/Spectrum) and ``outlines`` (acts_msgs/Outline).

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery) -> None:
        self._recovery = recovery
        self.impacts: ImpactsPublisher | None = None
        if settings.impacts:
            self.impacts = ImpactsPublisher(node, settings.impact_detector(recovery))
        self.spectra: SpectraPublisher | None = None
        if settings.spectra:
            self.spectra = SpectraPublisher(node, settings.spectrum_analyser(recovery), settings.spectra_rate_hz)
        self.outlines: OutlinesPublisher | None = None
        if settings.outlines:
            self.outlines = OutlinesPublisher(node, settings.outline_tracer(recovery), settings.outlines_rate_hz)
        self._all = [one for one in (self.impacts, self.spectra, self.outlines) if one is not None]
        self.is_wanted = False

    def set_rates(self, settings: ReconstructionConfig) -> None:
        """Put changed rates in force."""
        if self.spectra is not None:
            self.spectra.set_rate(settings.spectra_rate_hz)
        if self.outlines is not None:
            self.outlines.set_rate(settings.outlines_rate_hz)

    def reset(self) -> None:
        """Forget all frames: the next one is not of the same board, or long after."""
        for one in self._all:
            one.reset()

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        for one in self._all:
            one.look_for_subscribers()
        self.is_wanted = any(one.is_wanted for one in self._all)

    def publish(self, header: Header, frame: SampleFrame, every: SampleFrame, end_s: float) -> None:
        """Look at a frame that has been recovered.

        Parameters
        ----------
        header : Header
            Of the frame.
        frame : SampleFrame
            With each taxel once, less the baseline.
        every : SampleFrame
            With all samples, less the baseline.
        end_s : float
            Time of the last measurement [s].
        """
        sequence, duration_s = frame.sequence, frame.duration_us * 1e-6
        if self.impacts is not None:
            self.impacts.publish(header, sequence, end_s, duration_s, self._recovery)
        if self.spectra is not None:
            self.spectra.publish(header, every, end_s)
        if self.outlines is not None:
            self.outlines.publish(header, sequence, frame.indices, frame.counts, end_s, duration_s, self._recovery)
