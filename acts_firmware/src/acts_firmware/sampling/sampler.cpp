// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/sampler.hpp"

namespace acts {

Sampler::Sampler() {
  map_.reset(config_.rows, config_.cols);
  configure(config_);
}

SettingField Sampler::configure(const SamplingConfig& config) {
  const SettingField refused = check(config);
  if (refused != SettingField::kNone) {
    return refused;
  }
  if (config.rows != config_.rows || config.cols != config_.cols) {
    map_.reset(config.rows, config.cols);
  }
  config_ = config;
  begin();
  return SettingField::kNone;
}

void Sampler::begin() {
  Schemes::make(scheme_, config_.scheme);
  std::visit([this](auto& scheme) { scheme.begin(config_, map_); }, scheme_);
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
  std::visit([&](auto& scheme) { scheme.sample(config_, map_, measurement); }, scheme_);
}

}  // namespace acts
