// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/recovery/model_output.hpp"

namespace acts {

const float* ModelOutput::image(const Model& dictionary, const SampleFrame& frame, int touch_counts, Board& board) {
  const PatchDictionary patches{dictionary.values, dictionary.columns, dictionary.patch_side, dictionary.patch_step};
  if (!recovery_.prepare(patches, frame.rows, frame.cols)) {
    return nullptr;
  }
  return recovery_.recover(frame, touch_counts, work_.image, &board);
}

const ObjectResult& ModelOutput::object(const Model& library, const SampleFrame& frame, int touch_counts) {
  const ObjectLibrary objects{library.values, library.classes, library.columns, library.objects};
  return classifier_.classify(objects, frame, touch_counts, kObjectAtoms, work_.object);
}

}  // namespace acts
