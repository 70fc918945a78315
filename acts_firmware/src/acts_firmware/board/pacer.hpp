// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// When frames begin.
#pragma once

#include <algorithm>
#include <cstdint>

namespace acts {

// Frames begin on a grid of the period asked for, so that the rate is right on average although one may be a little
// late. Where measuring takes longer than the period they follow end to end. All times are micros(), which may wrap;
// must be asked more often than that.
class FramePacer {
 public:
  // Held up for longer than this, frames count as skipped.
  static constexpr std::uint32_t kCatchUpUs = 250000;

  // Ask in every round of the loop: that the board was free is known by this.
  bool due(std::uint32_t now_us, std::uint32_t period_us) {
    if (!started_ || now_us - grid_us_ >= period_us) {
      return true;
    }
    free_us_ = now_us;
    return false;
  }

  // A frame begins. Returns how many should have begun before it but could not: something other than measuring held
  // the board up. Frames that take longer than the period would have begun at that distance.
  std::uint32_t begin(std::uint32_t now_us, std::uint32_t period_us) {
    begun_us_ = now_us;
    if (!started_) {
      started_ = true;
      grid_us_ = now_us;
      return 0;
    }
    const std::uint32_t late_us = now_us - grid_us_ - period_us;
    // A frame is late by a shorter period, too, which has come since the last one; nothing held the board up then.
    const std::uint32_t held_us = std::min(late_us, now_us - free_us_);
    const std::uint32_t step_us = std::max(period_us, busy_us_);
    if (held_us > kCatchUpUs && step_us > 0) {
      grid_us_ = now_us;
      return held_us / step_us;
    }
    grid_us_ = late_us >= period_us ? now_us : grid_us_ + period_us;
    return 0;
  }

  // It has been measured.
  void end(std::uint32_t now_us) {
    free_us_ = now_us;
    busy_us_ = now_us - begun_us_;
  }

 private:
  bool started_ = false;
  std::uint32_t grid_us_ = 0;  // when the last frame should have begun
  std::uint32_t begun_us_ = 0;
  std::uint32_t busy_us_ = 0;  // how long the last frame took
  std::uint32_t free_us_ = 0;  // when the board last had nothing to measure
};

}  // namespace acts
