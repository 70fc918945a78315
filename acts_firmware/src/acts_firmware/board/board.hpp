// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a readout board must be able to do. All that the Teensy and the host differ in.
#pragma once

#include <cstdint>

namespace acts {

// How to bring the firmware to a board: implement these four functions, hand the board to a `Firmware` together with
// the wiring (see wiring.hpp), and call `Firmware::measure_frame` again and again. On a Teensy they are one line each
// (digitalWrite, analogRead(A0), micros, the serial number); the virtual board models the same pins.
class Board {
 public:
  Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  virtual ~Board() = default;

  // Drive a digital output. Row lines carry the excitation, multiplexer lines the address of a column; one is the LED.
  virtual void write_pin(std::uint8_t pin, bool high) = 0;

  // Convert what the multiplexer passes on; 0 to 1023.
  virtual std::uint16_t read_adc() = 0;

  // Time since the board's start [us]; wraps at 2^32.
  virtual std::uint32_t micros() = 0;

  // Told again and again while the firmware recovers an image, which may take longer than a watchdog waits: a board
  // that has one feeds it here.
  virtual void computing() {}

  // Told when the firmware has recovered or classified a frame. Nothing to do where time passes by itself; a board
  // whose time is simulated lets pass here what that takes.
  virtual void computed() {}

  // Which board this is; different for every board, the same at every start.
  virtual std::uint64_t id() = 0;
};

}  // namespace acts
