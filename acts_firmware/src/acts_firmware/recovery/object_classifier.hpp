// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Which object presses: sparse representation-based classification (SRC) on the samples of one frame, as the paper's
// Fig. 9 does on the board. acts_recon/objects/classification.py is the readable reference.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/frame.hpp"
#include "acts_firmware/limits.hpp"
#include "acts_firmware/model/model.hpp"
#include "acts_firmware/recovery/fast_omp.hpp"

namespace acts {

constexpr int kObjectAtoms = 2;  // columns chosen on the board, as in the published sketch

// Full frames of known objects: a row a taxel of the array, a column a frame, and the class of every column, below
// `classes`, which is at most kMaxObjects.
struct ObjectLibrary {
  const float* values;
  const std::uint8_t* class_of_column;
  int columns;
  int classes;
};

struct ObjectResult {
  bool touched = false;  // whether a sample was pressed; else there is no object, and every residual is 1
  int best = 0;          // class of the smallest residual; the first of equal ones
  int classes = 0;
  // What the class's own columns leave of the samples, a norm relative to that of the samples: 0 explained, 1 not.
  std::array<float, kMaxObjects> residuals{};
  // 1 - smallest / second smallest residual: 0 undecided, 1 sure. 0 without touch, and where there is one class.
  float confidence = 0.0F;
};

class ObjectClassifier {
 public:
  // Room for chosen columns: kObjectAtoms of the largest frame, or more of a smaller one.
  static constexpr int kColumnRoom = kObjectAtoms * kMaxTaxels;

  // What a frame's classification works in (64 KB); nothing in it outlives the frame.
  struct Workspace {
    std::array<float, kMaxTaxels> y;
    std::array<float, kMaxTaxels> residual;
    std::array<float, kColumnRoom> q;
  };

  // Columns that can be chosen at most for a frame of m samples.
  static constexpr int atoms_limit(int m) { return m * kMaxAtoms <= kColumnRoom ? kMaxAtoms : kColumnRoom / m; }

  // Classifies a frame of the array that the library is of. Counts at or below `touch_counts` are taken as 0. At most
  // `n_atoms` columns, 1 to atoms_limit(frame.m), are chosen.
  const ObjectResult& classify(const ObjectLibrary& library, const SampleFrame& frame, int touch_counts, int n_atoms,
                               Workspace& work);

 private:
  float residual_of(const ObjectLibrary& library, int class_number, int chosen, const SampleFrame& frame,
                    Workspace& work) const;
  void decide();

  FastOmp omp_;
  ObjectResult result_;
};

}  // namespace acts
