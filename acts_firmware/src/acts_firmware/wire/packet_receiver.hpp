// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Packets out of the host's bytes, one byte at a time, in the room of one packet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace acts {

class PacketReceiver {
 public:
  // The largest packet a host sends: 1024 bytes of a model.
  static constexpr std::size_t kCapacity = 1040;

  enum class Event : std::uint8_t {
    kNone,
    kPacket,   // packet() is complete, until the next byte
    kDamaged,  // up to this delimiter it was none: broken stuffing, or too long
  };

  // Takes the next byte and undoes its stuffing. Whatever came before, the next delimiter is a fresh start.
  Event push(std::uint8_t byte);

  const std::uint8_t* packet() const { return packet_.data(); }
  std::size_t size() const { return size_; }

  // Forget what has come of a packet.
  void reset() { fresh_ = true; }

 private:
  void begin();
  void put(std::uint8_t byte);

  std::array<std::uint8_t, kCapacity> packet_{};
  std::size_t size_ = 0;
  std::uint8_t run_left_ = 0;  // bytes until the next code
  bool zero_due_ = false;      // before the next run
  bool damaged_ = false;
  bool fresh_ = true;  // nothing since the last delimiter
};

}  // namespace acts
