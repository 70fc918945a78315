// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The board on the host: virtual time, a pressure field, noise.
#pragma once

#include <cstdint>

#include "acts_firmware/sampling/random.hpp"
#include "board/wired_board.hpp"
#include "field/field.hpp"

namespace acts {

// Which time of the host is which time of the board.
class BoardTime {
 public:
  // Board time 0 is `epoch_monotonic_ns` of CLOCK_MONOTONIC; the board's clock is fast by `drift_ppm`.
  BoardTime(std::int64_t epoch_monotonic_ns, double drift_ppm)
      : epoch_ns_(epoch_monotonic_ns), board_per_host_(1.0 + drift_ppm * 1e-6) {}

  // From now on the board's clock is ahead by this much more.
  void jump(std::int64_t board_ns) { epoch_ns_ = to_host_ns(-board_ns); }

  std::int64_t to_host_ns(std::int64_t board_ns) const {
    return epoch_ns_ + static_cast<std::int64_t>(static_cast<double>(board_ns) / board_per_host_);
  }
  std::int64_t to_board_ns(std::int64_t host_ns) const {
    return static_cast<std::int64_t>(static_cast<double>(host_ns - epoch_ns_) * board_per_host_);
  }

 private:
  std::int64_t epoch_ns_;
  double board_per_host_;
};

// Measuring is what makes its time pass: each conversion takes a frame's `sample_ns` and sees the field at its own
// beginning.
class VirtualBoard final : public WiredBoard {
 public:
  // `field` and `time` outlive the board, whose power may be turned off and on.
  VirtualBoard(int rows, int cols, Field& field, const BoardTime& time, double noise_counts, std::uint64_t seed,
               std::uint64_t id);

  // Jump to a board time, the start of a frame whose measurements take `sample_ns` each.
  void begin_frame(std::int64_t start_ns, std::int64_t sample_ns);

  // What recovery or classification of a frame takes.
  void set_computing_ns(std::int64_t computing_ns) { computing_ns_ = computing_ns; }

  std::uint16_t read_adc() override;
  void computed() override { now_ns_ += computing_ns_; }
  std::uint32_t micros() override { return static_cast<std::uint32_t>(now_ns_ / 1000); }

 protected:
  double taxel_counts(int row, int col) override;

 private:
  double gaussian();

  int cols_;
  Field& field_;
  const BoardTime& time_;
  std::int64_t sample_ns_ = 0;
  double noise_counts_;
  Pcg32 random_;
  double spare_ = 0.0;
  bool has_spare_ = false;
  std::int64_t now_ns_ = 0;
  std::int64_t computing_ns_ = 0;
  std::int64_t now_host_ns_ = 0;
};

}  // namespace acts
