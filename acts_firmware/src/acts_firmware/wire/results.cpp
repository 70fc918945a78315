// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/wire/results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acts_firmware/wire/bytes.hpp"

namespace acts {

namespace {

constexpr std::uint8_t kNoObject = 0xFF;

std::uint16_t whole_counts(float value) {
  if (!(value > 0.0F)) {
    return 0;
  }
  return static_cast<std::uint16_t>(std::lround(std::min(value, static_cast<float>(kCountMax))));
}

}  // namespace

std::size_t encode_image(const RecoveredImage& image, std::uint8_t* out) {
  Writer writer(out);
  begin_packet(writer, PacketType::kImage);
  writer.u32(image.sequence);
  writer.u64(image.board_us);
  writer.u32(image.duration_us);
  writer.u8(static_cast<std::uint8_t>(image.rows));
  writer.u8(static_cast<std::uint8_t>(image.cols));
  writer.u16(0);  // reserved
  const int taxels = image.rows * image.cols;
  for (int i = 0; i < taxels; ++i) {
    writer.u16(whole_counts(image.counts[i]));
  }
  return end_packet(writer, out);
}

std::size_t encode_object(const RecognisedObject& result, std::uint8_t* out) {
  Writer writer(out);
  begin_packet(writer, PacketType::kObject);
  writer.u32(result.sequence);
  writer.u64(result.board_us);
  writer.u32(result.duration_us);
  writer.u8(result.object < 0 ? kNoObject : static_cast<std::uint8_t>(result.object));
  writer.u8(static_cast<std::uint8_t>(result.objects));
  writer.u16(0);  // reserved
  for (int i = 0; i < result.objects; ++i) {
    const float residual = result.residuals[i];
    writer.f32(std::isfinite(residual) ? std::max(residual, 0.0F) : std::numeric_limits<float>::max());
  }
  return end_packet(writer, out);
}

}  // namespace acts
