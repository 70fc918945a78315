// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "link/faulty_link.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "acts_firmware/wire/packet.hpp"

namespace acts {

namespace {

constexpr std::uint64_t kFaultStream = 3;
constexpr std::uint8_t kLineEnd = '\n';
constexpr std::size_t kVersionAt = 1;
// The type of a packet is never zero, so COBS leaves it as it is, behind its own first byte.
constexpr std::size_t kTypeOnWireAt = 1;

bool cuts_the_stream(const Fault& fault) {
  return fault.kind == FaultKind::kUnplug || fault.kind == FaultKind::kReset;
}

bool counts_frames(const Fault& fault) {
  return fault.kind == FaultKind::kDrop || fault.kind == FaultKind::kDouble || fault.kind == FaultKind::kTruncate;
}

}  // namespace

FaultyLink::FaultyLink(std::uint64_t seed, Protocol protocol, Report report)
    : random_(seed, kFaultStream), protocol_(protocol), report_(std::move(report)) {}

void FaultyLink::arm(const Fault& fault) {
  if (fault.kind == FaultKind::kFlipRate) {
    flip_rate_ = fault.value;
    report_(fault, flip_rate_ == 0.0);
  } else if (fault.kind == FaultKind::kVersion) {
    version_ = static_cast<std::uint8_t>(fault.value);
    report_(fault, version_ == kPacketVersion);
  } else {
    armed_.push_back(fault);
  }
}

std::optional<Fault> FaultyLink::send(TransmitQueue& output, PseudoTerminal& terminal, std::int64_t monotonic_ns) {
  if (monotonic_ns < stalled_until_ns_) {
    return std::nullopt;
  }
  if (stall_) {
    report_(*stall_, true);
    stall_.reset();
  }
  for (;;) {
    if (sent_ == packet_.size() && !fetch(output)) {
      return std::nullopt;
    }
    const std::size_t end = interruption_ ? cut_at_ : packet_.size();
    if (sent_ < end) {
      sent_ += terminal.write(packet_.data() + sent_, end - sent_);
    }
    const bool is_full = sent_ < end;
    // A plug that is drawn does not wait for a slow reader.
    if (interruption_ && (!is_full || cuts_the_stream(*interruption_))) {
      const Fault fault = *interruption_;
      interruption_.reset();
      if (cuts_the_stream(fault)) {
        return fault;
      }
      stall_ = fault;
      stalled_until_ns_ = monotonic_ns + fault.value_ns();
      report_(fault, false);
      return std::nullopt;
    }
    if (is_full) {
      return std::nullopt;  // the rest goes first next time
    }
  }
}

std::optional<Fault> FaultyLink::take_cut() {
  if (interruption_ && cuts_the_stream(*interruption_)) {
    return std::exchange(interruption_, std::nullopt);
  }
  const auto found = std::find_if(armed_.begin(), armed_.end(), cuts_the_stream);
  if (found == armed_.end()) {
    return std::nullopt;
  }
  const Fault fault = *found;
  armed_.erase(found);
  return fault;
}

void FaultyLink::clear() {
  if (interruption_) {
    armed_.push_front(*interruption_);  // it meets the next stream
    interruption_.reset();
  }
  packet_.clear();
  sent_ = 0;
}

bool FaultyLink::fetch(TransmitQueue& output) {
  packet_.clear();
  sent_ = 0;
  const std::uint8_t delimiter = protocol_ == Protocol::kBinary ? kDelimiter : kLineEnd;
  // Messages come whole, though a queue's end may part one in two.
  for (bool whole = false; !whole && output.size() > 0;) {
    const TransmitQueue::Piece piece = output.front();
    const auto* end = static_cast<const std::uint8_t*>(std::memchr(piece.data, delimiter, piece.length));
    whole = end != nullptr;
    const std::size_t length = whole ? static_cast<std::size_t>(end - piece.data) + 1 : piece.length;
    packet_.insert(packet_.end(), piece.data, piece.data + length);
    output.pop(length);
  }
  // The delimiter that begins a stream is left alone.
  if (packet_.size() > 1) {
    distort();
    return true;
  }
  return !packet_.empty();
}

bool FaultyLink::is_frame() const {
  return protocol_ != Protocol::kBinary ||
         (packet_.size() > kTypeOnWireAt && packet_[kTypeOnWireAt] == static_cast<std::uint8_t>(PacketType::kSamples));
}

void FaultyLink::distort() {
  if (version_ != kPacketVersion && protocol_ == Protocol::kBinary) {
    set_version();
  }
  if (!armed_.empty()) {
    distort_once();
  }
  if (flip_rate_ > 0.0) {
    flip_bits_at_rate();
  }
}

void FaultyLink::distort_once() {
  const Fault fault = armed_.front();
  if (fault.kind == FaultKind::kStall || cuts_the_stream(fault)) {
    armed_.pop_front();
    interruption_ = fault;
    cut_at_ = 1 + random_.below(static_cast<std::uint32_t>(packet_.size()) - 1);
    return;
  }
  if (counts_frames(fault) && !is_frame()) {
    return;
  }
  const bool begins = left_ == 0.0;
  if (begins) {
    left_ = fault.value;
    report_(fault, false);
  }
  left_ -= change_packet(fault, begins);
  if (left_ == 0.0) {
    report_(fault, true);
    armed_.pop_front();
  }
}

double FaultyLink::change_packet(const Fault& fault, bool begins) {
  const auto size = static_cast<std::uint32_t>(packet_.size());
  const auto count = static_cast<std::size_t>(fault.value);
  switch (fault.kind) {
    case FaultKind::kGarbage:
      scratch_.resize(count);
      std::generate(scratch_.begin(), scratch_.end(), [this] { return static_cast<std::uint8_t>(random_.below(256)); });
      packet_.insert(packet_.begin(), scratch_.begin(), scratch_.end());
      return fault.value;
    case FaultKind::kFlip:
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t bit = random_.below(8 * size);
        packet_[bit / 8] = static_cast<std::uint8_t>(packet_[bit / 8] ^ 1U << bit % 8);
      }
      return fault.value;
    case FaultKind::kDrop:
      packet_.clear();
      return 1.0;
    case FaultKind::kDouble:
      scratch_ = packet_;
      packet_.insert(packet_.end(), scratch_.begin(), scratch_.end());
      return 1.0;
    case FaultKind::kTruncate:
      packet_.erase(packet_.begin() + random_.below(size - 1), packet_.end() - 1);
      return 1.0;
    case FaultKind::kLose: {
      const std::uint32_t from = begins ? random_.below(size) : 0;
      const double lost = std::min(left_, static_cast<double>(size - from));
      packet_.erase(packet_.begin() + from, packet_.begin() + from + static_cast<std::ptrdiff_t>(lost));
      return lost;
    }
    default:  // is none of a packet
      return fault.value;
  }
}

