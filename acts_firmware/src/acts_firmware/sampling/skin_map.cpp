// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/skin_map.hpp"

#include <bitset>

#include "acts_firmware/wire/bytes.hpp"
#include "acts_firmware/wire/packet.hpp"

namespace acts {

void SkinMap::reset(int rows, int cols) {
  rows_ = rows;
  cols_ = cols;
  no_skin_ = kNone;
  in_force_ = false;
  checksum_ = 0;
}

bool SkinMap::put(int place, const std::uint8_t* entries, int count) {
  if (place + count > kMaxTaxels) {
    return false;
  }
  Reader reader(entries);
  for (int i = 0; i < count; ++i) {
    entries_[static_cast<std::size_t>(place + i)] = reader.u16();
  }
  return true;
}

bool SkinMap::finish(int rows, int cols, int no_skin, std::uint32_t crc32, int taxels) {
  if (rows < 1 || rows > kMaxSide || cols < 1 || cols > kMaxSide || rows * cols != taxels) {
    return false;
  }
  if (no_skin >= kMaxPatches && no_skin != kNone) {
    return false;
  }
  std::array<std::uint8_t, 4> bytes = {static_cast<std::uint8_t>(rows), static_cast<std::uint8_t>(cols),
                                       static_cast<std::uint8_t>(no_skin), 0};
  std::uint32_t found = acts::crc32(bytes.data(), bytes.size());
  std::bitset<kMaxTaxels> seen;
  for (int place = 0; place < taxels; ++place) {
    Writer(bytes.data()).u16(entries_[static_cast<std::size_t>(place)]);
    found = acts::crc32(bytes.data(), 2, found);
    const auto index = static_cast<std::size_t>(entry(place) & kTaxelMask);
    if (index >= static_cast<std::size_t>(taxels) || seen[index]) {
      return false;
    }
    seen[index] = true;
  }
  if (found != crc32) {
    return false;
  }
  rows_ = rows;
  cols_ = cols;
  no_skin_ = no_skin;
  checksum_ = crc32;
  in_force_ = true;
  return true;
}

}  // namespace acts
