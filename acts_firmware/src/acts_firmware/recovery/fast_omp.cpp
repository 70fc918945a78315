// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/recovery/fast_omp.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace acts {

namespace {

constexpr float kRegularisation = 1e-4F;  // so that a column that adds nothing does not divide by 0

// Columns whose correlations are summed together: their sums stay in registers, their entries lie side by side.
constexpr std::size_t kLanes = 8;

struct Best {
  float size = 0.0F;
  int column = -1;

  void offer(float correlation, std::size_t candidate) {
    const float magnitude = std::fabs(correlation);
    if (magnitude > size) {
      size = magnitude;
      column = static_cast<int>(candidate);
    }
  }
};

float dot(const float* a, const float* b, int n) {
  std::array<float, 4> sums{};
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    sums[0] += a[i] * b[i];
    sums[1] += a[i + 1] * b[i + 1];
    sums[2] += a[i + 2] * b[i + 2];
    sums[3] += a[i + 3] * b[i + 3];
  }
  for (; i < n; ++i) {
    sums[0] += a[i] * b[i];
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

void subtract(float* a, float share, const float* b, int n) {
  for (int i = 0; i < n; ++i) {
    a[i] -= share * b[i];
  }
}

// The column whose correlation with the residual is largest in magnitude, -1 where all are 0.
int best_column(const SparseProblem& problem, const float* residual) {
  const auto columns = static_cast<std::size_t>(problem.columns);
  Best best;
  std::size_t first = 0;
  for (; first + kLanes <= columns; first += kLanes) {
    std::array<float, kLanes> sums{};
    for (int i = 0; i < problem.m; ++i) {
      const float* row = problem.dictionary + problem.rows[i] * columns + first;
      const float value = residual[i];
#pragma GCC unroll 8
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        sums[lane] += value * row[lane];
      }
    }
#pragma GCC unroll 8
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      best.offer(sums[lane], first + lane);
    }
  }
  for (; first < columns; ++first) {
    float sum = 0.0F;
    for (int i = 0; i < problem.m; ++i) {
      sum += residual[i] * problem.dictionary[problem.rows[i] * columns + first];
    }
    best.offer(sum, first);
  }
  return best.column;
}

}  // namespace

int FastOmp::solve(const SparseProblem& problem, float* residual, float* q) {
  const int m = problem.m;
  const auto stride = static_cast<std::size_t>(m);
  const auto columns = static_cast<std::size_t>(problem.columns);
  const auto limit = static_cast<std::size_t>(std::min(problem.n_atoms, kMaxAtoms));
  const auto r = [this](std::size_t row, std::size_t col) -> float& { return r_[row * kMaxAtoms + col]; };
  std::copy_n(problem.y, stride, residual);
  std::size_t s = 0;
  for (; s < limit; ++s) {
    const int column = best_column(problem, residual);
    if (column < 0) {
      break;
    }
    chosen_[s] = static_cast<std::uint16_t>(column);
    float* w = q + s * stride;
    for (std::size_t i = 0; i < stride; ++i) {
      w[i] = problem.dictionary[problem.rows[i] * columns + chosen_[s]];
    }
    for (std::size_t j = 0; j < s; ++j) {
      const float* kept = q + j * stride;
      r(j, s) = dot(kept, w, m);
      subtract(w, r(j, s) / r(j, j), kept, m);
    }
    r(s, s) = dot(w, w, m) + kRegularisation;
    subtract(residual, dot(w, residual, m) / r(s, s), w, m);
  }
  for (std::size_t i = s; i-- > 0;) {
    float value = dot(q + i * stride, problem.y, m);
    for (std::size_t j = i + 1; j < s; ++j) {
      value -= r(i, j) * coefficients_[j];
    }
    coefficients_[i] = value / r(i, i);
  }
  return static_cast<int>(s);
}

}  // namespace acts
