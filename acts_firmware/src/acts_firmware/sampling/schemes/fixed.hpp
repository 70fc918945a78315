// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Fixed sampling: the same few taxels in every frame, down to a single one that is measured over and over.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// A taxel and those nearest to it on the skin, in every frame in the same order. With fewer than m of them a frame has
// them several times, in turns. Taxels on the same patch of skin come first, then the nearer ones, then the earlier
// ones row by row.
class Fixed : public SchemeDefaults {
 public:
  static constexpr OwnSetting kRow = {
      14,  "fixed_row", "row of the taxel that fixed frames begin with", 0, 0, kMaxSide - 1, nullptr, "",
      0.0, Below::kRows};
  static constexpr OwnSetting kCol = {15,  "fixed_col", "column of that taxel", 0, 0, kMaxSide - 1, nullptr, "",
                                      0.0, Below::kCols};
  static constexpr OwnSetting kTaxels = {
      16, "fixed_taxels", "taxels of a fixed frame, measured in turns until there are m samples; 0: m, each once", 0,
      0,  kMaxTaxels};
  static constexpr SchemeInfo kInfo = {
      "fixed", Scheme{7}, "a chosen taxel and those around it, the same in every frame", {{kRow, kCol, kTaxels}}};

  void begin(const SamplingConfig& config, const SkinMap& map);
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  int size_ = 0;
  std::array<std::uint16_t, kMaxTaxels> taxels_{};
};

}  // namespace acts
