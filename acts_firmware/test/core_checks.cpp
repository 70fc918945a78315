// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "core_checks.hpp"

int failures = 0;

std::unique_ptr<acts::Firmware> make_firmware(acts::Board& board, acts::Protocol protocol) {
  static acts::ModelMemory models;
  return std::make_unique<acts::Firmware>(board, acts::published_wiring(), protocol, models);
}

Bytes run_of(std::size_t length) {
  Bytes bytes(length);
  for (std::size_t i = 0; i < length; ++i) {
    bytes[i] = static_cast<std::uint8_t>(i % 255 + 1);
  }
  return bytes;
}

Bytes encoded(const Bytes& data) {
  Bytes out(acts::cobs_bytes_max(data.size()));
  out.resize(acts::cobs_encode(data.data(), data.size(), out.data()));
  return out;
}

std::uint64_t little_endian(const Bytes& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) {
    value |= static_cast<std::uint64_t>(bytes[at + static_cast<std::size_t>(i)]) << (8 * i);
  }
  return value;
}
