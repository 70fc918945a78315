// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/sampling/division_order.hpp"

namespace acts {

void DivisionOrder::build(int rows, int cols) {
  rows_ = rows;
  cols_ = cols;
  size_ = 0;
  listed_.fill(false);

  std::size_t count = 1;
  centres_[0] = {static_cast<std::int16_t>(rows), static_cast<std::int16_t>(cols)};
  put(centres_[0]);
  int row_step = rows;
  int col_step = cols;
  while (row_step > 1 || col_step > 1) {
    int row_shift = 0;
    int col_shift = 0;
    if (col_step >= row_step) {
      col_step = (col_step + 1) / 2;
      col_shift = col_step;
    } else {
      row_step = (row_step + 1) / 2;
      row_shift = row_step;
    }
    // In place from the back: centre i becomes 2 i and 2 i + 1.
    for (std::size_t i = count; i-- > 0;) {
      const Centre centre = centres_[i];
      centres_[2 * i] = {static_cast<std::int16_t>(centre.row2 - row_shift),
                         static_cast<std::int16_t>(centre.col2 - col_shift)};
      centres_[2 * i + 1] = {static_cast<std::int16_t>(centre.row2 + row_shift),
                             static_cast<std::int16_t>(centre.col2 + col_shift)};
    }
    count *= 2;
    for (std::size_t i = 0; i < count; ++i) {
      put(centres_[i]);
    }
  }
}

void DivisionOrder::put(const Centre& centre) {
  if (centre.row2 < 0 || centre.col2 < 0) {
    return;
  }
  const int row = centre.row2 / 2;
  const int col = centre.col2 / 2;
  if (row >= rows_ || col >= cols_) {
    return;
  }
  const auto index = static_cast<std::size_t>(row * cols_ + col);
  if (!listed_[index]) {
    listed_[index] = true;
    order_[static_cast<std::size_t>(size_++)] = static_cast<std::uint16_t>(index);
  }
}

}  // namespace acts
