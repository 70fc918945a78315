// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "link/claim.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "option_error.hpp"
#include "same_file.hpp"

namespace acts {

namespace fs = std::filesystem;

namespace {

constexpr const char* kOther =
    "give another folder: run_dir:=/dev/shm/NAME, or run_dir:=/tmp/NAME where that is full or read-only "
    "(to a program without a launch file: another path)";
constexpr mode_t kOwnerOnly = 0700;
constexpr std::size_t kLongestCommand = 100;
constexpr std::size_t kLongestLock = 24;  // a process id and a newline
// Programs of a launch that was killed end shortly after it.
constexpr auto kWait = std::chrono::seconds(1);

template <typename Error = std::runtime_error>
[[noreturn]] void refuse(const std::string& what) {
  throw Error(what + kOther);
}

// What an opening says of a path that will never do; a full disk may have room again.
bool is_lasting(int error) {
  return error == EROFS || error == EACCES || error == ENOENT || error == ENOTDIR;
}

std::string user(uid_t id) {
  const passwd* entry = getpwuid(id);
  return entry != nullptr ? entry->pw_name : "user " + std::to_string(id);
}

std::string process_name(const std::string& pid) {
  if (pid.empty()) {
    return "another process";
  }
  std::ifstream file("/proc/" + pid + "/cmdline", std::ios::binary);
  std::string command((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  while (!command.empty() && command.back() == '\0') {
    command.pop_back();
  }
  std::replace(command.begin(), command.end(), '\0', ' ');
  if (command.size() > kLongestCommand) {
    command = command.substr(0, kLongestCommand) + "...";
  }
  return "process " + pid + (command.empty() ? "" : " (" + command + ")");
}

void make_private(const fs::path& folder) {
  if (folder.string().front() == '~') {
    // Who removed a folder of that name from a command line would remove his home.
    refuse<OptionError>("the folder " + folder.string() +
                        " begins with ~, which no shell replaces there; write $HOME, or ");
  }
  fs::path made;
  for (const fs::path& part : folder) {
    made /= part;
    if (mkdir(made.c_str(), kOwnerOnly) != 0 && errno != EEXIST) {
      refuse<OptionError>("the folder " + folder.string() + " cannot be made (" + std::strerror(errno) + "); ");
    }
  }
  struct stat status{};
  if (lstat(folder.c_str(), &status) != 0) {
    refuse<OptionError>("the folder " + folder.string() + " cannot be looked at (" + std::strerror(errno) + "); ");
  }
  if (S_ISLNK(status.st_mode)) {
    refuse<OptionError>("the folder " + folder.string() + " is a symbolic link; name what it leads to, or ");
  }
  if (!S_ISDIR(status.st_mode)) {
    refuse<OptionError>(folder.string() + " is no folder; ");
  }
  if ((status.st_mode & S_ISVTX) != 0) {
    return;
  }
  if (status.st_uid != geteuid()) {
    refuse<OptionError>("the folder " + folder.string() + " belongs to " + user(status.st_uid) + "; ");
  }
  if ((status.st_mode & S_IWOTH) != 0) {
    refuse<OptionError>("anybody may write to the folder " + folder.string() + "; `chmod o-w " + folder.string() +
                        "`, or ");
  }
}

}  // namespace

Claim::Claim(const std::string& path) : lock_path_(path + ".lock") {
  const fs::path parent = fs::path(path).parent_path();
  make_private(parent.empty() ? fs::path(".") : parent);
  if (!lock()) {
    refuse<OptionError>(path + " is in use by " + holder() + "; end that program, or ");
  }
  if (!is_lock()) {
    close(file_);
    refuse<OptionError>(lock_path_ + " is no lock of a file, and would be lost; ");
  }
  const std::string number = std::to_string(getpid()) + "\n";
  if (ftruncate(file_, 0) != 0 || pwrite(file_, number.data(), number.size(), 0) < 0) {
    refuse(lock_path_ + " cannot be written (" + std::strerror(errno) + "); ");
  }
}

Claim::~Claim() {
  // While it is still locked: afterwards it may be another's. It is already where somebody has cleared the folder.
  if (leads_to(lock_path_, file_)) {
    unlink(lock_path_.c_str());
  }
  close(file_);
}

bool Claim::lock() {
  const auto end = std::chrono::steady_clock::now() + kWait;
  while (true) {
    file_ = open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
    if (file_ < 0) {
      const int error = errno;
      const std::string what = lock_path_ + " cannot be opened (" + std::strerror(error) + "); ";
      if (is_lasting(error)) {
        refuse<OptionError>(what);
      }
      refuse(what);
    }
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      close(file_);
      if (std::chrono::steady_clock::now() > end) {
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      continue;
    }
    if (leads_to(lock_path_, file_)) {
      return true;
    }
    close(file_);  // the one before us has just given it up, and the file with it
  }
}

bool Claim::is_lock() const {
  std::array<char, kLongestLock + 1> content{};
  const ssize_t length = pread(file_, content.data(), content.size(), 0);
  if (length < 0 || static_cast<std::size_t>(length) > kLongestLock) {
    return false;
  }
  return std::all_of(content.begin(), content.begin() + length,
                     [](char c) { return c == '\n' || (c >= '0' && c <= '9'); });
}

std::string Claim::holder() const {
  std::ifstream file(lock_path_);
  std::string pid;
  file >> pid;
  return process_name(pid);
}

}  // namespace acts
