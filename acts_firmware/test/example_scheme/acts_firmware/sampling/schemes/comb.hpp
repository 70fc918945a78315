// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Comb sampling: every n-th taxel, from where the last frame stopped.
#pragma once

#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

class Comb : public SchemeDefaults {
 public:
  static constexpr OwnSetting kStep = {17, "comb_step", "taxels from one of a comb frame to the next", 5, 1, 64};
  static constexpr SchemeInfo kInfo = {
      "comb", Scheme{8}, "every n-th taxel, from where the last frame stopped", {{kStep}}};

  void begin(const SamplingConfig& config, const SkinMap& map);
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  int next_ = 0;
};

}  // namespace acts
