// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// FastOMP: explains a few measured values as a sum of few columns of a dictionary. The paper's method ("Sparse Recovery
// and Tactile Reconstruction"); acts_recon/sparse/fastomp.py is its readable reference.
#pragma once

#include <array>
#include <cstdint>

namespace acts {

constexpr int kMaxAtoms = 16;  // columns chosen at most: a quarter of a patch of 8 x 8

// Atoms for m measured pixels: a quarter, halves rounded up, at least 1.
constexpr int sparsity(int m) {
  return m < 6 ? 1 : (m + 2) / 4;
}

// What is to be explained: y[i] was measured where the dictionary has its row rows[i].
struct SparseProblem {
  const float* dictionary;  // a row after the other, as it is uploaded; only the rows measured are read
  int columns;
  const std::uint16_t* rows;
  const float* y;
  int m;
  int n_atoms;  // columns to choose at most, 1 to kMaxAtoms
};

class FastOmp {
 public:
  // Chooses columns and their coefficients; returns how many, fewer than n_atoms where nothing is left to explain.
  // `residual` has room for m values, `q` for n_atoms * m.
  int solve(const SparseProblem& problem, float* residual, float* q);

  int chosen(int i) const { return chosen_[static_cast<std::size_t>(i)]; }
  float coefficient(int i) const { return coefficients_[static_cast<std::size_t>(i)]; }

 private:
  std::array<std::uint16_t, kMaxAtoms> chosen_{};
  std::array<float, kMaxAtoms> coefficients_{};
  std::array<float, kMaxAtoms * kMaxAtoms> r_{};
};

}  // namespace acts
