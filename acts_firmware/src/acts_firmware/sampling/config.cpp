#include "acts_firmware/sampling/config.hpp"

#include <cmath>

#include "acts_firmware/sampling/uniform.hpp"

namespace acts {

namespace {

constexpr bool known(Scheme scheme) {
  switch (scheme) {
    case Scheme::kUniform:
    case Scheme::kRandom:
    case Scheme::kAdaptive:
    case Scheme::kRaster:
    case Scheme::kHybrid:
    case Scheme::kTracking:
      return true;
  }
  return false;
}

constexpr bool within(int value, int first, int last) {
  return first <= value && value <= last;
}

}  // namespace

bool operator==(const SamplingConfig& one, const SamplingConfig& other) {
  return one.rows == other.rows && one.cols == other.cols && one.scheme == other.scheme && one.m == other.m &&
         one.threshold == other.threshold && one.neighbour_order == other.neighbour_order && one.seed == other.seed &&
         one.search_quota == other.search_quota && one.adaptive_quota == other.adaptive_quota;
}

ConfigError check(const SamplingConfig& config) {
  if (!within(config.rows, 1, kMaxSide) || !within(config.cols, 1, kMaxSide)) {
    return ConfigError::kSize;
  }
  if (!known(config.scheme)) {
    return ConfigError::kScheme;
  }
  if (config.scheme != Scheme::kRaster && !within(config.m, 1, config.taxels())) {
    return ConfigError::kM;
  }
  if (!within(config.threshold, 0, kCountMax)) {
    return ConfigError::kThreshold;
  }
  if (config.scheme == Scheme::kUniform && uniform_spacing(config.rows, config.cols, config.m).row == 0) {
    return ConfigError::kUniformM;
  }
  if (config.scheme == Scheme::kTracking && !within(config.search_quota, 1, config.m)) {
    return ConfigError::kSearchQuota;
  }
  if (config.scheme == Scheme::kHybrid && !within(config.adaptive_quota, 1, config.m)) {
    return ConfigError::kAdaptiveQuota;
  }
  return ConfigError::kNone;
}

int quota_of(double share, int m) {
  return static_cast<int>(std::ceil(share * m));
}

}  // namespace acts
