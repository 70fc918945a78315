#include "acts_firmware/sampling/adaptive.hpp"

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

void Adaptive::sample(const SamplingConfig& config, const DivisionOrder& order, int m, Measurement& frame) {
  for (int rank = 0; rank < order.size() && frame.size() < m; ++rank) {
    const int centre = order[rank];
    if (!frame.has(centre) && frame.take(centre) > config.threshold) {
      search(config, centre, m, frame);
    }
  }
}

// Depth first: the neighbours of a pressed neighbour come before the others.
void Adaptive::search(const SamplingConfig& config, int pressed, int m, Measurement& frame) {
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
    const int row = visit.index / config.cols + step.row;
    const int col = visit.index % config.cols + step.col;
    if (row < 0 || row >= config.rows || col < 0 || col >= config.cols) {
      continue;
    }
    const int index = row * config.cols + col;
    if (!frame.has(index) && frame.take(index) > config.threshold) {
      stack_[depth++] = {static_cast<std::uint16_t>(index), 0};
    }
  }
}

}  // namespace acts
