// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/tracking.hpp"

#include <algorithm>

namespace acts {

void Tracking::begin(const SamplingConfig& /*config*/, const SkinMap& map) {
  order_.build(map.rows(), map.cols());
  pressed_.fill(false);
  pressed_near_.fill(0);
  reserved_.fill(false);
  cursor_ = 0;
  walk_ = 0;
}

void Tracking::sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame) {
  const int search_quota = config.own(kSearchQuota);
  const int followed = list_candidates(order_.size(), config.m - search_quota);
  const int others = config.m - followed;
  found_count_ = 0;
  int searched = 0;
  int looked_around = 0;
  while (frame.size() < others) {
    if (looked_around < found_count_ && searched >= search_quota) {
      look_around(config, map, others, found_[static_cast<std::size_t>(looked_around++)], frame);
      continue;
    }
    const int place = order_[walk_];
    walk_ = walk_ + 1 == order_.size() ? 0 : walk_ + 1;
    if (is_free(map, place, frame)) {
      track(config, map, place, frame);
      ++searched;
    }
  }
  for (int i = 0; i < followed; ++i) {
    const int place = candidates_[static_cast<std::size_t>(i)];
    reserved_[static_cast<std::size_t>(place)] = false;
    track(config, map, place, frame);
  }
}

// Measures the neighbours of a place that was found pressed, as long as the frame has fewer than `others`.
void Tracking::look_around(const SamplingConfig& config, const SkinMap& map, int others, int place,
                           Measurement& frame) {
  const int row = place / map.cols();
  const int col = place % map.cols();
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, map.rows() - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, map.cols() - 1); ++c) {
      const int near = r * map.cols() + c;
      if (frame.size() < others && map.joined(place, near) && is_free(map, near, frame)) {
        track(config, map, near, frame);
      }
    }
  }
}

// Whether the frame neither has a place nor keeps it for its end.
bool Tracking::is_free(const SkinMap& map, int place, const Measurement& frame) const {
  return !frame.has(map.taxel(place)) && !reserved_[static_cast<std::size_t>(place)];
}

// Lists and reserves up to `limit` candidates, row by row and cyclically from the cursor on, before measurements change
// them. The first one left out is where the next frame begins.
int Tracking::list_candidates(int places, int limit) {
  int listed = 0;
  int place = cursor_;
  cursor_ = 0;
  for (int seen = 0; seen < places; ++seen) {
    if (pressed_near_[static_cast<std::size_t>(place)] > 0) {
      if (listed == limit) {
        cursor_ = place;
        break;
      }
      candidates_[static_cast<std::size_t>(listed++)] = static_cast<std::uint16_t>(place);
      reserved_[static_cast<std::size_t>(place)] = true;
    }
    place = place + 1 == places ? 0 : place + 1;
  }
  return listed;
}

// Measures a place and notes whether it is pressed.
void Tracking::track(const SamplingConfig& config, const SkinMap& map, int place, Measurement& frame) {
  const bool now = frame.take(map.taxel(place)) > config.threshold && map.has_skin(place);
  bool& before = pressed_[static_cast<std::size_t>(place)];
  if (now == before) {
    return;
  }
  before = now;
  if (now) {
    found_[static_cast<std::size_t>(found_count_++)] = static_cast<std::uint16_t>(place);
  }
  const int row = place / map.cols();
  const int col = place % map.cols();
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, map.rows() - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, map.cols() - 1); ++c) {
      const int beside = r * map.cols() + c;
      if (map.joined(place, beside)) {
        std::uint8_t& near = pressed_near_[static_cast<std::size_t>(beside)];
        near = static_cast<std::uint8_t>(now ? near + 1 : near - 1);
      }
    }
  }
}

}  // namespace acts
