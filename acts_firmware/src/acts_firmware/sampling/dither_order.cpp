// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/dither_order.hpp"

namespace acts {

namespace {

constexpr int kSpacing = 4;

struct Offset {
  int row;
  int col;
};

constexpr Offset kQuarters[] = {{0, 0}, {2, 2}, {0, 2}, {2, 0}};
constexpr Offset kShifts[] = {{0, 0}, {1, 1}, {0, 1}, {1, 0}};

}  // namespace

void DitherOrder::build(int rows, int cols) {
  size_ = 0;
  for (const Offset& shift : kShifts) {
    for (const Offset& quarter : kQuarters) {
      for (int row = shift.row + quarter.row; row < rows; row += kSpacing) {
        for (int col = shift.col + quarter.col; col < cols; col += kSpacing) {
          order_[static_cast<std::size_t>(size_++)] = static_cast<std::uint16_t>(row * cols + col);
        }
      }
    }
  }
}

}  // namespace acts
