#include "acts_firmware/sampling/tracking.hpp"

#include <algorithm>

namespace acts {

void Tracking::reset() {
  pressed_.fill(false);
  pressed_near_.fill(0);
  cursor_ = 0;
  walk_ = 0;
}

void Tracking::sample(const SamplingConfig& config, const DitherOrder& order, Measurement& frame) {
  const int followed = list_candidates(order.size(), config.m - config.search_quota);
  found_count_ = 0;
  for (int i = 0; i < followed; ++i) {
    track(config, candidates_[static_cast<std::size_t>(i)], frame);
  }
  int searched = 0;
  int looked_around = 0;
  while (frame.size() < config.m) {
    if (looked_around < found_count_ && searched >= config.search_quota) {
      look_around(config, found_[static_cast<std::size_t>(looked_around++)], frame);
      continue;
    }
    const int index = order[walk_];
    walk_ = walk_ + 1 == order.size() ? 0 : walk_ + 1;
    if (!frame.has(index)) {
      track(config, index, frame);
      ++searched;
    }
  }
}

// Measures the neighbours of a taxel that was found pressed, as far as the frame goes.
void Tracking::look_around(const SamplingConfig& config, int index, Measurement& frame) {
  const int row = index / config.cols;
  const int col = index % config.cols;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, config.rows - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, config.cols - 1); ++c) {
      const int near = r * config.cols + c;
      if (frame.size() < config.m && !frame.has(near)) {
        track(config, near, frame);
      }
    }
  }
}

// Lists up to `limit` candidates, row by row and cyclically from the cursor on, before measurements change them. The
// first one left out is where the next frame begins.
int Tracking::list_candidates(int taxels, int limit) {
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
void Tracking::track(const SamplingConfig& config, int index, Measurement& frame) {
  const bool now = frame.take(index) > config.threshold;
  bool& before = pressed_[static_cast<std::size_t>(index)];
  if (now == before) {
    return;
  }
  before = now;
  if (now) {
    found_[static_cast<std::size_t>(found_count_++)] = static_cast<std::uint16_t>(index);
  }
  const int row = index / config.cols;
  const int col = index % config.cols;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, config.rows - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, config.cols - 1); ++c) {
      std::uint8_t& near = pressed_near_[static_cast<std::size_t>(r * config.cols + c)];
      near = static_cast<std::uint8_t>(now ? near + 1 : near - 1);
    }
  }
}

}  // namespace acts
