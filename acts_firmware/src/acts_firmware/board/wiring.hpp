// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Which pin does what: row lines, the address lines of the column multiplexer, the LED.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/limits.hpp"

namespace acts {

struct Wiring {
  int lines = 0;                                  // row lines; also the columns the multiplexer can select
  int address_bits = 0;                           // lines == 2^address_bits
  std::array<std::uint8_t, kMaxSide> row_pins{};  // by line number
  std::array<std::uint8_t, 8> address_pins{};     // bit 0 (least significant) first
  std::uint8_t led_pin = 40;

  // The picture is flipped top to bottom against the lines: image row r hangs on the last line but r.
  std::uint8_t pin_of_row(int row) const { return row_pins[static_cast<std::size_t>(lines - 1 - row)]; }
};

// The published board: Teensy 4.1, 32 row lines on pins 0-13 and 15-32 (pin 14 is the ADC input A0), ADG732
// multiplexer addressed by pins 37, 36, 35, 34, 33 = bit 4 .. bit 0, LED on pin 40.
Wiring published_wiring();

// A board twice that size, for arrays of more than 32 rows or columns: 64 row lines behind a port expander, whose
// outputs are numbered from 64 on, and a sixth address bit on pin 38.
Wiring wide_wiring();

// The smallest of the two that fits the array.
Wiring wiring_for(int rows, int cols);

}  // namespace acts
