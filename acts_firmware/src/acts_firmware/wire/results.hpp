// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the board recovers by itself, as packets. docs/wire_protocol.md describes the layout.
#pragma once

#include <cstddef>
#include <cstdint>

#include "acts_firmware/limits.hpp"
#include "acts_firmware/model/model.hpp"
#include "acts_firmware/wire/packet.hpp"

namespace acts {

// A full image out of one frame.
struct RecoveredImage {
  std::uint32_t sequence = 0;     // of the frame
  std::uint64_t board_us = 0;     // of the frame
  std::uint32_t duration_us = 0;  // of the recovery
  int rows = 0;
  int cols = 0;
  const float* counts = nullptr;  // row-major; any value
};

// The object that one frame touches.
struct RecognisedObject {
  std::uint32_t sequence = 0;     // of the frame
  std::uint64_t board_us = 0;     // of the frame
  std::uint32_t duration_us = 0;  // of the classification
  int object = -1;                // -1 where the frame tells nothing
  int objects = 0;                // 1 to kMaxObjects
  const float* residuals = nullptr;
};

constexpr std::size_t kResultHeadBytes = 24;
constexpr std::size_t kMaxImageBytes = kResultHeadBytes + 2 * kMaxTaxels + kPacketCrcBytes;
constexpr std::size_t kMaxObjectBytes = kResultHeadBytes + 4 * kMaxObjects + kPacketCrcBytes;

// Writes the packet, CRC included, to `out` (kMaxImageBytes). Counts are rounded and clipped to 0 to 1023, NaN is 0.
std::size_t encode_image(const RecoveredImage& image, std::uint8_t* out);

// Writes the packet, CRC included, to `out` (kMaxObjectBytes). Residuals below 0 become 0, those that are not finite
// the largest number there is.
std::size_t encode_object(const RecognisedObject& result, std::uint8_t* out);

}  // namespace acts
