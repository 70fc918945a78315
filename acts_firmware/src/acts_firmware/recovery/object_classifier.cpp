// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/recovery/object_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace acts {

const ObjectResult& ObjectClassifier::classify(const ObjectLibrary& library, const SampleFrame& frame, int touch_counts,
                                               int n_atoms, Workspace& work) {
  float square = 0.0F;
  for (std::size_t i = 0; i < frame.m; ++i) {
    work.y[i] = frame.counts[i] > touch_counts ? static_cast<float>(frame.counts[i]) : 0.0F;
    square += work.y[i] * work.y[i];
  }
  result_.touched = square > 0.0F;
  result_.classes = library.classes;
  std::fill_n(result_.residuals.begin(), library.classes, 1.0F);
  if (result_.touched) {
    const int m = frame.m;
    const SparseProblem problem{library.values,
                                library.columns,
                                frame.indices.data(),
                                work.y.data(),
                                m,
                                std::min({n_atoms, m, library.columns, atoms_limit(m)})};
    const int chosen = omp_.solve(problem, work.residual.data(), work.q.data());
    const float norm = std::sqrt(square);
    for (int i = 0; i < chosen; ++i) {
      const int class_number = library.class_of_column[omp_.chosen(i)];
      // Of a class without chosen columns all is left.
      result_.residuals[static_cast<std::size_t>(class_number)] =
          residual_of(library, class_number, chosen, frame, work) / norm;
    }
  }
  decide();
  return result_;
}

float ObjectClassifier::residual_of(const ObjectLibrary& library, int class_number, int chosen,
                                    const SampleFrame& frame, Workspace& work) const {
  const auto columns = static_cast<std::size_t>(library.columns);
  std::copy_n(work.y.begin(), frame.m, work.residual.begin());
  for (int i = 0; i < chosen; ++i) {
    const auto column = static_cast<std::size_t>(omp_.chosen(i));
    if (library.class_of_column[column] != class_number) {
      continue;
    }
    const float coefficient = omp_.coefficient(i);
    for (std::size_t k = 0; k < frame.m; ++k) {
      work.residual[k] -= coefficient * library.values[frame.indices[k] * columns + column];
    }
  }
  float square = 0.0F;
  for (std::size_t k = 0; k < frame.m; ++k) {
    square += work.residual[k] * work.residual[k];
  }
  return std::sqrt(square);
}

void ObjectClassifier::decide() {
  float smallest = INFINITY;
  float second = INFINITY;
  result_.best = 0;
  // From the first class on: NaN, which an uploaded library may cause, is below nothing.
  for (int number = 0; number < result_.classes; ++number) {
    const float residual = result_.residuals[static_cast<std::size_t>(number)];
    if (residual < smallest) {
      second = smallest;
      smallest = residual;
      result_.best = number;
    } else {
      second = std::min(second, residual);
    }
  }
  const bool decidable = result_.touched && result_.classes > 1 && second > 0.0F && std::isfinite(smallest);
  result_.confidence = decidable ? 1.0F - smallest / second : 0.0F;
}

}  // namespace acts
