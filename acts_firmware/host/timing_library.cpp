// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The virtual board's times behind C functions; for acts_tools/figures/board.
#include <cstddef>
#include <cstdint>

#include "acts_firmware/wire/command.hpp"
#include "board/published_recovery.hpp"
#include "board/published_timing.hpp"

extern "C" {

// Time [us] of all measurements of a frame of these settings, which are those of a board as on the wire; negative where
// they are not of the right size.
double acts_board_sampling_us(const std::uint8_t* settings, std::size_t bytes) {
  if (bytes != acts::kSettingsBytes) {
    return -1.0;
  }
  const acts::SamplingConfig sampling = acts::read_settings(settings).sampling;
  return sampling.frame_size() * acts::published_sample_us(sampling);
}

// Time [us] besides, of a frame of m measurements of rows x cols taxels: for an image by so many atoms, or the object
// by a library of so many columns (acts::Output).
double acts_board_output_us(int output, int columns, int rows, int cols, int m) {
  acts::Model model;
  model.columns = static_cast<std::uint16_t>(columns);
  acts::SamplingConfig sampling;
  sampling.rows = rows;
  sampling.cols = cols;
  return acts::published_recovery_us(static_cast<acts::Output>(output), model, sampling, m);
}

}  // extern "C"
