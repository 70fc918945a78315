// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the board makes of a frame by itself, with the model that a host has uploaded: an image or an object.
#pragma once

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/model/model.hpp"
#include "acts_firmware/recovery/image_recovery.hpp"
#include "acts_firmware/recovery/object_classifier.hpp"

namespace acts {

class ModelOutput {
 public:
  // The image of a frame (row-major, until the next call), recovered with a patch dictionary; null where its patches do
  // not fit the frame's array. Tells the board again and again that it computes.
  const float* image(const Model& dictionary, const SampleFrame& frame, int touch_counts, Board& board);

  // The object of a frame, found with an object library of the frame's array.
  const ObjectResult& object(const Model& library, const SampleFrame& frame, int touch_counts);

 private:
  // Each frame begins from nothing and has one output, so that both work in the same memory.
  union Workspace {
    ImageRecovery::Workspace image;
    ObjectClassifier::Workspace object;
  };

  ImageRecovery recovery_;
  ObjectClassifier classifier_;
  Workspace work_{};
};

}  // namespace acts
