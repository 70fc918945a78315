// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/wire/transmit_queue.hpp"

#include <algorithm>
#include <cstring>

namespace acts {

bool TransmitQueue::push(const std::uint8_t* data, std::size_t length) {
  if (length > kCapacity - size_) {
    return false;
  }
  const std::size_t start = (first_ + size_) % kCapacity;
  const std::size_t until_end = std::min(length, kCapacity - start);
  std::memcpy(bytes_.data() + start, data, until_end);
  std::memcpy(bytes_.data(), data + until_end, length - until_end);
  size_ += length;
  return true;
}

TransmitQueue::Piece TransmitQueue::front() const {
  return {bytes_.data() + first_, std::min(size_, kCapacity - first_)};
}

void TransmitQueue::pop(std::size_t length) {
  first_ = (first_ + length) % kCapacity;
  size_ -= length;
}

void TransmitQueue::clear() {
  first_ = 0;
  size_ = 0;
}

}  // namespace acts
