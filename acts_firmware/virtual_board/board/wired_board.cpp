// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "board/wired_board.hpp"

#include <algorithm>

namespace acts {

namespace {

// Teensy 4.1 pins of row lines 0 to 31 (pin 14 is the ADC input).
constexpr std::array<std::uint8_t, 32> kLinePins = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 15, 16,
                                                    17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32};
constexpr int kWideLines = 64;
constexpr std::size_t kExpanderPin = 64;

}  // namespace

WiredBoard::WiredBoard(int rows, int cols, std::uint64_t id) : rows_(rows), cols_(cols), id_(id) {
  row_of_pin_.fill(-1);
  const int lines = static_cast<int>(kLinePins.size());
  if (rows <= lines && cols <= lines) {
    for (std::size_t line = 0; line < kLinePins.size(); ++line) {
      row_of_pin_[kLinePins[line]] = static_cast<std::int8_t>(31 - static_cast<int>(line));
    }
  } else {
    for (int line = 0; line < kWideLines; ++line) {
      row_of_pin_[kExpanderPin + static_cast<std::size_t>(line)] = static_cast<std::int8_t>(63 - line);
    }
    bit_of_pin_[38] = 32;
  }
  bit_of_pin_[37] = 16;
  bit_of_pin_[36] = 8;
  bit_of_pin_[35] = 4;
  bit_of_pin_[34] = 2;
  bit_of_pin_[33] = 1;
}

void WiredBoard::write_pin(std::uint8_t pin, bool high) {
  if (const int row = row_of_pin_[pin]; row >= 0) {
    const std::uint64_t mask = std::uint64_t{1} << row;
    driven_rows_ = high ? driven_rows_ | mask : driven_rows_ & ~mask;
  }
  const unsigned bit = bit_of_pin_[pin];
  column_ = high ? column_ | bit : column_ & ~bit;
}

double WiredBoard::adc_input() {
  if (!faults_.none()) {
    return faulty_input();
  }
  const int col = static_cast<int>(column_);
  double sum = 0.0;
  if (col < cols_) {
    for (int row = 0; row < rows_ && driven_rows_ >> row != 0; ++row) {
      if ((driven_rows_ >> row & 1U) != 0) {
        sum += clip_counts(taxel_counts(row, col));
      }
    }
  }
  return clip_counts(sum);
}

double WiredBoard::faulty_input() {
  const std::uint64_t rows = faults_.energised(driven_rows_);
  const std::uint64_t cols = faults_.connected(faults_.address(column_));
  double sum = 0.0;
  for (int row = 0; row < rows_ && rows >> row != 0; ++row) {
    for (int col = 0; col < cols_ && cols >> col != 0; ++col) {
      if ((rows >> row & cols >> col & 1U) != 0) {
        const std::optional<double> fixed = faults_.fixed_counts(row, col);
        sum += clip_counts(fixed ? *fixed : taxel_counts(row, col));
      }
    }
  }
  return clip_counts(sum);
}

double clip_counts(double counts) {
  return counts > 0.0 ? std::min(counts, static_cast<double>(kCountMax)) : 0.0;
}

}  // namespace acts
