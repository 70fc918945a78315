// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/model/model_store.hpp"

#include <cmath>
#include <cstring>

#include "acts_firmware/limits.hpp"
#include "acts_firmware/recovery/patch_cover.hpp"
#include "acts_firmware/wire/packet.hpp"

namespace acts {

namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "models are taken over as they come on the wire");

std::uint64_t value_bytes(const Model& model) {
  return std::uint64_t{model.rows} * model.columns * sizeof(float);
}

bool possible(const Model& model, std::uint32_t bytes) {
  if (model.rows == 0 || model.columns == 0 || bytes > kModelBytes) {
    return false;
  }
  switch (model.kind) {
    case ModelKind::kPatchDictionary:
      return model.patch_side <= kMaxPatchSide && model.rows == model.patch_side * model.patch_side &&
             model.patch_step >= 1 && model.patch_step <= model.patch_side && model.objects == 0 &&
             bytes == value_bytes(model);
    case ModelKind::kObjectLibrary:
      return model.rows <= kMaxTaxels && model.patch_side == 0 && model.patch_step == 0 && model.objects >= 1 &&
             model.objects <= kMaxObjects && bytes == value_bytes(model) + model.columns;
    case ModelKind::kNone:
      break;
  }
  return false;
}

}  // namespace

UploadError ModelStore::begin(const Model& announced, std::uint32_t bytes) {
  if (!possible(announced, bytes)) {
    return UploadError::kImpossible;
  }
  model_ = {};
  announced_ = announced;
  announced_.values = nullptr;
  announced_.classes = nullptr;
  bytes_ = bytes;
  received_ = 0;
  crc_ = 0;
  uploading_ = true;
  return UploadError::kNone;
}

UploadError ModelStore::add(std::uint32_t offset, const std::uint8_t* data, std::size_t length) {
  auto* bytes = reinterpret_cast<std::uint8_t*>(memory_.data());
  const std::uint64_t end = std::uint64_t{offset} + length;
  if (end <= received_ && std::memcmp(bytes + offset, data, length) == 0) {
    return UploadError::kNone;
  }
  if (!uploading_ || offset != received_ || end > bytes_) {
    return UploadError::kOutOfOrder;
  }
  std::memcpy(bytes + offset, data, length);
  crc_ = crc32(data, length, crc_);
  received_ += static_cast<std::uint32_t>(length);
  return UploadError::kNone;
}

UploadError ModelStore::end() {
  if (!uploading_) {
    return ended_;
  }
  if (received_ != bytes_) {
    return UploadError::kOutOfOrder;
  }
  uploading_ = false;
  ended_ = check();
  if (ended_ == UploadError::kNone) {
    model_ = announced_;
    model_.values = memory_.data();
    if (model_.kind == ModelKind::kObjectLibrary) {
      model_.classes = reinterpret_cast<const std::uint8_t*>(memory_.data()) + value_bytes(model_);
    }
  }
  return ended_;
}

UploadError ModelStore::check() const {
  if (crc_ != announced_.crc32) {
    return UploadError::kChecksum;
  }
  const std::size_t values = std::size_t{announced_.rows} * announced_.columns;
  for (std::size_t i = 0; i < values; ++i) {
    if (!std::isfinite(memory_[i])) {
      return UploadError::kImpossible;
    }
  }
  if (announced_.kind == ModelKind::kObjectLibrary) {
    const auto* classes = reinterpret_cast<const std::uint8_t*>(memory_.data() + values);
    std::uint64_t seen = 0;
    for (std::size_t column = 0; column < announced_.columns; ++column) {
      if (classes[column] >= announced_.objects) {
        return UploadError::kImpossible;
      }
      seen |= std::uint64_t{1} << classes[column];
    }
    // An object without a column could never be recognised.
    if (seen != ~std::uint64_t{0} >> (kMaxObjects - announced_.objects)) {
      return UploadError::kImpossible;
    }
  }
  return UploadError::kNone;
}

}  // namespace acts
