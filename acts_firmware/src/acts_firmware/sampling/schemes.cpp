// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes.hpp"

#include <algorithm>
#include <cmath>

#include "acts_firmware/sampling/settings.hpp"

namespace acts {

namespace {

// Of a setting in a frame of its scheme.
int largest(const OwnSetting& setting, const SamplingConfig& config) {
  switch (setting.below) {
    case Below::kRows:
      return config.rows - 1;
    case Below::kCols:
      return config.cols - 1;
    case Below::kNothing:
      break;
  }
  return setting.is_share() ? config.m : setting.maximum;
}

}  // namespace

Scheme SamplingConfig::initial_scheme() {
  return Adaptive::kInfo.number;
}

OwnValues initial_own_values() {
  OwnValues values{};
  for (const OwnSetting& setting : kAllOwnSettings) {
    values[setting.place()] = setting.initial;
  }
  return values;
}

int SamplingConfig::frame_size() const {
  const SchemeInfo* info = scheme_info(scheme);
  return info != nullptr && info->measures_all ? taxels() : m;
}

bool operator==(const SamplingConfig& one, const SamplingConfig& other) {
  return one.rows == other.rows && one.cols == other.cols && one.scheme == other.scheme && one.m == other.m &&
         one.threshold == other.threshold && one.neighbour_order == other.neighbour_order && one.seed == other.seed &&
         one.own_values == other.own_values;
}

SettingField check(const SamplingConfig& config) {
  if (!within(config.rows, 1, kMaxSide)) {
    return SettingField::kRows;
  }
  if (!within(config.cols, 1, kMaxSide)) {
    return SettingField::kCols;
  }
  const SchemeInfo* info = scheme_info(config.scheme);
  if (info == nullptr) {
    return SettingField::kScheme;
  }
  if (!info->measures_all && !within(config.m, 1, config.taxels())) {
    return SettingField::kM;
  }
  if (!within(config.threshold, 0, kCountMax)) {
    return SettingField::kThreshold;
  }
  if (!Schemes::takes(config.scheme, config.rows, config.cols, config.m)) {
    return SettingField::kM;
  }
  for (const OwnSetting& setting : info->own_settings) {
    const int first = setting.is_share() ? 1 : setting.minimum;
    if (setting.number != 0 && !within(config.own(setting), first, largest(setting, config))) {
      return static_cast<SettingField>(setting.number);
    }
  }
  return SettingField::kNone;
}

int quota_of(double share, int m) {
  // More than the product is off in binary: 0.55 * 100 is 55.00000000000001.
  constexpr double kRounding = 1e-9;
  return std::max(static_cast<int>(std::ceil(share * m - kRounding)), 1);
}

}  // namespace acts
