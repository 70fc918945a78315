#include "acts_firmware/sampling/sampler.hpp"

#include <algorithm>
#include <cmath>

namespace acts {

namespace {

constexpr std::uint64_t kRandomStream = 1;

struct Step {
  std::int8_t row;
  std::int8_t col;
};
constexpr int kNeighbours = 8;
using Steps = std::array<Step, kNeighbours>;

constexpr Steps kColumnsOuter = {{{-1, 0}, {1, 0}, {-1, -1}, {0, -1}, {1, -1}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr Steps kRowsOuter = {{{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

constexpr int divide_up(int a, int b) {
  return (a + b - 1) / b;
}

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

}  // namespace

Spacing uniform_spacing(int rows, int cols, int m) {
  Spacing best;
  for (int grid_rows = 1; grid_rows <= rows; ++grid_rows) {
    const int grid_cols = m / grid_rows;
    if (m % grid_rows != 0 || grid_cols < 1 || grid_cols > cols) {
      continue;
    }
    const Spacing spacing = {divide_up(rows, grid_rows), divide_up(cols, grid_cols)};
    if (divide_up(rows, spacing.row) != grid_rows || divide_up(cols, spacing.col) != grid_cols) {
      continue;
    }
    // Ratios of the larger to the smaller spacing, compared without division.
    const int ratio = std::max(spacing.row, spacing.col) * std::min(best.row, best.col);
    const int best_ratio = std::max(best.row, best.col) * std::min(spacing.row, spacing.col);
    const bool better =
        ratio < best_ratio || (ratio == best_ratio && spacing.row >= spacing.col && best.row < best.col);
    if (best.row == 0 || better) {
      best = spacing;
    }
  }
  return best;
}

int quota_of(double share, int m) {
  return static_cast<int>(std::ceil(share * m));
}

Sampler::Sampler() : random_(config_.seed, kRandomStream) {
  configure(config_);
}

ConfigError Sampler::configure(const SamplingConfig& config) {
  if (config.rows < 1 || config.rows > kMaxSide || config.cols < 1 || config.cols > kMaxSide) {
    return ConfigError::kSize;
  }
  if (!known(config.scheme)) {
    return ConfigError::kScheme;
  }
  const int taxels = config.rows * config.cols;
  if (config.scheme != Scheme::kRaster && (config.m < 1 || config.m > taxels)) {
    return ConfigError::kM;
  }
  if (config.threshold < 0 || config.threshold > kCountMax) {
    return ConfigError::kThreshold;
  }
  const Spacing spacing = uniform_spacing(config.rows, config.cols, config.m);
  if (config.scheme == Scheme::kUniform && spacing.row == 0) {
    return ConfigError::kUniformM;
  }
  if (config.scheme == Scheme::kTracking && (config.search_quota < 1 || config.search_quota > config.m)) {
    return ConfigError::kSearchQuota;
  }
  if (config.scheme == Scheme::kHybrid && (config.adaptive_quota < 1 || config.adaptive_quota > config.m)) {
    return ConfigError::kAdaptiveQuota;
  }
  config_ = config;
  spacing_ = spacing;
  order_.build(config.rows, config.cols);
  offset_ = 0;
  random_ = Pcg32(config.seed, kRandomStream);
  for (int i = 0; i < taxels; ++i) {
    shuffled_[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(i);
    place_[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(i);
  }
  mark_.fill(0);
  frame_mark_ = 0;
  pressed_.fill(false);
  pressed_near_.fill(0);
  cursor_ = 0;
  walk_ = 0;
  return ConfigError::kNone;
}

void Sampler::sample(TaxelReader& reader, SampleFrame& frame) {
  frame.scheme = config_.scheme;
  frame.rows = static_cast<std::uint8_t>(config_.rows);
  frame.cols = static_cast<std::uint8_t>(config_.cols);
  frame.m = 0;
  switch (config_.scheme) {
    case Scheme::kAdaptive:
      adaptive(reader, frame, config_.m);
      break;
    case Scheme::kHybrid:
      hybrid(reader, frame);
      break;
    case Scheme::kUniform:
      uniform(reader, frame);
      break;
    case Scheme::kRandom:
      random(reader, frame);
      break;
    case Scheme::kRaster:
      raster(reader, frame);
      break;
    case Scheme::kTracking:
      tracking(reader, frame);
      break;
  }
}

void Sampler::begin_marks() {
  if (++frame_mark_ == 0) {
    mark_.fill(0);
    frame_mark_ = 1;
  }
}

bool Sampler::touched(TaxelReader& reader, SampleFrame& frame, int index) {
  const std::uint16_t count = reader.measure(index / config_.cols, index % config_.cols);
  mark_[static_cast<std::size_t>(index)] = frame_mark_;
  frame.append(index, count);
  return count > config_.threshold;
}

// Paper, Supplemental Algorithm 1, with the two points in which the published firmware differs from it: exactly m
// taxels are measured, and the threshold itself does not count as a touch.
void Sampler::adaptive(TaxelReader& reader, SampleFrame& frame, int m) {
  const Steps& steps = config_.neighbour_order == NeighbourOrder::kRows ? kRowsOuter : kColumnsOuter;
  begin_marks();
  for (int rank = 0; rank < order_.size() && !frame.full(m); ++rank) {
    const int centre = order_[rank];
    if (mark_[static_cast<std::size_t>(centre)] == frame_mark_ || !touched(reader, frame, centre)) {
      continue;
    }
    // A stack instead of recursion: a palm on the skin is a thousand levels deep.
    std::size_t depth = 0;
    stack_[depth++] = {static_cast<std::uint16_t>(centre), 0};
    while (depth > 0 && !frame.full(m)) {
      Visit& visit = stack_[depth - 1];
      if (visit.next == kNeighbours) {
        --depth;
        continue;
      }
      const Step step = steps[visit.next++];
      const int row = visit.index / config_.cols + step.row;
      const int col = visit.index % config_.cols + step.col;
      if (row < 0 || row >= config_.rows || col < 0 || col >= config_.cols) {
        continue;
      }
      const int index = row * config_.cols + col;
      if (mark_[static_cast<std::size_t>(index)] != frame_mark_ && touched(reader, frame, index)) {
        stack_[depth++] = {static_cast<std::uint16_t>(index), 0};
      }
    }
  }
}

// Candidates are what was pressed, and its neighbours. They get at most m - search_quota taxels of a frame, in turns; a
// search that goes on from frame to frame gets the rest. So every taxel is measured at least once in any
// ceil(rows * cols / search_quota) frames, and every lasting candidate at least once in any
// ceil(candidates / (m - search_quota)).
void Sampler::tracking(TaxelReader& reader, SampleFrame& frame) {
  begin_marks();
  const int followed = list_candidates(config_.m - config_.search_quota);
  for (int i = 0; i < followed; ++i) {
    track(reader, frame, candidates_[static_cast<std::size_t>(i)]);
  }
  while (!frame.full(config_.m)) {
    const int index = order_[walk_];
    walk_ = walk_ + 1 == order_.size() ? 0 : walk_ + 1;
    if (mark_[static_cast<std::size_t>(index)] != frame_mark_) {
      track(reader, frame, index);
    }
  }
}

// Lists up to `limit` candidates, row by row and cyclically from the cursor on, before measurements change them. The
// first one left out is where the next frame begins.
int Sampler::list_candidates(int limit) {
  const int taxels = order_.size();
  int listed = 0;
  int index = cursor_;
  cursor_ = 0;
  for (int seen = 0; seen < taxels; ++seen) {
    if (pressed_near_[static_cast<std::size_t>(index)] > 0) {
      if (listed == limit) {
        cursor_ = index;
        break;
      }
      candidates_[static_cast<std::size_t>(listed++)] = static_cast<std::uint16_t>(index);
    }
    index = index + 1 == taxels ? 0 : index + 1;
  }
  return listed;
}

// Measures a taxel and notes whether it is pressed.
void Sampler::track(TaxelReader& reader, SampleFrame& frame, int index) {
  const bool now = touched(reader, frame, index);
  bool& before = pressed_[static_cast<std::size_t>(index)];
  if (now == before) {
    return;
  }
  before = now;
  const int row = index / config_.cols;
  const int col = index % config_.cols;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, config_.rows - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, config_.cols - 1); ++c) {
      std::uint8_t& near = pressed_near_[static_cast<std::size_t>(r * config_.cols + c)];
      near = static_cast<std::uint8_t>(now ? near + 1 : near - 1);
    }
  }
}

// The grid moves by one column a frame and, when it has been through the columns, by one row. Where its last row or
// column falls off the array, the array's last is taken instead, as by the authors' program: m taxels in every frame.
void Sampler::uniform(TaxelReader& reader, SampleFrame& frame) {
  const int first_row = offset_ / spacing_.col;
  const int first_col = offset_ % spacing_.col;
  for (int i = 0; i < divide_up(config_.rows, spacing_.row); ++i) {
    const int row = std::min(first_row + i * spacing_.row, config_.rows - 1);
    for (int j = 0; j < divide_up(config_.cols, spacing_.col); ++j) {
      const int col = std::min(first_col + j * spacing_.col, config_.cols - 1);
      frame.append(row * config_.cols + col, reader.measure(row, col));
    }
  }
  offset_ = (offset_ + 1) % (spacing_.row * spacing_.col);
}

// Adaptive sampling for its quota, then random taxels among those that this frame has not measured.
void Sampler::hybrid(TaxelReader& reader, SampleFrame& frame) {
  adaptive(reader, frame, config_.adaptive_quota);
  random(reader, frame);
}

// The first m steps of a Fisher-Yates shuffle that is never undone. What the frame holds already goes to the front,
// in its order: the draw begins behind it.
void Sampler::random(TaxelReader& reader, SampleFrame& frame) {
  const auto taxels = static_cast<std::uint32_t>(config_.rows * config_.cols);
  const std::uint32_t first = frame.m;
  for (std::uint32_t i = 0; i < first; ++i) {
    shuffle_swap(i, place_[frame.indices[i]]);
  }
  for (std::uint32_t i = first; i < static_cast<std::uint32_t>(config_.m); ++i) {
    shuffle_swap(i, i + random_.below(taxels - i));
    const int index = shuffled_[i];
    frame.append(index, reader.measure(index / config_.cols, index % config_.cols));
  }
}

void Sampler::shuffle_swap(std::uint32_t i, std::uint32_t j) {
  std::swap(shuffled_[i], shuffled_[j]);
  place_[shuffled_[i]] = static_cast<std::uint16_t>(i);
  place_[shuffled_[j]] = static_cast<std::uint16_t>(j);
}

void Sampler::raster(TaxelReader& reader, SampleFrame& frame) {
  for (int row = 0; row < config_.rows; ++row) {
    for (int col = 0; col < config_.cols; ++col) {
      frame.append(row * config_.cols + col, reader.measure(row, col));
    }
  }
}

}  // namespace acts
