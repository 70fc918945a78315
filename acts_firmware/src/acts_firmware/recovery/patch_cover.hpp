// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Overlapping square patches that cover an array: the units in which it is recovered. acts_recon/sparse/patches.py is
// the readable reference. What it lists taxel by taxel follows here from the two sides, so that it takes 400 bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acts_firmware/limits.hpp"

namespace acts {

constexpr int kMaxPatchSide = 8;  // taxels; the paper's
constexpr int kMaxPatchPixels = kMaxPatchSide * kMaxPatchSide;

// The patches along one side of the array.
class PatchSide {
 public:
  // Patches of `size` taxels, `step` apart, on a side of `length`; the last one ends flush with the edge. False where
  // that cannot be: the patch is longer than the side or kMaxPatchSide, or the step not in 1 to `size`.
  bool build(int length, int size, int step);

  std::size_t count() const { return count_; }
  std::size_t start(std::size_t patch) const { return starts_[patch]; }
  // The patches that hold a row (or column): `first` to `first + overlap - 1`.
  std::size_t first(std::size_t at) const { return first_[at]; }
  std::size_t overlap(std::size_t at) const { return overlap_[at]; }

 private:
  std::size_t count_ = 0;
  std::array<std::uint8_t, kMaxSide> starts_{};
  std::array<std::uint8_t, kMaxSide> first_{};
  std::array<std::uint8_t, kMaxSide> overlap_{};
};

}  // namespace acts
