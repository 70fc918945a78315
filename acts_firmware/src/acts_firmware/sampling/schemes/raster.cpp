// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/raster.hpp"

namespace acts {

void Raster::sample(const SamplingConfig& config, const SkinMap& /*map*/, Measurement& frame) {
  for (int index = 0; index < config.taxels(); ++index) {
    frame.take(index);
  }
}

}  // namespace acts
