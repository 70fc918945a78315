// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/recovery/patch_cover.hpp"

#include <algorithm>

namespace acts {

bool PatchSide::build(int length, int size, int step) {
  count_ = 0;
  if (size < 1 || size > std::min(length, kMaxPatchSide) || length > kMaxSide || step < 1 || step > size) {
    return false;
  }
  const int last = length - size;
  for (int start = 0; start < last; start += step) {
    starts_[count_++] = static_cast<std::uint8_t>(start);
  }
  starts_[count_++] = static_cast<std::uint8_t>(last);
  for (std::size_t at = 0; at < static_cast<std::size_t>(length); ++at) {
    std::size_t patch = 0;
    while (starts_[patch] + static_cast<std::size_t>(size) <= at) {
      ++patch;
    }
    first_[at] = static_cast<std::uint8_t>(patch);
    for (overlap_[at] = 0; patch < count_ && starts_[patch] <= at; ++patch) {
      ++overlap_[at];
    }
  }
  return true;
}

}  // namespace acts
