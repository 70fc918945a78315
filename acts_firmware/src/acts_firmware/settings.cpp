#include "acts_firmware/settings.hpp"

namespace acts {

namespace {

constexpr bool within(int value, int minimum, int maximum) {
  return value >= minimum && value <= maximum;
}

}  // namespace

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
  if (!within(sampling.search_quota, 0, kMaxTaxels)) {
    return SettingField::kSearchQuota;
  }
  if (!within(sampling.adaptive_quota, 0, kMaxTaxels)) {
    return SettingField::kAdaptiveQuota;
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

SettingField field_of(ConfigError error) {
  switch (error) {
    case ConfigError::kNone:
      break;
    case ConfigError::kSize:
      return SettingField::kRows;
    case ConfigError::kScheme:
      return SettingField::kScheme;
    case ConfigError::kM:
    case ConfigError::kUniformM:
      return SettingField::kM;
    case ConfigError::kThreshold:
      return SettingField::kThreshold;
    case ConfigError::kSearchQuota:
      return SettingField::kSearchQuota;
    case ConfigError::kAdaptiveQuota:
      return SettingField::kAdaptiveQuota;
  }
  return SettingField::kNone;
}

}  // namespace acts
