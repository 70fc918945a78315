// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/wire/published_ascii.hpp"

namespace acts {

namespace {

std::size_t put_decimal(std::uint32_t value, std::uint8_t* out) {
  std::uint8_t digits[10];
  std::size_t count = 0;
  do {
    digits[count++] = static_cast<std::uint8_t>('0' + value % 10);
    value /= 10;
  } while (value != 0);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = digits[count - 1 - i];
  }
  return count;
}

}  // namespace

std::size_t encode_raster_line(const SampleFrame& frame, std::uint8_t* out) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < frame.m; ++i) {
    length += put_decimal(frame.counts[i], out + length);
    out[length++] = ',';
  }
  length += put_decimal(frame.duration_us, out + length);
  out[length++] = '\r';
  out[length++] = '\n';
  return length;
}

}  // namespace acts
