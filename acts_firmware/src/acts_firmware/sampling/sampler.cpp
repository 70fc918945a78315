#include "acts_firmware/sampling/sampler.hpp"

namespace acts {

Sampler::Sampler() {
  configure(config_);
}

ConfigError Sampler::configure(const SamplingConfig& config) {
  const ConfigError error = check(config);
  if (error != ConfigError::kNone) {
    return error;
  }
  config_ = config;
  order_.build(config.rows, config.cols);
  search_order_.build(config.rows, config.cols);
  tracking_.reset();
  uniform_.reset(uniform_spacing(config.rows, config.cols, config.m));
  random_.reset(config.taxels(), config.seed);
  return ConfigError::kNone;
}

void Sampler::sample(TaxelReader& reader, SampleFrame& frame) {
  frame.scheme = config_.scheme;
  frame.rows = static_cast<std::uint8_t>(config_.rows);
  frame.cols = static_cast<std::uint8_t>(config_.cols);
  frame.m = 0;
  Measurement measurement(reader, marks_, frame);
  switch (config_.scheme) {
    case Scheme::kAdaptive:
      adaptive_.sample(config_, order_, config_.m, measurement);
      break;
    case Scheme::kTracking:
      tracking_.sample(config_, search_order_, measurement);
      break;
    case Scheme::kHybrid:
      adaptive_.sample(config_, order_, config_.adaptive_quota, measurement);
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
