// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "field/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace acts {

MappedFile::MappedFile(const std::string& path) {
  // Not waiting: of a pipe, open() would wait for its writer.
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    const std::string why = std::string(": cannot be read (") + std::strerror(errno) + ")";
    const bool is_home = path.rfind('~', 0) == 0;
    throw std::runtime_error(path + why + (is_home ? "; ~ is replaced by no shell there; write $HOME" : ""));
  }
  struct stat status{};
  void* map = MAP_FAILED;
  if (fstat(file, &status) == 0 && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    map = mmap(nullptr, size_, PROT_READ, MAP_SHARED, file, 0);
  }
  close(file);
  if (map == MAP_FAILED) {
    throw std::runtime_error(path + ": is empty or cannot be mapped");
  }
  data_ = static_cast<const std::uint8_t*>(map);
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

MappedFile::MappedFile(MappedFile&& other) noexcept {
  *this = std::move(other);
}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(device_, other.device_);
  std::swap(inode_, other.inode_);
  return *this;
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) {
    munmap(const_cast<std::uint8_t*>(data_), size_);
  }
}

}  // namespace acts
