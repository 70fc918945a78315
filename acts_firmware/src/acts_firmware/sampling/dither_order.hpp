// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The order in which tracking searches: every stretch of it is spread over the whole array.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acts_firmware/limits.hpp"

namespace acts {

// Every taxel once: 16 lattices of every fourth row and column, one after the other as the ranks of a 4 x 4 matrix of
// ordered dithering, so that four that begin at a multiple of four make a lattice of every second row and column.
class DitherOrder {
 public:
  void build(int rows, int cols);

  int size() const { return size_; }
  int operator[](int rank) const { return order_[static_cast<std::size_t>(rank)]; }

 private:
  int size_ = 0;
  std::array<std::uint16_t, kMaxTaxels> order_{};
};

}  // namespace acts
