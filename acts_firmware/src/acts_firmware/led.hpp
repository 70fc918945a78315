// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the board's LED shows.
#pragma once

#include <cstdint>

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/settings.hpp"

namespace acts {

class Led {
 public:
  Led(Board& board, std::uint8_t pin) : board_(board), pin_(pin) { board_.write_pin(pin_, false); }

  // Settings have changed: what does not wait for a frame shows at once.
  void show(LedMode mode);

  // A frame was measured.
  void show(LedMode mode, const SampleFrame& frame, int touch_counts);

 private:
  void light(bool on);

  Board& board_;
  std::uint8_t pin_;
  bool lit_ = false;
};

}  // namespace acts
