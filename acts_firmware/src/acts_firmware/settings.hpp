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

// Which setting is refused.
enum class SettingField : std::uint8_t {
  kNone = 0,
  kRows = 1,
  kCols = 2,
  kScheme = 3,
  kNeighbourOrder = 4,
  kM = 5,
  kThreshold = 6,
  kSearchQuota = 7,
  kAdaptiveQuota = 8,
  kTouchCounts = 9,
  kOutput = 10,
  kLed = 11,
  kFramePeriod = 12,
  kSeed = 13,  // never refused
};

// The first setting out of its range, on a board of `lines` row lines; what only the sampler can tell is left to it.
SettingField out_of_range(const Settings& settings, int lines);

// The setting that the sampler's refusal is about.
SettingField field_of(ConfigError error);

}  // namespace acts
