// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Bytes on their way to the host: whole messages go in, any number of bytes goes out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace acts {

// 128 KB: half a second of frames of 55 taxels at 1 kHz. Part of the `Firmware`, so in the fast RAM of the Teensy.
class TransmitQueue {
 public:
  static constexpr std::size_t kCapacity = 131072;

  // Takes a message in whole, or not at all where it does not fit.
  bool push(const std::uint8_t* data, std::size_t length);

  // The next bytes to send, in one piece; length 0 when empty.
  struct Piece {
    const std::uint8_t* data;
    std::size_t length;
  };
  Piece front() const;

  // The first `length` bytes of front() have been sent.
  void pop(std::size_t length);

  void clear();
  std::size_t size() const { return size_; }

 private:
  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace acts
