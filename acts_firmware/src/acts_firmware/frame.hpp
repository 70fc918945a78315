// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What one frame is, from measurement to packet.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/limits.hpp"

namespace acts {

// How the taxels were chosen: the number on the wire that each sampling scheme says of itself (sampling/schemes.hpp). 1
// to 3 are the mode numbers of the published firmware.
enum class Scheme : std::uint8_t {};

constexpr Scheme kNoScheme{0};

struct SampleFrame {
  std::uint32_t sequence = 0;
  std::uint64_t board_us = 0;     // end of the last measurement
  std::uint32_t duration_us = 0;  // from the start of the first to the end of the last measurement
  std::uint32_t overruns = 0;     // frames dropped since the start
  Scheme scheme = kNoScheme;
  std::uint8_t rows = 0;
  std::uint8_t cols = 0;
  std::uint16_t m = 0;
  std::array<std::uint16_t, kMaxTaxels> indices{};  // row-major, in the order of measurement
  std::array<std::uint16_t, kMaxTaxels> counts{};

  void append(int index, std::uint16_t count) {
    indices[m] = static_cast<std::uint16_t>(index);
    counts[m] = count;
    ++m;
  }
};

}  // namespace acts
