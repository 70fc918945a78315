#include "acts_firmware/sampling/sampler.hpp"

namespace acts {

Sampler::Sampler() {
  map_.reset(config_.rows, config_.cols);
  configure(config_);
}

ConfigError Sampler::configure(const SamplingConfig& config) {
  const ConfigError error = check(config);
  if (error != ConfigError::kNone) {
    return error;
  }
  if (config.rows != config_.rows || config.cols != config_.cols) {
    map_.reset(config.rows, config.cols);
  }
  config_ = config;
  begin();
  return ConfigError::kNone;
}

void Sampler::begin() {
  order_.build(map_.rows(), map_.cols());
  search_order_.build(map_.rows(), map_.cols());
  tracking_.reset();
  uniform_.reset(uniform_spacing(config_.rows, config_.cols, config_.m));
  random_.reset(config_.taxels(), config_.seed);
}

bool Sampler::put_map(int place, const std::uint8_t* entries, int count) {
  forget_map();
  return map_.put(place, entries, count);
}

bool Sampler::finish_map(int rows, int cols, int no_skin, std::uint32_t crc32) {
  // Said twice, because the reply was lost: nothing begins anew.
  if (map_.in_force() && map_.checksum() == crc32) {
    return true;
  }
  forget_map();
  if (!map_.finish(rows, cols, no_skin, crc32, config_.taxels())) {
    return false;
  }
  begin();
  return true;
}

void Sampler::forget_map() {
  if (map_.in_force()) {
    map_.reset(config_.rows, config_.cols);
    begin();
  }
}

void Sampler::sample(TaxelReader& reader, SampleFrame& frame) {
  frame.scheme = config_.scheme;
  frame.rows = static_cast<std::uint8_t>(config_.rows);
  frame.cols = static_cast<std::uint8_t>(config_.cols);
  frame.m = 0;
  Measurement measurement(reader, marks_, frame);
  switch (config_.scheme) {
    case Scheme::kAdaptive:
      adaptive_.sample(config_, map_, order_, config_.m, measurement);
      break;
    case Scheme::kTracking:
      tracking_.sample(config_, map_, search_order_, measurement);
      break;
    case Scheme::kHybrid:
      adaptive_.sample(config_, map_, order_, config_.adaptive_quota, measurement);
      random_.sample(config_.m, measurement);
      break;
    case Scheme::kUniform:
      uniform_.sample(config_, measurement);
      break;
    case Scheme::kRandom:
      random_.sample(config_.m, measurement);
      break;
    case Scheme::kRaster:
      for (int index = 0; index < config_.taxels(); ++index) {
        measurement.take(index);
      }
      break;
  }
}

}  // namespace acts
