// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Model of the readout board's wiring: what the ADC sees for the levels of the pins.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/limits.hpp"
#include "board/wiring_faults.hpp"

namespace acts {

// The id of a virtual board that is given no other: "ACTS" and 1.
constexpr std::uint64_t kVirtualBoardId = 0x4143545300000001;

// Knows which line hangs on which pin by its own table, not by the firmware's: a wrong pin in either shows. An array
// smaller than the board is connected at the top left of the picture.
class WiredBoard : public Board {
 public:
  WiredBoard(int rows, int cols, std::uint64_t id = kVirtualBoardId);

  // Break the wiring; nothing is broken at the beginning.
  void set_faults(const WiringFaults& faults) { faults_ = faults; }

  void write_pin(std::uint8_t pin, bool high) override;
  std::uint64_t id() override { return id_; }

 protected:
  // Counts of one taxel of the array, before noise and rounding; NaN and values out of range are allowed.
  virtual double taxel_counts(int row, int col) = 0;

  // The selected column's current as counts, 0 to 1023: the sum over all rows that are driven. Lines that are shorted
  // count together, open ones not at all.
  double adc_input();

 private:
  double faulty_input();

  int rows_;
  int cols_;
  std::uint64_t id_;
  std::uint64_t driven_rows_ = 0;               // bit r: image row r is high
  unsigned column_ = 0;                         // address as the board asks for it
  std::array<std::int8_t, 256> row_of_pin_{};   // image row, -1 for none
  std::array<std::uint8_t, 256> bit_of_pin_{};  // address bit as a mask, 0 for none
  WiringFaults faults_;
};

// Counts that a pressure stands for, whatever was given: 0 to 1023, NaN is 0.
double clip_counts(double counts);

}  // namespace acts
