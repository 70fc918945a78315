// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "control_pipe.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "option_error.hpp"
#include "same_file.hpp"

namespace acts {

namespace fs = std::filesystem;

namespace {

// Whether a process reads the pipe at a path; that of a board that was killed nobody does.
bool is_read(const std::string& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    return false;
  }
  close(descriptor);
  return true;
}

}  // namespace

ControlPipe::ControlPipe(const std::string& path) : path_(path) {
  std::error_code error;
  if (fs::path(path).has_parent_path()) {
    fs::create_directories(fs::path(path).parent_path(), error);
  }
  const fs::file_status status = fs::symlink_status(path, error);
  if (fs::exists(status) && !fs::is_fifo(status)) {
    throw OptionError("--control " + path + ": something else than a named pipe is there; remove it");
  }
  if (fs::exists(status) && is_read(path)) {
    throw OptionError("--control " + path + ": in use by a running board; end that one, or give another path");
  }
  fs::remove(path, error);  // of a board that was killed
  if (mkfifo(path.c_str(), 0600) != 0) {
    throw OptionError("--control " + path + ": cannot be made (" + std::strerror(errno) + ")");
  }
  // Open for writing too: the pipe then does not end when a writer closes it.
  pipe_ = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (pipe_ < 0) {
    throw OptionError("--control " + path + ": cannot be opened (" + std::strerror(errno) + ")");
  }
}

ControlPipe::~ControlPipe() {
  if (leads_to(path_, pipe_)) {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  close(pipe_);
}

std::vector<std::string> ControlPipe::read_lines() {
  std::array<char, 1024> buffer{};
  const ssize_t length = read(pipe_, buffer.data(), buffer.size());
  std::vector<std::string> lines;
  if (length <= 0) {
    return lines;
  }
  pending_.append(buffer.data(), static_cast<std::size_t>(length));
  for (std::size_t end = pending_.find('\n'); end != std::string::npos; end = pending_.find('\n')) {
    if (end > 0) {
      lines.push_back(pending_.substr(0, end));
    }
    pending_.erase(0, end + 1);
  }
  return lines;
}

}  // namespace acts
