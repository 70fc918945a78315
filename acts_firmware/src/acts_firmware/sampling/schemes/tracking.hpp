// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Tracking sampling: a search continued from the last frame, then what was pressed.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/sampling/dither_order.hpp"
#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// Candidates are what was pressed, and its neighbours. They get at most m - search_quota taxels of a frame, in turns,
// and the end of it: an image is of that moment, and what is pressed is what changes. Before them a search that goes on
// from frame to frame gets search_quota or more; what is left when it has had these goes first to the neighbours of
// what it found newly pressed. So every taxel is measured at least once in any ceil(rows * cols / search_quota) frames,
// and every lasting candidate at least once in any ceil(candidates / (m - search_quota)).
class Tracking : public SchemeDefaults {
 public:
  static constexpr OwnSetting kSearchQuota = {7,
                                              "search_quota",
                                              "taxels of a tracking frame that are kept for the search, 1 to m there",
                                              11,
                                              0,
                                              kMaxTaxels,
                                              "search_share",
                                              "share of a tracking frame that is kept for the search",
                                              0.2};
  static constexpr SchemeInfo kInfo = {
      "tracking",
      Scheme{6},
      "a search continued from the last frame, then what was pressed when last measured, and its neighbours",
      {{kSearchQuota}}};

  // Forgets what was pressed and where the search stopped.
  void begin(const SamplingConfig& config, const SkinMap& map);
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  int list_candidates(int places, int limit);
  void look_around(const SamplingConfig& config, const SkinMap& map, int others, int place, Measurement& frame);
  bool is_free(const SkinMap& map, int place, const Measurement& frame) const;
  void track(const SamplingConfig& config, const SkinMap& map, int place, Measurement& frame);

  DitherOrder order_;
  // By place on the skin: what was pressed when last measured, and how many of a place and its neighbours were.
  std::array<bool, kMaxTaxels> pressed_{};
  std::array<std::uint8_t, kMaxTaxels> pressed_near_{};
  std::array<std::uint16_t, kMaxTaxels> candidates_{};
  std::array<bool, kMaxTaxels> reserved_{};        // candidates that this frame has still to measure
  std::array<std::uint16_t, kMaxTaxels> found_{};  // newly pressed in this frame
  int found_count_ = 0;
  int cursor_ = 0;  // the place from which candidates are taken
  int walk_ = 0;    // rank in the order of search at which the search goes on
};

}  // namespace acts
