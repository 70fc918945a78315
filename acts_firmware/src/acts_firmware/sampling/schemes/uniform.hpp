// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Uniform sampling: a grid that moves from frame to frame.
#pragma once

#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/scheme.hpp"
#include "acts_firmware/sampling/settings.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// Spacing of rows and columns of a uniform grid of m taxels; zeros where the array has none of that many. Of all grids
// ceil(rows / s) * ceil(cols / t) == m the one with the most equal spacings, the larger one along the rows. On 32 x 32
// that is the published table.
struct Spacing {
  int row = 0;
  int col = 0;
};
Spacing uniform_spacing(int rows, int cols, int m);

// The grid moves by one column a frame and, when it has been through the columns, by one row. Where its last row or
// column falls off the array, the array's last is taken instead, as by the authors' program: m taxels in every frame.
class Uniform : public SchemeDefaults {
 public:
  static constexpr SchemeInfo kInfo = {"uniform", Scheme{1}, "a grid that moves from frame to frame"};

  static bool takes(int rows, int cols, int m) { return uniform_spacing(rows, cols, m).row != 0; }

  void begin(const SamplingConfig& config, const SkinMap& map);
  void sample(const SamplingConfig& config, const SkinMap& map, Measurement& frame);

 private:
  Spacing spacing_;
  int offset_ = 0;  // 0 to spacing_.row * spacing_.col - 1
};

}  // namespace acts
