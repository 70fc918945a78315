// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// How long the published board takes for a frame.
#pragma once

#include "acts_firmware/sampling/schemes.hpp"
#include "acts_firmware/sampling/settings.hpp"

namespace acts {

// The time of one measurement [us] in a frame of these settings: the authors' times per frame, between the M they
// measured linear in M, beyond them at the time per measurement of the nearest. Uniform and random have a table in
// common, adaptive has one; what the authors did not build is put together from these: tracking takes adaptive's times,
// hybrid adaptive's for its quota and random's for the rest. Raster, as any other scheme, takes random's time for as
// many taxels, which on 32 x 32 is the paper's 55 frames a second. docs/virtual_board.md says how far the paper's
// curves are met.
double published_sample_us(const SamplingConfig& sampling);

// The authors' raster sketch: 17,509 us for 1024 taxels.
constexpr double kRasterSketchSampleUs = 17.098;

}  // namespace acts
