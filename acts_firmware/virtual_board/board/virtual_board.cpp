// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "board/virtual_board.hpp"

#include <cmath>

namespace acts {

namespace {

constexpr std::uint64_t kNoiseStream = 2;
constexpr double kTwoPi = 6.283185307179586;

}  // namespace

VirtualBoard::VirtualBoard(int rows, int cols, Field& field, const BoardTime& time, double noise_counts,
                           std::uint64_t seed, std::uint64_t id)
    : WiredBoard(rows, cols, id),
      cols_(cols),
      field_(field),
      time_(time),
      noise_counts_(noise_counts),
      random_(seed, kNoiseStream) {}

void VirtualBoard::begin_frame(std::int64_t start_ns, std::int64_t sample_ns) {
  now_ns_ = start_ns;
  sample_ns_ = sample_ns;
}

double VirtualBoard::taxel_counts(int row, int col) {
  return field_.counts(static_cast<std::size_t>(row * cols_ + col), now_host_ns_);
}

std::uint16_t VirtualBoard::read_adc() {
  now_host_ns_ = time_.to_host_ns(now_ns_);
  const double counts = adc_input();
  const double noise = noise_counts_ > 0.0 ? noise_counts_ * gaussian() : 0.0;
  now_ns_ += sample_ns_;
  return static_cast<std::uint16_t>(std::lround(clip_counts(counts + noise)));
}

// Box and Muller's transform.
double VirtualBoard::gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  constexpr double kScale = 1.0 / 4294967296.0;
  const double radius = std::sqrt(-2.0 * std::log((random_.next() + 1.0) * kScale));
  const double angle = kTwoPi * random_.next() * kScale;
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace acts
