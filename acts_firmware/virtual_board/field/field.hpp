// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What presses the virtual board's skin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace acts {

// A pressure field that changes with time. Values are ADC counts before noise and rounding; the board clips them.
class Field {
 public:
  Field() = default;
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  virtual ~Field() = default;

  // Called before every frame, with the present time. False where the field stands still: it is that of a world which
  // has ended or hangs, and nothing is to be measured of it.
  virtual bool refresh(std::int64_t /*monotonic_ns*/) { return true; }

  // Counts at a row-major index at a time of CLOCK_MONOTONIC.
  virtual double counts(std::size_t index, std::int64_t monotonic_ns) = 0;
};

class UntouchedField final : public Field {
 public:
  double counts(std::size_t /*index*/, std::int64_t /*monotonic_ns*/) override { return 0.0; }
};

// A recording in a .npy file, uint16 (n, rows, cols) in C order, played from `start_monotonic_ns` on, with linear
// interpolation between its frames; at its end it starts over or holds the last frame. Throws std::runtime_error where
// the file does not fit.
std::unique_ptr<Field> open_recording(const std::string& path, int rows, int cols, double rate_hz, bool loop,
                                      std::int64_t start_monotonic_ns);

// The simulated world's field, in the ring that acts_sim/shared/timed_ring.py describes. Untouched while there is no
// file at `path`; a new file is taken up within a tenth of a second. It stands still where its newest slot is more than
// half a second old, which is told on standard error.
std::unique_ptr<Field> watch_ring(const std::string& path, std::size_t width);

}  // namespace acts
