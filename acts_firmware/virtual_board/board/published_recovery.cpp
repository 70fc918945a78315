// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "board/published_recovery.hpp"

#include <array>
#include <cstddef>

namespace acts {

namespace {

// Both axes of recovery, and the measurements of classification.
constexpr std::array<double, 6> kGrid = {50, 100, 200, 300, 400, 500};
using Row = std::array<double, kGrid.size()>;  // over the measurements

// Over the atoms of the dictionary.
constexpr std::array<Row, kGrid.size()> kRecoveryUs = {{{491, 1715, 4835, 7844, 10728, 12027},
                                                        {793, 2473, 7770, 12862, 17398, 19680},
                                                        {1622, 4783, 13731, 23252, 31821, 35007},
                                                        {2533, 6892, 20151, 32261, 44088, 48911},
                                                        {2788, 9097, 26270, 42383, 51442, 65087},
                                                        {3340, 10117, 30974, 52500, 65325, 83905}}};

constexpr double kPublishedTaxels = 1024.0;

// Of classification: frame time minus that of sampling alone, for libraries of 60 and 90 columns.
constexpr Row kClassify60Us = {343, 681, 1326, 1967, 2614, 3222};
constexpr Row kClassify90Us = {604, 891, 1746, 2597, 3444, 4282};
// From 100 measurements on the two curves lie on 0.07 us a measurement and column, beginning at -31 columns.
constexpr double kColumnsAtNoTime = -31.0;

// The interval of the grid whose line is used at `at`.
std::size_t interval(double at) {
  std::size_t i = 0;
  while (i + 2 < kGrid.size() && at > kGrid[i + 1]) {
    ++i;
  }
  return i;
}

double along(const Row& values, double at) {
  const std::size_t i = interval(at);
  return values[i] + (at - kGrid[i]) * (values[i + 1] - values[i]) / (kGrid[i + 1] - kGrid[i]);
}

double over_measurements(const Row& row, double m) {
  return m < kGrid.front() ? row.front() * m / kGrid.front() : along(row, m);
}

double recovery_us(int atoms, double taxels, int m) {
  Row at_m{};
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    at_m[i] = over_measurements(kRecoveryUs[i], m * kPublishedTaxels / taxels);
  }
  return along(at_m, atoms) * taxels / kPublishedTaxels;
}

double classification_us(int columns, int m) {
  const double at_60 = over_measurements(kClassify60Us, m);
  const double at_90 = over_measurements(kClassify90Us, m);
  if (columns <= 60) {
    return at_60 * (columns - kColumnsAtNoTime) / (60 - kColumnsAtNoTime);
  }
  if (columns >= 90) {
    return at_90 * (columns - kColumnsAtNoTime) / (90 - kColumnsAtNoTime);
  }
  return at_60 + (at_90 - at_60) * (columns - 60) / 30;
}

}  // namespace

double published_recovery_us(Output output, const Model& model, const SamplingConfig& sampling, int m) {
  switch (output) {
    case Output::kSamples:
      break;
    case Output::kImage:
      return recovery_us(model.columns, sampling.rows * sampling.cols, m);
    case Output::kObject:
      return classification_us(model.columns, m);
  }
  return 0.0;
}

}  // namespace acts
