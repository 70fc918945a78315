// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// How long the published board takes for recovery and classification.
#pragma once

#include "acts_firmware/firmware.hpp"

namespace acts {

// The time [us] that the published board takes besides sampling for frames of these settings with this model, whatever
// is pressed; 0 for samples only. From the paper's Fig. 9: recovery over 50 to 500 measurements of 1024 and 50 to 500
// atoms (its heat map), classification over 50 to 500 measurements and libraries of 60 and 90 columns (its curves).
// Between these it is linear; below 50 measurements proportional to them, beyond linear as at the edge. Recovery of
// another array takes the time of as dense a frame of 32 x 32, scaled by the taxels; classification of a smaller or
// larger library is scaled as the two curves differ. Side and step of the patches, over which the paper has no times,
// are left out.
double published_recovery_us(Output output, const Model& model, const SamplingConfig& sampling, int m);

}  // namespace acts
