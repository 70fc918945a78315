// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/recovery/image_recovery.hpp"

#include <algorithm>
#include <cstddef>

namespace acts {

namespace {

// Written so that NaN, which an uploaded dictionary may cause, becomes 0.
float clip(float value) {
  constexpr auto kTop = static_cast<float>(kCountMax);
  return value > 0.0F ? std::min(value, kTop) : 0.0F;
}

}  // namespace

static_assert(sparsity(kMaxPatchPixels) <= kMaxAtoms, "a fully measured patch must not be cut short");

bool ImageRecovery::prepare(const PatchDictionary& dictionary, int rows, int cols) {
  dictionary_ = dictionary;
  rows_ = static_cast<std::size_t>(rows);
  cols_ = static_cast<std::size_t>(cols);
  const bool fits_down = down_.build(rows, dictionary.side, dictionary.step);
  const bool fits_across = across_.build(cols, dictionary.side, dictionary.step);
  return fits_down && fits_across;
}

const float* ImageRecovery::recover(const SampleFrame& frame, int touch_counts, Workspace& work, Board* board) {
  spread_samples(frame, touch_counts, work);
  std::fill_n(work.image.begin(), rows_ * cols_, 0.0F);
  for (std::size_t row = 0; row < down_.count(); ++row) {
    if (board != nullptr) {
      board->computing();
    }
    for (std::size_t col = 0; col < across_.count(); ++col) {
      if (work.pressed[row][col]) {
        recover_patch(down_.start(row), across_.start(col), work);
      }
    }
  }
  average(work);
  for (std::size_t i = 0; i < frame.m; ++i) {
    work.image[frame.indices[i]] = static_cast<float>(work.measured[frame.indices[i]]);
  }
  return work.image.data();
}

void ImageRecovery::spread_samples(const SampleFrame& frame, int touch_counts, Workspace& work) const {
  std::fill_n(work.measured.begin(), rows_ * cols_, std::int16_t{-1});
  for (auto& patches : work.pressed) {
    patches.fill(false);
  }
  for (std::size_t i = 0; i < frame.m; ++i) {
    const std::size_t taxel = frame.indices[i];
    const bool pressed = frame.counts[i] > touch_counts;
    work.measured[taxel] = pressed ? static_cast<std::int16_t>(frame.counts[i]) : std::int16_t{0};
    if (!pressed) {
      continue;
    }
    const std::size_t row = taxel / cols_;
    const std::size_t col = taxel % cols_;
    for (std::size_t down = 0; down < down_.overlap(row); ++down) {
      std::fill_n(work.pressed[down_.first(row) + down].begin() + static_cast<std::ptrdiff_t>(across_.first(col)),
                  across_.overlap(col), true);
    }
  }
}

void ImageRecovery::recover_patch(std::size_t top, std::size_t left, Workspace& work) {
  const auto side = static_cast<std::size_t>(dictionary_.side);
  std::size_t m = 0;
  std::uint16_t pixel = 0;
  for (std::size_t col = left; col < left + side; ++col) {
    const std::int16_t* taxel = work.measured.data() + top * cols_ + col;
    for (std::size_t row = 0; row < side; ++row, ++pixel, taxel += cols_) {
      if (*taxel >= 0) {
        work.pixels[m] = pixel;
        work.y[m] = static_cast<float>(*taxel);
        ++m;
      }
    }
  }
  const int measured = static_cast<int>(m);
  const SparseProblem problem{dictionary_.values, dictionary_.atoms, work.pixels.data(),
                              work.y.data(),      measured,          sparsity(measured)};
  const int chosen = omp_.solve(problem, work.residual.data(), work.q.data());
  const auto atoms = static_cast<std::size_t>(dictionary_.atoms);
  for (int i = 0; i < chosen; ++i) {
    const float coefficient = omp_.coefficient(i);
    const float* entry = dictionary_.values + omp_.chosen(i);
    for (std::size_t col = left; col < left + side; ++col) {
      float* taxel = work.image.data() + top * cols_ + col;
      for (std::size_t row = 0; row < side; ++row, entry += atoms, taxel += cols_) {
        *taxel += coefficient * *entry;
      }
    }
  }
}

void ImageRecovery::average(Workspace& work) const {
  float* taxel = work.image.data();
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col, ++taxel) {
      // Most of a skin is untouched; a division takes the board fourteen cycles.
      if (*taxel != 0.0F) {
        *taxel = clip(*taxel / static_cast<float>(down_.overlap(row) * across_.overlap(col)));
      }
    }
  }
}

}  // namespace acts
