// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Adaptive sampling: from coarse to fine, and around what is pressed first.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/sampling/division_order.hpp"
#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// Paper, Supplemental Algorithm 1, with the two points in which the published firmware differs from it: exactly m
// taxels are measured, and the threshold itself does not count as a touch. Order and neighbours are those of the skin.
class Adaptive : public SchemeDefaults {
 public:
  static constexpr SchemeInfo kInfo = {"adaptive", Scheme{3},
                                       "a search from coarse to fine, around what is pressed first (the paper's)"};

  void begin(const SamplingConfig& config, const SkinMap& map);
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

  // Measures until the frame has m taxels.
  void sample_until(int m, const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  struct Visit {
    std::uint16_t place;
    std::uint8_t next;  // which neighbour comes next
  };

  bool is_pressed(const SamplingConfig& config, const SkinMap& map, int place, Measurement& frame);
  void search(const SamplingConfig& config, const SkinMap& map, int pressed, int m, Measurement& frame);

  DivisionOrder order_;
  // Instead of recursion: a palm on the skin is a thousand levels deep.
  std::array<Visit, kMaxTaxels> stack_{};
};

}  // namespace acts