void FaultyLink::flip_bits_at_rate() {
  const double bits = 8.0 * static_cast<double>(packet_.size());
  // From one flipped bit to the next: the distances are geometrically distributed.
  for (double bit = -1.0;;) {
    const double chance = (random_.next() + 0.5) / 4294967296.0;
    bit += flip_rate_ < 1.0 ? 1.0 + std::floor(std::log(chance) / std::log1p(-flip_rate_)) : 1.0;
    if (bit >= bits) {
      return;
    }
    const auto at = static_cast<std::size_t>(bit);
    packet_[at / 8] = static_cast<std::uint8_t>(packet_[at / 8] ^ 1U << at % 8);
  }
}

void FaultyLink::set_version() {
  scratch_.resize(packet_.size());
  const std::size_t length = cobs_decode(packet_.data(), packet_.size() - 1, scratch_.data());
  if (length <= kVersionAt + kPacketCrcBytes) {
    return;
  }
  scratch_[kVersionAt] = version_;
  const std::uint32_t crc = crc32(scratch_.data(), length - kPacketCrcBytes);
  for (std::size_t i = 0; i < kPacketCrcBytes; ++i) {
    scratch_[length - kPacketCrcBytes + i] = static_cast<std::uint8_t>(crc >> (8 * i) & 0xFFU);
  }
  packet_.resize(cobs_bytes_max(length) + 1);
  packet_.resize(cobs_encode(scratch_.data(), length, packet_.data()) + 1);
  packet_.back() = kDelimiter;
}

}  // namespace acts
