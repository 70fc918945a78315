// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The way from the firmware's output to the terminal, and what may befall a packet on it.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "acts_firmware/firmware.hpp"
#include "acts_firmware/sampling/random.hpp"
#include "acts_firmware/wire/transmit_queue.hpp"
#include "faults.hpp"
#include "link/pseudo_terminal.hpp"

namespace acts {

// Moves one packet at a time, so that what a slow reader leaves waits in the firmware's own queue.
class FaultyLink {
 public:
  // Told that a fault begins, or is over.
  using Report = std::function<void(const Fault&, bool is_over)>;

  FaultyLink(std::uint64_t seed, Protocol protocol, Report report);

  // Faults of packets meet the packets to come, one after the other.
  void arm(const Fault& fault);

  // Sends what the terminal takes. Returns a fault that cuts the stream now: the caller carries it out.
  std::optional<Fault> send(TransmitQueue& output, PseudoTerminal& terminal, std::int64_t monotonic_ns);

  // Whether the terminal had no room for all of a packet.
  bool has_rest() const { return sent_ < packet_.size(); }

  // An armed fault that cuts the stream, for a stream that nobody reads.
  std::optional<Fault> take_cut();

  // The host's end was opened or closed, or the board restarted: what is left of a packet is gone.
  void clear();

 private:
  bool fetch(TransmitQueue& output);
  bool is_frame() const;
  void distort();
  void distort_once();
  // Does to the packet what a fault does; returns how much of the fault's value that was.
  double change_packet(const Fault& fault, bool begins);
  void flip_bits_at_rate();
  void set_version();

  Pcg32 random_;
  Protocol protocol_;
  Report report_;
  std::deque<Fault> armed_;
  double left_ = 0.0;                  // frames or bytes that the first armed fault still concerns; 0: not begun
  std::optional<Fault> interruption_;  // comes when `cut_at_` bytes of the packet are out
  std::size_t cut_at_ = 0;
  std::optional<Fault> stall_;
  std::int64_t stalled_until_ns_ = 0;
  double flip_rate_ = 0.0;
  std::uint8_t version_ = kPacketVersion;
  std::vector<std::uint8_t> packet_;  // delimiter included
  std::vector<std::uint8_t> scratch_;
  std::size_t sent_ = 0;
};

}  // namespace acts
