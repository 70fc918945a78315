// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// A file as this process's own, in a folder of one user alone; acts_sim/shared/run_folder.py does the same.
#pragma once

#include <string>

namespace acts {

// From the making on until the end, however the process ends. Makes the folder, for its user alone, where it is
// missing. Throws OptionError where another process has the file, which is named, and still has it after a second;
// where the folder is a symbolic link, is read-only, belongs to somebody else, or anybody may write to it (like /tmp it
// may be); where PATH.lock is something else than the lock of a process.
class Claim {
 public:
  explicit Claim(const std::string& path);
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  ~Claim();

 private:
  // False where another process has it, and keeps it.
  bool lock();
  // Whether the file holds what a process, perhaps one that was killed meanwhile, writes to its lock.
  bool is_lock() const;
  std::string holder() const;

  std::string lock_path_;
  int file_ = -1;
};

}  // namespace acts
