// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/wire/packet_receiver.hpp"

#include "acts_firmware/wire/packet.hpp"

namespace acts {

PacketReceiver::Event PacketReceiver::push(std::uint8_t byte) {
  if (byte == kDelimiter) {
    if (fresh_) {
      return Event::kNone;
    }
    fresh_ = true;
    return damaged_ || run_left_ > 0 ? Event::kDamaged : Event::kPacket;
  }
  if (fresh_) {
    begin();
  }
  if (damaged_) {
    return Event::kNone;
  }
  if (run_left_ > 0) {
    put(byte);
    --run_left_;
    return Event::kNone;
  }
  if (zero_due_) {
    put(0);
  }
  run_left_ = static_cast<std::uint8_t>(byte - 1);
  zero_due_ = byte != 0xFF;
  return Event::kNone;
}

void PacketReceiver::begin() {
  fresh_ = false;
  size_ = 0;
  run_left_ = 0;
  zero_due_ = false;
  damaged_ = false;
}

void PacketReceiver::put(std::uint8_t byte) {
  if (size_ == kCapacity) {
    damaged_ = true;
    return;
  }
  packet_[size_++] = byte;
}

}  // namespace acts
