// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/schemes/uniform.hpp"

#include <algorithm>

namespace acts {

namespace {

constexpr int divide_up(int a, int b) {
  return (a + b - 1) / b;
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

void Uniform::begin(const SamplingConfig& config, const SkinMap& /*map*/) {
  spacing_ = uniform_spacing(config.rows, config.cols, config.m);
  offset_ = 0;
}

void Uniform::sample(const SamplingConfig& config, const SkinMap& /*map*/, Measurement& frame) {
  const int first_row = offset_ / spacing_.col;
  const int first_col = offset_ % spacing_.col;
  for (int i = 0; i < divide_up(config.rows, spacing_.row); ++i) {
    const int row = std::min(first_row + i * spacing_.row, config.rows - 1);
    for (int j = 0; j < divide_up(config.cols, spacing_.col); ++j) {
      const int col = std::min(first_col + j * spacing_.col, config.cols - 1);
      frame.take(row * config.cols + col);
    }
  }
  offset_ = (offset_ + 1) % (spacing_.row * spacing_.col);
}

}  // namespace acts
