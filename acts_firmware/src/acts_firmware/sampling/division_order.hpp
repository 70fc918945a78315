// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The coarse-to-fine order in which adaptive sampling walks the array.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/limits.hpp"

namespace acts {

// Every taxel of a rows x cols array once.
//
// Centres are kept doubled (the first is (rows, cols)) and halved, rounding down, when listed. Each round splits every
// cell across its longer side, the columns where both are equal: the step along that side is halved, rounding up, and
// each centre yields the two at that step before and behind it. Centres outside of the array are split on but not
// listed. The rounds end when both steps are 1; by then no taxel is missing. On 32 x 32 these are the ten rounds of
// the published firmware; other sizes, also non-square, are a generalisation.
class DivisionOrder {
 public:
  void build(int rows, int cols);

  int size() const { return size_; }
  int operator[](int rank) const { return order_[static_cast<std::size_t>(rank)]; }

 private:
  struct Centre {
    std::int16_t row2;
    std::int16_t col2;
  };

  void put(const Centre& centre);

  int rows_ = 0;
  int cols_ = 0;
  int size_ = 0;
  std::array<std::uint16_t, kMaxTaxels> order_{};
  std::array<bool, kMaxTaxels> listed_{};
  // A side of 33 to 64 is halved six times before its step is 1: never more centres than 2^12.
  std::array<Centre, kMaxTaxels> centres_{};
};

}  // namespace acts
