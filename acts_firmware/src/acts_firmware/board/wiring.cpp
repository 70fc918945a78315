// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/board/wiring.hpp"

namespace acts {

namespace {

constexpr int kPublishedLines = 32;
constexpr int kWideLines = 64;
constexpr int kFirstExpanderPin = 64;
constexpr std::uint8_t kAdcPin = 14;

}  // namespace

Wiring published_wiring() {
  Wiring wiring;
  wiring.lines = kPublishedLines;
  wiring.address_bits = 5;
  std::uint8_t pin = 0;
  for (int line = 0; line < kPublishedLines; ++line) {
    if (pin == kAdcPin) {
      ++pin;
    }
    wiring.row_pins[static_cast<std::size_t>(line)] = pin++;
  }
  wiring.address_pins = {33, 34, 35, 36, 37};
  return wiring;
}

Wiring wide_wiring() {
  Wiring wiring;
  wiring.lines = kWideLines;
  wiring.address_bits = 6;
  for (int line = 0; line < kWideLines; ++line) {
    wiring.row_pins[static_cast<std::size_t>(line)] = static_cast<std::uint8_t>(kFirstExpanderPin + line);
  }
  wiring.address_pins = {33, 34, 35, 36, 37, 38};
  return wiring;
}

Wiring wiring_for(int rows, int cols) {
  return rows <= kPublishedLines && cols <= kPublishedLines ? published_wiring() : wide_wiring();
}

}  // namespace acts
