// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a sampling scheme tells of itself. acts_core/sampling/basis/scheme.py is the same in Python; a test compares the
// two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acts_firmware/frame.hpp"
#include "acts_firmware/limits.hpp"

namespace acts {

// Own settings of all schemes together.
constexpr std::size_t kMaxOwnSettings = 8;

// What a setting is less than in a frame of its scheme.
enum class Below : std::uint8_t { kNothing, kRows, kCols };

// A setting that only one scheme has: on the wire a whole number of 16 bits, for a user perhaps a share of the frame.
struct OwnSetting {
  std::uint8_t number = 0;  // on the wire: 7, 8, then 14 and on
  const char* name = "";
  const char* description = "";
  int initial = 0;
  int minimum = 0;
  int maximum = 0;
  // Where a user gives it as a share of m, 0.0001 to 1: the name of that. The setting is then 1 to m in a frame of its
  // scheme.
  const char* share_name = nullptr;
  const char* share_description = "";
  double share_initial = 0.0;
  Below below = Below::kNothing;

  constexpr bool is_share() const { return share_name != nullptr; }

  // Its place among all schemes' own settings: two lie in the midst of the settings on the wire, the others behind.
  constexpr std::size_t place() const { return number < 14U ? number - 7U : number - 12U; }
};

// Up to three own settings of one scheme; those that it does not use have the number 0.
using OwnSettings = std::array<OwnSetting, 3>;

struct SchemeInfo {
  const char* name;
  Scheme number;
  const char* description;  // "a frame is ..."
  OwnSettings own_settings = {};
  bool measures_all = false;  // every taxel, whatever m says
};

// What a scheme has unless it says otherwise.
struct SchemeDefaults {
  // Whether frames of m taxels of such an array can be, beyond 1 <= m <= rows * cols.
  static bool takes(int /*rows*/, int /*cols*/, int /*m*/) { return true; }
};

}  // namespace acts
