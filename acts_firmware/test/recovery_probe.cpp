// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The core's recovery and classification behind C functions, for ctypes.
#include <algorithm>
#include <cstdint>
#include <memory>

#include "acts_firmware/recovery/image_recovery.hpp"
#include "acts_firmware/recovery/object_classifier.hpp"
#include "board/published_recovery.hpp"

namespace {

std::unique_ptr<acts::SampleFrame> make_frame(const std::uint16_t* indices, const std::uint16_t* counts, int m) {
  auto frame = std::make_unique<acts::SampleFrame>();
  for (int i = 0; i < m; ++i) {
    frame->append(indices[i], counts[i]);
  }
  return frame;
}

}  // namespace

extern "C" {

// Returns 0 where patches do not fit the array.
int probe_recover(const float* dictionary, int atoms, int side, int step, int rows, int cols,
                  const std::uint16_t* indices, const std::uint16_t* counts, int m, int touch_counts, float* image) {
  const auto recovery = std::make_unique<acts::ImageRecovery>();
  if (!recovery->prepare({dictionary, atoms, side, step}, rows, cols)) {
    return 0;
  }
  const auto work = std::make_unique<acts::ImageRecovery::Workspace>();
  const auto frame = make_frame(indices, counts, m);
  std::copy_n(recovery->recover(*frame, touch_counts, *work), rows * cols, image);
  return 1;
}

// Returns the class of the smallest residual, -1 without touch.
int probe_classify(const float* library, const std::uint8_t* class_of_column, int columns, int classes,
                   const std::uint16_t* indices, const std::uint16_t* counts, int m, int touch_counts, int n_atoms,
                   float* residuals, float* confidence) {
  const auto classifier = std::make_unique<acts::ObjectClassifier>();
  const auto work = std::make_unique<acts::ObjectClassifier::Workspace>();
  const auto frame = make_frame(indices, counts, m);
  const acts::ObjectLibrary objects{library, class_of_column, columns, classes};
  const acts::ObjectResult& result = classifier->classify(objects, *frame, touch_counts, n_atoms, *work);
  std::copy_n(result.residuals.begin(), classes, residuals);
  *confidence = result.confidence;
  return result.touched ? result.best : -1;
}

// Output numbers as on the wire.
double probe_published_recovery_us(int output, int columns, int rows, int cols, int m) {
  acts::Model model;
  model.columns = static_cast<std::uint16_t>(columns);
  acts::SamplingConfig sampling;
  sampling.rows = rows;
  sampling.cols = cols;
  return acts::published_recovery_us(static_cast<acts::Output>(output), model, sampling, m);
}

int probe_atoms_limit(int m) {
  return acts::ObjectClassifier::atoms_limit(m);
}

}  // extern "C"
