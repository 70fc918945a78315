// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a board is told about sampling.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/frame.hpp"
#include "acts_firmware/sampling/scheme.hpp"

namespace acts {

enum class NeighbourOrder : std::uint8_t {
  kColumns = 0,  // columns outer 0, -1, +1, rows inner -1, 0, +1: the published sketches
  kRows = 1,     // rows outer -1, 0, +1, columns inner -1, 0, +1: fits the frames of the paper's figures 4 and 5
};

// Which setting is refused, by its number on the wire. Numbers 7, 8, 14 and on are the schemes' own settings.
enum class SettingField : std::uint8_t {
  kNone = 0,
  kRows = 1,
  kCols = 2,
  kScheme = 3,
  kNeighbourOrder = 4,
  kM = 5,
  kThreshold = 6,
  kTouchCounts = 9,
  kOutput = 10,
  kLed = 11,
  kFramePeriod = 12,
  kSeed = 13,  // never refused
};

// The value of every scheme's own settings, by their place.
using OwnValues = std::array<int, kMaxOwnSettings>;
OwnValues initial_own_values();

struct SamplingConfig {
  int rows = 32;
  int cols = 32;
  Scheme scheme = initial_scheme();
  int m = 55;           // taxels per frame; raster measures all
  int threshold = 180;  // counts; above it adaptive and hybrid search the neighbours, tracking follows the taxel
  NeighbourOrder neighbour_order = NeighbourOrder::kColumns;
  std::uint64_t seed = 1;  // of random and hybrid sampling
  OwnValues own_values = initial_own_values();

  int taxels() const { return rows * cols; }

  // Taxels a frame will hold; known beforehand for every scheme.
  int frame_size() const;

  int own(const OwnSetting& setting) const { return own_values[setting.place()]; }
  void set_own(const OwnSetting& setting, int value) { own_values[setting.place()] = value; }

 private:
  static Scheme initial_scheme();
};

bool operator==(const SamplingConfig& one, const SamplingConfig& other);

// The first setting with which a sampler could not work; what is only out of its range on the wire is left out.
SettingField check(const SamplingConfig& config);

constexpr bool within(int value, int minimum, int maximum) {
  return minimum <= value && value <= maximum;
}

// The number of taxels that is a share (above 0, up to 1) of m, rounded up.
int quota_of(double share, int m);

}  // namespace acts
