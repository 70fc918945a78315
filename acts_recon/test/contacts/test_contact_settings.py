# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the parameters about contacts come to."""

from __future__ import annotations

import pytest

from acts_core.errors import ArrayError, SettingsError
from acts_recon.contacts import BlobConfig
from acts_recon.settings import ReconstructionSettings


def test_contacts_are_told_apart_and_followed_as_the_parameters_say() -> None:
    settings = ReconstructionSettings(
        touch_counts=77, noise_counts=3.5, contacts_hysteresis_counts=11, contacts_bridge_s=0.5, contacts_memory_s=7.0
    )
    assert settings.blob_config() == BlobConfig(
        touch_counts=77, noise_counts=3.5, hysteresis_counts=11, bridge_s=0.5, memory_s=7.0
    )


def test_where_the_noise_is_not_known_2_counts_are_assumed() -> None:
    assert ReconstructionSettings(noise_counts=0.0).blob_config().noise_counts == 2.0


def test_slip_may_be_looked_for_twice_a_second_and_not_less_often() -> None:
    assert ReconstructionSettings(regions_slip_rate_hz=2.0).regions_slip_rate_hz == 2.0
    with pytest.raises(SettingsError, match=r"regions_slip_rate_hz = 1\.99: allowed are 0, for every frame, and 2 and"):
        ReconstructionSettings(regions_slip_rate_hz=1.99)


def test_a_layout_that_is_neither_a_name_nor_a_path_is_refused_before_it_is_looked_for() -> None:
    with pytest.raises(ArrayError, match="sqare"):
        ReconstructionSettings(layout="sqare")
    assert ReconstructionSettings(layout="/not/there.yaml").layout == "/not/there.yaml"
