// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/random_taxels.hpp"

#include <utility>

namespace acts {

void RandomTaxels::begin(const SamplingConfig& config, const SkinMap& /*map*/) {
  taxels_ = static_cast<std::uint32_t>(config.taxels());
  random_ = Pcg32(config.seed, kStream);
  for (std::uint32_t i = 0; i < taxels_; ++i) {
    shuffled_[i] = place_[i] = static_cast<std::uint16_t>(i);
  }
}

void RandomTaxels::sample(const SamplingConfig& config, const SkinMap& /*map*/, Measurement& frame) {
  // What the frame has already goes to the front, in its order, where the shuffle begins behind it.
  const auto first = static_cast<std::uint32_t>(frame.size());
  for (std::uint32_t i = 0; i < first; ++i) {
    swap(i, place_[static_cast<std::size_t>(frame[static_cast<int>(i)])]);
  }
  for (std::uint32_t i = first; i < static_cast<std::uint32_t>(config.m); ++i) {
    swap(i, i + random_.below(taxels_ - i));
    frame.take(shuffled_[i]);
  }
}

void RandomTaxels::swap(std::uint32_t i, std::uint32_t j) {
  std::swap(shuffled_[i], shuffled_[j]);
  place_[shuffled_[i]] = static_cast<std::uint16_t>(i);
  place_[shuffled_[j]] = static_cast<std::uint16_t>(j);
}

}  // namespace acts
