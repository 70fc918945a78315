// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/fixed.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace acts {

void Fixed::begin(const SamplingConfig& config, const SkinMap& map) {
  const int taxel = config.own(kRow) * config.cols + config.own(kCol);
  int first = 0;
  while (map.taxel(first) != taxel) {
    ++first;
  }
  const auto remoteness = [&map, first](int place) {
    const int down = place / map.cols() - first / map.cols();
    const int across = place % map.cols() - first % map.cols();
    return std::make_tuple(!map.joined(first, place), down * down + across * across, place);
  };
  for (int place = 0; place < config.taxels(); ++place) {
    taxels_[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(place);
  }
  std::sort(taxels_.begin(), taxels_.begin() + config.taxels(),
            [&remoteness](int one, int other) { return remoteness(one) < remoteness(other); });
  const int wanted = config.own(kTaxels) != 0 ? config.own(kTaxels) : config.m;
  size_ = std::min(wanted, config.taxels());
  for (int i = 0; i < size_; ++i) {
    std::uint16_t& place = taxels_[static_cast<std::size_t>(i)];
    place = static_cast<std::uint16_t>(map.taxel(place));
  }
}

void Fixed::sample(const SamplingConfig& config, const SkinMap& /*map*/, Measurement& frame) {
  while (frame.size() < config.m) {
    frame.take(taxels_[static_cast<std::size_t>(frame.size() % size_)]);
  }
}

}  // namespace acts
