// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// How the matrix' taxels lie on the skin: which are neighbours there, and where its patches end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acts_firmware/limits.hpp"

namespace acts {

// The schemes that look for neighbours walk the picture of the skin, place by place, row-major. Without a map the
// picture is the matrix itself, and all of it one patch. acts_core/sampling/basis/skin_map.py is the same in Python.
class SkinMap {
 public:
  static constexpr int kMaxPatches = 16;
  static constexpr int kNone = 255;  // in place of a patch

  // The picture is the matrix again.
  void reset(int rows, int cols);

  // Takes `count` entries (u16, little-endian: taxel, and patch in the four highest bits) from a place on; false where
  // they reach beyond the largest picture. They count once `finish` has checked them; call reset() before.
  bool put(int place, const std::uint8_t* entries, int count);

  // Puts the entries into force for a picture of rows x cols of a matrix of `taxels`. `no_skin` is the patch where
  // there is none, or kNone. False, and nothing changed, where they are not every taxel once, or not of this checksum.
  bool finish(int rows, int cols, int no_skin, std::uint32_t crc32, int taxels);

  // Of the map in force; 0 for none.
  std::uint32_t checksum() const { return checksum_; }
  bool in_force() const { return in_force_; }

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  int taxel(int place) const { return in_force_ ? entry(place) & kTaxelMask : place; }
  bool has_skin(int place) const { return !in_force_ || patch(place) != no_skin_; }

  // Whether two places are on the same patch.
  bool joined(int one, int other) const { return !in_force_ || patch(one) == patch(other); }

 private:
  static constexpr int kTaxelMask = kMaxTaxels - 1;
  static constexpr int kPatchShift = 12;

  int entry(int place) const { return entries_[static_cast<std::size_t>(place)]; }
  int patch(int place) const { return entry(place) >> kPatchShift; }

  int rows_ = 0;
  int cols_ = 0;
  int no_skin_ = kNone;
  bool in_force_ = false;
  std::uint32_t checksum_ = 0;
  std::array<std::uint16_t, kMaxTaxels> entries_{};
};

static_assert(kMaxTaxels == 1 << 12, "a taxel and a patch fill 16 bits");

}  // namespace acts
