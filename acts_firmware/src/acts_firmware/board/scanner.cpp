// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/board/scanner.hpp"

namespace acts {

Scanner::Scanner(Board& board, const Wiring& wiring) : board_(board), wiring_(wiring) {
  for (int line = 0; line < wiring_.lines; ++line) {
    board_.write_pin(wiring_.row_pins[static_cast<std::size_t>(line)], false);
  }
  for (int bit = 0; bit < wiring_.address_bits; ++bit) {
    board_.write_pin(wiring_.address_pins[static_cast<std::size_t>(bit)], false);
  }
}

std::uint16_t Scanner::measure(int row, int col) {
  if (row != row_) {
    if (row_ >= 0) {
      board_.write_pin(wiring_.pin_of_row(row_), false);
    }
    board_.write_pin(wiring_.pin_of_row(row), true);
    row_ = row;
  }
  const int changed = col ^ col_;
  for (int bit = 0; bit < wiring_.address_bits; ++bit) {
    if ((changed >> bit & 1) != 0) {
      board_.write_pin(wiring_.address_pins[static_cast<std::size_t>(bit)], (col >> bit & 1) != 0);
    }
  }
  col_ = col;
  return board_.read_adc();
}

}  // namespace acts
