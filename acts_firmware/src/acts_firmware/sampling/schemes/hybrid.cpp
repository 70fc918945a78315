// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/hybrid.hpp"

namespace acts {

void Hybrid::begin(const SamplingConfig& config, const SkinMap& map) {
  adaptive_.begin(config, map);
  random_.begin(config, map);
}

void Hybrid::sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame) {
  adaptive_.sample_until(config.own(kAdaptiveQuota), config, map, frame);
  random_.sample(config, map, frame);
}

}  // namespace acts
