// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/settings.hpp"

namespace acts {

SettingField out_of_range(const Settings& settings, int lines) {
  const SamplingConfig& sampling = settings.sampling;
  if (!within(sampling.rows, 1, lines)) {
    return SettingField::kRows;
  }
  if (!within(sampling.cols, 1, lines)) {
    return SettingField::kCols;
  }
  if (sampling.neighbour_order > NeighbourOrder::kRows) {
    return SettingField::kNeighbourOrder;
  }
  if (!within(sampling.m, 1, kMaxTaxels)) {
    return SettingField::kM;
  }
  for (const OwnSetting& setting : kAllOwnSettings) {
    if (!within(sampling.own(setting), setting.minimum, setting.maximum)) {
      return static_cast<SettingField>(setting.number);
    }
  }
  if (!within(settings.touch_counts, 0, kCountMax)) {
    return SettingField::kTouchCounts;
  }
  if (settings.output > Output::kObject) {
    return SettingField::kOutput;
  }
  if (settings.led > LedMode::kTouch) {
    return SettingField::kLed;
  }
  if (settings.frame_period_us > kMaxFramePeriodUs) {
    return SettingField::kFramePeriod;
  }
  return SettingField::kNone;
}

}  // namespace acts
