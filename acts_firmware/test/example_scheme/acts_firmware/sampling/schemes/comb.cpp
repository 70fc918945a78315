// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/comb.hpp"

namespace acts {

void Comb::begin(const SamplingConfig& /*config*/, const SkinMap& /*map*/) {
  next_ = 0;
}

void Comb::sample(const SamplingConfig& config, const SkinMap& /*map*/, Measurement& frame) {
  const int step = config.own(kStep);
  while (frame.size() < config.m) {
    frame.take(next_);
    next_ += step;
    if (next_ >= config.taxels()) {
      const int first = next_ % step + 1;
      next_ = first < step && first < config.taxels() ? first : 0;
    }
  }
}

}  // namespace acts
