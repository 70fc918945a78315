// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the board recovers images or tells objects with, as a host has uploaded it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace acts {

// Numbers on the wire.
enum class ModelKind : std::uint8_t { kNone = 0, kPatchDictionary = 1, kObjectLibrary = 2 };

constexpr int kMaxObjects = 64;
constexpr std::size_t kModelBytes = 262144;  // 64 x 1000 or 1024 x 60 values of 4 bytes, and class numbers

// A matrix of rows x columns, row-major: pixels of a patch (numbered column first) by atoms, or taxels of the array by
// library columns. All zero and null where the board holds none.
struct Model {
  ModelKind kind = ModelKind::kNone;
  std::uint8_t patch_side = 0;  // taxels; 0 for an object library, as is patch_step
  std::uint8_t patch_step = 0;  // between neighbouring patches
  std::uint8_t objects = 0;     // 0 for a patch dictionary
  std::uint16_t rows = 0;
  std::uint16_t columns = 0;
  std::uint32_t crc32 = 0;                // of the bytes as uploaded
  const float* values = nullptr;          // finite
  const std::uint8_t* classes = nullptr;  // object of each column, 0 to objects - 1; null for a patch dictionary
};

// Room for one model. A quarter of a Teensy's RAM: whoever makes a `Firmware` says where it is.
using ModelMemory = std::array<float, kModelBytes / sizeof(float)>;

}  // namespace acts
