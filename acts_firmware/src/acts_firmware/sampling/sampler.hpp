// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Samples frame after frame. acts_core/sampling/sampler.py is the readable reference; a test compares the two.
#pragma once

#include "acts_firmware/board/scanner.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/schemes.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// The scheme in force holds what goes from one frame to the next (uniform offset, random numbers, what to follow).
class Sampler {
 public:
  Sampler();

  // Takes the settings over and starts anew, or says which is refused and leaves everything as it was. A map of the
  // skin stays in force, unless the size of the matrix is another.
  SettingField configure(const SamplingConfig& config);
  const SamplingConfig& config() const { return config_; }
  int frame_size() const { return config_.frame_size(); }

  // How the taxels lie on the skin, see SkinMap: in pieces, meanwhile as the matrix; then checked and put into force.
  // False where that cannot be.
  bool put_map(int place, const std::uint8_t* entries, int count);
  bool finish_map(int rows, int cols, int no_skin, std::uint32_t crc32);
  void forget_map();
  const SkinMap& map() const { return map_; }

  // Measures one frame: fills scheme, size, m, indices and counts.
  void sample(TaxelReader& reader, SampleFrame& frame);

 private:
  void begin();

  SamplingConfig config_;
  SkinMap map_;
  Marks marks_;
  Schemes::AnyOf scheme_;
};

}  // namespace acts
