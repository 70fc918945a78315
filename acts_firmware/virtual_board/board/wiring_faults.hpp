// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What is broken between the pins of the board and the taxels of the skin.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "acts_firmware/limits.hpp"

namespace acts {

// Breaks are where currents no longer flow, shorts where they flow besides. Rows and columns are those of the picture.
class WiringFaults {
 public:
  WiringFaults();

  // Takes a fault in words: open-row=R, open-col=C, short-rows=R,R, short-cols=C,C, dead=R,C, stuck=R,C,COUNTS or
  // address-bit=B. Throws std::invalid_argument, saying what is allowed.
  void add(const std::string& words);

  // Throws std::invalid_argument where a fault lies outside an array of this size.
  void check(int rows, int cols) const;

  bool none() const { return faults_.empty(); }

  // Rows (bit r: row r) that carry the excitation when `driven` have it at the board's end.
  std::uint64_t energised(std::uint64_t driven) const;

  // Columns whose current arrives when the multiplexer stands at `column`.
  std::uint64_t connected(unsigned column) const;

  // Where the multiplexer stands when the board asks for `column`: a broken address line is pulled low.
  unsigned address(unsigned column) const { return column & ~broken_address_; }

  // What a broken taxel reads whatever presses it; nothing for a sound one.
  std::optional<double> fixed_counts(int row, int col) const;

 private:
  struct Fault {
    std::string words;
    int highest_row = -1;
    int highest_col = -1;
    int address_bit = -1;
  };
  struct FixedTaxel {
    int row;
    int col;
    double counts;
  };
  using Groups = std::array<std::uint64_t, kMaxSide>;  // by line: those that are one with it, itself included

  static void join(Groups& groups, int first, int second);

  std::vector<Fault> faults_;
  std::uint64_t open_rows_ = 0;
  std::uint64_t open_cols_ = 0;
  Groups row_groups_;
  Groups col_groups_;
  unsigned broken_address_ = 0;
  std::vector<FixedTaxel> fixed_;
};

}  // namespace acts
