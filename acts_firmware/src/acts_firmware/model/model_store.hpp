// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Takes an uploaded model piece by piece and puts it into force when all of it is right.
#pragma once

#include <cstddef>
#include <cstdint>

#include "acts_firmware/model/model.hpp"

namespace acts {

enum class UploadError : std::uint8_t { kNone, kImpossible, kOutOfOrder, kChecksum };

// Every step may be repeated, as by a host that has missed the reply.
class ModelStore {
 public:
  explicit ModelStore(ModelMemory& memory) : memory_(memory) {}

  // Announces a model of `bytes` bytes with the checksum `announced.crc32`; its pointers are not looked at. Where the
  // model is possible, the one in force is gone.
  UploadError begin(const Model& announced, std::uint32_t bytes);

  // The bytes from `offset` on; they must continue what is there, or repeat some of it.
  UploadError add(std::uint32_t offset, const std::uint8_t* data, std::size_t length);

  // Checks the whole and puts it into force.
  UploadError end();

  bool uploading() const { return uploading_; }
  std::uint32_t received() const { return received_; }  // the offset that add() wants next

  const Model& model() const { return model_; }  // the one in force

 private:
  UploadError check() const;

  ModelMemory& memory_;
  Model model_;
  Model announced_;
  bool uploading_ = false;
  UploadError ended_ = UploadError::kOutOfOrder;  // how the last upload ended; no upload is none that could
  std::uint32_t bytes_ = 0;
  std::uint32_t received_ = 0;
  std::uint32_t crc_ = 0;
};

}  // namespace acts
