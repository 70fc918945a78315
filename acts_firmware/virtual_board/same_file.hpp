// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Whether what lies at a path is still this process's own.
#pragma once

#include <sys/stat.h>

#include <string>

namespace acts {

// Whether a path leads to an open file, and not to one that has taken its place: where somebody has cleared the folder
// meanwhile, another process may have made its own there.
inline bool leads_to(const std::string& path, int file) {
  struct stat open{};
  struct stat present{};
  return fstat(file, &open) == 0 && lstat(path.c_str(), &present) == 0 && open.st_ino == present.st_ino &&
         open.st_dev == present.st_dev;
}

}  // namespace acts
