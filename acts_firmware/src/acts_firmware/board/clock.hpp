// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The board's clock in 64 bit.
#pragma once

#include <cstdint>

namespace acts {

// Extends micros(), which wraps every 71.6 minutes; must be called more often than that.
class ExtendedClock {
 public:
  std::uint64_t extend(std::uint32_t micros) {
    // The difference modulo 2^32 is right across a wrap.
    total_ += static_cast<std::uint32_t>(micros - static_cast<std::uint32_t>(total_));
    return total_;
  }

 private:
  std::uint64_t total_ = 0;
};

}  // namespace acts
