// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Little-endian numbers, whatever the machine is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace acts {

// Writes numbers one after the other; the caller provides the room.
class Writer {
 public:
  explicit Writer(std::uint8_t* out) : out_(out) {}

  void u8(std::uint8_t value) { out_[length_++] = value; }
  void u16(std::uint16_t value) { put(value, 2); }
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void f32(float value) {
    static_assert(sizeof(float) == 4, "IEEE 754 single precision");
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    u32(bits);
  }
  std::size_t length() const { return length_; }

 private:
  void put(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      u8(static_cast<std::uint8_t>(value >> (8 * i) & 0xFFU));
    }
  }

  std::uint8_t* out_;
  std::size_t length_ = 0;
};

// Reads them back; the caller has seen to it that they are there.
class Reader {
 public:
  explicit Reader(const std::uint8_t* data) : data_(data) {}

  std::uint8_t u8() { return data_[position_++]; }
  std::uint16_t u16() { return static_cast<std::uint16_t>(take(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
  std::uint64_t u64() { return take(8); }

 private:
  std::uint64_t take(int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      value |= std::uint64_t{u8()} << (8 * i);
    }
    return value;
  }

  const std::uint8_t* data_;
  std::size_t position_ = 0;
};

}  // namespace acts
