// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Hybrid sampling: an adaptive frame for a part of m, random taxels for the rest.
#pragma once

#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/schemes/adaptive.hpp"
#include "acts_firmware/sampling/schemes/random_taxels.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// The paper's discussion: a large contact cannot use up a frame, and what the search misses the random part finds.
class Hybrid : public SchemeDefaults {
 public:
  static constexpr OwnSetting kAdaptiveQuota = {8,
                                                "adaptive_quota",
                                                "taxels of a hybrid frame that are chosen adaptively, 1 to m there",
                                                28,
                                                0,
                                                kMaxTaxels,
                                                "adaptive_share",
                                                "share of a hybrid frame that is chosen adaptively",
                                                0.5};
  static constexpr SchemeInfo kInfo = {
      "hybrid", Scheme{5}, "an adaptive frame for a part of M, random taxels for the rest", {{kAdaptiveQuota}}};

  void begin(const SamplingConfig& config, const SkinMap& map);
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  Adaptive adaptive_;
  RandomTaxels random_;
};

}  // namespace acts
