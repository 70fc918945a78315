// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// A file mapped for reading.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace acts {

class MappedFile {
 public:
  MappedFile() = default;
  // Throws std::runtime_error, naming the path, where the file cannot be mapped.
  explicit MappedFile(const std::string& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }
  dev_t device() const { return device_; }
  ino_t inode() const { return inode_; }

 private:
  const std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace acts
