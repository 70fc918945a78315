// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Lines that others write to a named pipe while the board runs.
#pragma once

#include <string>
#include <vector>

namespace acts {

// Made at the start, removed at the end. Throws std::runtime_error where it cannot be made, or another board has it.
class ControlPipe {
 public:
  explicit ControlPipe(const std::string& path);
  ControlPipe(const ControlPipe&) = delete;
  ControlPipe& operator=(const ControlPipe&) = delete;
  ~ControlPipe();

  // The lines that came in since the last call, without their ends. Never waits.
  std::vector<std::string> read_lines();

 private:
  std::string path_;
  std::string pending_;
  int pipe_ = -1;
};

}  // namespace acts
