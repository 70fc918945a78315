// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/adaptive.hpp"

namespace acts {

namespace {

struct Step {
  std::int8_t row;
  std::int8_t col;
};
constexpr int kNeighbours = 8;
using Steps = std::array<Step, kNeighbours>;

constexpr Steps kColumnsOuter = {{{-1, 0}, {1, 0}, {-1, -1}, {0, -1}, {1, -1}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr Steps kRowsOuter = {{{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

}  // namespace

void Adaptive::begin(const SamplingConfig& /*config*/, const SkinMap& map) {
  order_.build(map.rows(), map.cols());
}

void Adaptive::sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame) {
  sample_until(config.m, config, map, frame);
}

void Adaptive::sample_until(int m, const SamplingConfig& config, const SkinMap& map, Measurement& frame) {
  for (int rank = 0; rank < order_.size() && frame.size() < m; ++rank) {
    const int centre = order_[rank];
    if (!frame.has(map.taxel(centre)) && is_pressed(config, map, centre, frame)) {
      search(config, map, centre, m, frame);
    }
  }
}

// Measures a place.
bool Adaptive::is_pressed(const SamplingConfig& config, const SkinMap& map, int place, Measurement& frame) {
  return frame.take(map.taxel(place)) > config.threshold && map.has_skin(place);
}

// Depth first: the neighbours of a pressed neighbour come before the others.
void Adaptive::search(const SamplingConfig& config, const SkinMap& map, int pressed, int m, Measurement& frame) {
  const Steps& steps = config.neighbour_order == NeighbourOrder::kRows ? kRowsOuter : kColumnsOuter;
  std::size_t depth = 0;
  stack_[depth++] = {static_cast<std::uint16_t>(pressed), 0};
  while (depth > 0 && frame.size() < m) {
    Visit& visit = stack_[depth - 1];
    if (visit.next == kNeighbours) {
      --depth;
      continue;
    }
    const Step step = steps[visit.next++];
    const int row = visit.place / map.cols() + step.row;
    const int col = visit.place % map.cols() + step.col;
    if (row < 0 || row >= map.rows() || col < 0 || col >= map.cols()) {
      continue;
    }
    const int near = row * map.cols() + col;
    if (map.joined(visit.place, near) && !frame.has(map.taxel(near)) && is_pressed(config, map, near, frame)) {
      stack_[depth++] = {static_cast<std::uint16_t>(near), 0};
    }
  }
}

}  // namespace acts
