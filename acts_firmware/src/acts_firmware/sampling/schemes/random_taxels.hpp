// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Random sampling, drawn on the board.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/random.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// Draws distinct taxels, frame after frame: the first steps of a Fisher-Yates shuffle that is never undone.
class RandomTaxels : public SchemeDefaults {
 public:
  static constexpr SchemeInfo kInfo = {"random", Scheme{2}, "M random taxels, drawn on the board"};

  RandomTaxels() : random_(0, kStream) {}

  void begin(const SamplingConfig& config, const SkinMap& map);

  // Measures random taxels until the frame has m, every one that it does not have yet equally likely.
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  static constexpr std::uint64_t kStream = 1;  // the virtual board's noise has another

  void swap(std::uint32_t i, std::uint32_t j);

  std::uint32_t taxels_ = 0;
  Pcg32 random_;
  std::array<std::uint16_t, kMaxTaxels> shuffled_{};
  std::array<std::uint16_t, kMaxTaxels> place_{};  // of each taxel in shuffled_
};

}  // namespace acts
