// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/led.hpp"

#include <algorithm>

namespace acts {

namespace {

constexpr std::uint32_t kFramesPerChange = 128;  // at 1 kHz it blinks four times a second

}  // namespace

void Led::show(LedMode mode) {
  if (mode == LedMode::kOff || mode == LedMode::kOn) {
    light(mode == LedMode::kOn);
  }
}

void Led::show(LedMode mode, const SampleFrame& frame, int touch_counts) {
  if (mode == LedMode::kFrames) {
    light(frame.sequence / kFramesPerChange % 2 != 0);
  } else if (mode == LedMode::kTouch) {
    light(std::any_of(frame.counts.begin(), frame.counts.begin() + frame.m,
                      [touch_counts](std::uint16_t count) { return count > touch_counts; }));
  }
}

void Led::light(bool on) {
  if (on != lit_) {
    board_.write_pin(pin_, on);
    lit_ = on;
  }
}

}  // namespace acts
