# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spectra: how what touches the skin vibrates, with the frequency and the amplitude of each tone.

In come samples, each with its own time; out come the spectrum of the force of each contact, and its peaks.
"""

from acts_recon.spectra.analyser import PlacedFrame, SpectrumAnalyser
from acts_recon.spectra.config import SpectraConfig
from acts_recon.spectra.spectrum import Peak, Spectrum

__all__ = ["Peak", "PlacedFrame", "SpectraConfig", "Spectrum", "SpectrumAnalyser"]
