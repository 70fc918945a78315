// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Everything that a host can tell the board; `BoardSettings` of acts_core is the same in Python.
#pragma once

#include <cstdint>

#include "acts_firmware/sampling/sampler.hpp"

namespace acts {

// What is sent besides samples. Numbers on the wire, here and below.
enum class Output : std::uint8_t { kSamples = 0, kImage = 1, kObject = 2 };

enum class LedMode : std::uint8_t {
  kOff = 0,
  kOn = 1,
  kFrames = 2,  // changes every 128 frames
  kTouch = 3,   // lit while a taxel of the last frame is touched
};

constexpr std::uint32_t kMaxFramePeriodUs = 1'000'000;

struct Settings {
  SamplingConfig sampling;
  int touch_counts = 60;  // counts above which recovery and the LED take a taxel for touched
  Output output = Output::kSamples;
  LedMode led = LedMode::kFrames;
  std::uint32_t frame_period_us = 1000;  // frames start no closer; whoever calls Firmware::measure_frame keeps to it
};

// The first setting out of its range, on a board of `lines` row lines; what only the sampler can tell is left to it.
SettingField out_of_range(const Settings& settings, int lines);

}  // namespace acts
