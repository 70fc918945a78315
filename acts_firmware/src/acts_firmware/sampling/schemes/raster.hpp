// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Raster sampling: every taxel.
#pragma once

#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

class Raster : public SchemeDefaults {
 public:
  static constexpr SchemeInfo kInfo = {"raster", Scheme{4}, "every taxel, row by row", {}, true};

  void begin(const SamplingConfig& /*config*/, const SkinMap& /*map*/) {}
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);
};

}  // namespace acts
