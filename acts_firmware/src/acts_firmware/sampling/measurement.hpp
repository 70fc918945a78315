// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// One frame while it is measured: what the schemes are given.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acts_firmware/board/scanner.hpp"
#include "acts_firmware/frame.hpp"

namespace acts {

// Which taxels the frame has: those that carry its mark. So nothing is cleared between frames.
class Marks {
 public:
  void begin_frame() {
    if (++frame_ == 0) {
      marks_.fill(0);
      frame_ = 1;
    }
  }
  void set(int index) { marks_[static_cast<std::size_t>(index)] = frame_; }
  bool has(int index) const { return marks_[static_cast<std::size_t>(index)] == frame_; }

 private:
  std::array<std::uint16_t, kMaxTaxels> marks_{};
  std::uint16_t frame_ = 0;
};

class Measurement {
 public:
  Measurement(TaxelReader& reader, Marks& marks, SampleFrame& frame) : reader_(reader), marks_(marks), frame_(frame) {
    marks_.begin_frame();
  }

  // Measures a taxel; one that this frame has measured before only for a scheme that repeats.
  std::uint16_t take(int index) {
    const std::uint16_t count = reader_.measure(index / frame_.cols, index % frame_.cols);
    marks_.set(index);
    frame_.append(index, count);
    return count;
  }

  bool has(int index) const { return marks_.has(index); }
  int size() const { return frame_.m; }

  // The i-th taxel of the frame.
  int operator[](int i) const { return frame_.indices[static_cast<std::size_t>(i)]; }

 private:
  TaxelReader& reader_;
  Marks& marks_;
  SampleFrame& frame_;
};

}  // namespace acts
