// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Every sampling scheme there is. All else is made of this list: dispatch, checks, settings on the wire, the virtual
// board's options.
#pragma once

#include <array>
#include <cstddef>
#include <variant>

#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/schemes/adaptive.hpp"
#include "acts_firmware/sampling/schemes/fixed.hpp"
#include "acts_firmware/sampling/schemes/hybrid.hpp"
#include "acts_firmware/sampling/schemes/random_taxels.hpp"
#include "acts_firmware/sampling/schemes/raster.hpp"
#include "acts_firmware/sampling/schemes/tracking.hpp"
#include "acts_firmware/sampling/schemes/uniform.hpp"

namespace acts {

template <typename... Each>
struct SchemeList {
  // Only one samples at a time, so they share their memory.
  using AnyOf = std::variant<Each...>;
  static constexpr std::array<SchemeInfo, sizeof...(Each)> kInfos = {Each::kInfo...};

  static bool takes(Scheme number, int rows, int cols, int m) {
    return ((Each::kInfo.number == number && Each::takes(rows, cols, m)) || ...);
  }

  // Makes the scheme of this number anew, in place of the one before.
  static void make(AnyOf& scheme, Scheme number) {
    (void)((Each::kInfo.number == number && (scheme.template emplace<Each>(), true)) || ...);
  }
};

// A new scheme: its header above, its class here.
using Schemes = SchemeList<Adaptive, Fixed, Hybrid, RandomTaxels, Raster, Tracking, Uniform>;

// Null for a number that no scheme has.
constexpr const SchemeInfo* scheme_info(Scheme number) {
  for (const SchemeInfo& info : Schemes::kInfos) {
    if (info.number == number) {
      return &info;
    }
  }
  return nullptr;
}

constexpr std::size_t count_own_settings() {
  std::size_t count = 0;
  for (const SchemeInfo& info : Schemes::kInfos) {
    for (const OwnSetting& setting : info.own_settings) {
      count += setting.number != 0 ? 1 : 0;
    }
  }
  return count;
}

// Own settings of all schemes together.
constexpr std::size_t kOwnSettings = count_own_settings();
static_assert(kOwnSettings <= kMaxOwnSettings, "raise kMaxOwnSettings");

// Every scheme's own settings in the order of their places.
constexpr std::array<OwnSetting, kOwnSettings> own_settings() {
  std::array<OwnSetting, kOwnSettings> settings{};
  for (const SchemeInfo& info : Schemes::kInfos) {
    for (const OwnSetting& setting : info.own_settings) {
      if (setting.number != 0) {
        settings[setting.place()] = setting;
      }
    }
  }
  return settings;
}

inline constexpr std::array<OwnSetting, kOwnSettings> kAllOwnSettings = own_settings();

// Numbers on the wire are given once, and those of own settings without a gap.
constexpr bool numbers_are_sound() {
  for (const SchemeInfo& info : Schemes::kInfos) {
    if (info.number == kNoScheme || scheme_info(info.number) != &info) {
      return false;
    }
  }
  for (const OwnSetting& setting : kAllOwnSettings) {
    if (setting.number == 0) {
      return false;
    }
  }
  return true;
}
static_assert(
    numbers_are_sound(),
    "numbers on the wire: each scheme's once; of own settings 7, 8, then 14 and on, each once, without a gap");

}  // namespace acts
