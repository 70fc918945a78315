// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Command line of the virtual board.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "acts_firmware/firmware.hpp"
#include "acts_firmware/sampling/sampler.hpp"
#include "board/wired_board.hpp"
#include "board/wiring_faults.hpp"
#include "faults.hpp"
#include "option_error.hpp"
#include "realtime.hpp"

namespace acts {

// The shares of a frame that schemes' own settings are given as, by their place.
using Shares = std::array<double, kMaxOwnSettings>;
Shares initial_shares();

struct Options {
  bool help = false;
  std::string link;        // empty: none
  std::string field_ring;  // empty: none
  std::string recording;   // empty: none
  double recording_rate_hz = 1000.0;
  bool loop = false;
  SamplingConfig sampling;
  Shares shares = initial_shares();
  double rate_hz = 1000.0;
  double sample_us = 0.0;             // of one measurement; 0: as published
  std::optional<double> recovery_us;  // of recovery or classification; none: as published
  double noise_counts = 1.5;
  double drift_ppm = 0.0;
  std::uint64_t board_id = kVirtualBoardId;
  WiringFaults wiring_faults;
  Protocol protocol = Protocol::kBinary;
  std::vector<Fault> faults;
  std::string control;  // empty: none
  Realtime realtime;
  bool print_status = false;
  double status_period_s = 0.0;  // 0: none
};

// Everything from --ros-args on is left alone, so that ros2 launch can start the board as a node.
Options parse_options(int argc, const char* const* argv);

std::string help_text();

const char* name_of(Scheme scheme);

}  // namespace acts
