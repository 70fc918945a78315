#include "acts_firmware/sampling/tracking.hpp"

#include <algorithm>

namespace acts {

void Tracking::reset() {
  pressed_.fill(false);
  pressed_near_.fill(0);
  reserved_.fill(false);
  cursor_ = 0;
  walk_ = 0;
}

void Tracking::sample(const SamplingConfig& config, const DitherOrder& order, Measurement& frame) {
  const int followed = list_candidates(order.size(), config.m - config.search_quota);
  const int others = config.m - followed;
  found_count_ = 0;
  int searched = 0;
  int looked_around = 0;
  while (frame.size() < others) {
    if (looked_around < found_count_ && searched >= config.search_quota) {
      look_around(config, others, found_[static_cast<std::size_t>(looked_around++)], frame);
      continue;
    }
    const int index = order[walk_];
    walk_ = walk_ + 1 == order.size() ? 0 : walk_ + 1;
    if (is_free(index, frame)) {
      track(config, index, frame);
      ++searched;
    }
  }
  for (int i = 0; i < followed; ++i) {
    const int index = candidates_[static_cast<std::size_t>(i)];
    reserved_[static_cast<std::size_t>(index)] = false;
    track(config, index, frame);
  }
}

// Measures the neighbours of a taxel that was found pressed, as long as the frame has fewer than `others`.
void Tracking::look_around(const SamplingConfig& config, int others, int index, Measurement& frame) {
  const int row = index / config.cols;
  const int col = index % config.cols;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, config.rows - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, config.cols - 1); ++c) {
      const int near = r * config.cols + c;
      if (frame.size() < others && is_free(near, frame)) {
        track(config, near, frame);
      }
    }
  }
}

// Whether the frame neither has a taxel nor keeps it for its end.
bool Tracking::is_free(int index, const Measurement& frame) const {
  return !frame.has(index) && !reserved_[static_cast<std::size_t>(index)];
}

// Lists and reserves up to `limit` candidates, row by row and cyclically from the cursor on, before measurements change
// them. The first one left out is where the next frame begins.
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
      reserved_[static_cast<std::size_t>(index)] = true;
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
