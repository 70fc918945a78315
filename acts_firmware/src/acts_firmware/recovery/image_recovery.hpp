// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// From the samples of one frame to the full image, patch by patch; acts_recon's Reconstructor, on the board.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/limits.hpp"
#include "acts_firmware/recovery/fast_omp.hpp"
#include "acts_firmware/recovery/patch_cover.hpp"

namespace acts {

// A dictionary of square patches: a row a pixel, a column an atom; pixels are numbered column first.
struct PatchDictionary {
  const float* values;
  int atoms;
  int side;  // of a patch, in taxels
  int step;  // from a patch to the next
};

class ImageRecovery {
 public:
  // What a frame's recovery works in (33 KB); nothing in it outlives the frame but the image.
  struct Workspace {
    std::array<float, kMaxTaxels> image;
    std::array<std::int16_t, kMaxTaxels> measured;  // counts, 0 where not pressed; -1 where not measured
    std::array<float, kMaxPatchPixels> y;
    std::array<float, kMaxPatchPixels> residual;
    std::array<float, kMaxAtoms * kMaxPatchPixels> q;
    std::array<std::uint16_t, kMaxPatchPixels> pixels;
    std::array<std::array<bool, kMaxSide>, kMaxSide> pressed;  // patches
  };

  // False where the dictionary's patches do not fit the array: nothing can be recovered then.
  bool prepare(const PatchDictionary& dictionary, int rows, int cols);

  // Recovers a frame of the array prepared for, with the dictionary prepared for. Counts at or below `touch_counts` are
  // taken as 0; the image is clipped to 0 to kCountMax, and measured taxels keep their value. Returns the image,
  // row-major, in the workspace. Tells the board, if there is one, before every row of patches.
  const float* recover(const SampleFrame& frame, int touch_counts, Workspace& work, Board* board = nullptr);

 private:
  void spread_samples(const SampleFrame& frame, int touch_counts, Workspace& work) const;
  void recover_patch(std::size_t top, std::size_t left, Workspace& work);
  void average(Workspace& work) const;

  PatchDictionary dictionary_{};
  std::size_t rows_ = 0;
  std::size_t cols_ = 0;
  PatchSide down_;
  PatchSide across_;
  FastOmp omp_;
};

}  // namespace acts
