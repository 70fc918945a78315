// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "link/pseudo_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/inotify.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "option_error.hpp"

namespace acts {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTerminals = "/dev/pts/";

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + " (" + std::strerror(errno) + ")");
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link) : link_(link) {
  make_terminal();
  plug_in();
}

PseudoTerminal::~PseudoTerminal() {
  remove_link();
  if (watch_ >= 0) {
    close(watch_);
  }
  close(master_);
}

void PseudoTerminal::unplug() {
  remove_link();
  const int drawn = master_;
  has_input_ = false;
  make_terminal();  // before the old one is closed, whose name is free then
  close(drawn);
}

void PseudoTerminal::plug_in() {
  if (!link_.empty()) {
    make_link();
  }
}

void PseudoTerminal::make_terminal() {
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 128> name{};
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
      ptsname_r(master_, name.data(), name.size()) != 0) {
    fail("no pseudo-terminal can be had");
  }
  port_ = name.data();
  termios raw{};
  if (tcgetattr(master_, &raw) != 0) {
    fail(port_ + ": its settings cannot be read");
  }
  cfmakeraw(&raw);
  if (tcsetattr(master_, TCSANOW, &raw) != 0) {
    fail(port_ + ": cannot be made raw");
  }
  // Only after a first opening and closing does the system report that nobody has the other end open.
  discard_unread();
  watch();
}

void PseudoTerminal::remove_link() const {
  std::error_code ignored;
  if (!link_.empty() && fs::read_symlink(link_, ignored) == port_) {
    fs::remove(link_, ignored);
  }
}

void PseudoTerminal::make_link() const {
  const fs::path path(link_);
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (fs::exists(status) && !fs::is_symlink(status)) {
    throw OptionError("--link " + link_ + ": something else than a symbolic link is there; remove it");
  }
  // A link of a board that was killed leads to a pseudo-terminal; any other is somebody's.
  const std::string target = fs::is_symlink(status) ? fs::read_symlink(path, error).string() : kTerminals;
  if (target.rfind(kTerminals, 0) != 0) {
    throw OptionError("--link " + link_ + ": a link to " + target + " is there; remove it");
  }
  const fs::path fresh = link_ + ".new";
  fs::remove(fresh, error);
  error.clear();
  fs::create_symlink(port_, fresh, error);
  if (!error) {
    fs::rename(fresh, path, error);  // replaces a stale link in one step
  }
  if (error) {
    throw std::runtime_error("--link " + link_ + ": cannot be made (" + error.message() + ")");
  }
}

void PseudoTerminal::discard_unread() const {
  tcflush(master_, TCOFLUSH);
  const int slave = ::open(port_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (slave >= 0) {
    tcflush(slave, TCIFLUSH);
    close(slave);
  }
}

void PseudoTerminal::watch() {
  if (watch_ >= 0) {
    close(watch_);  // takes the system many milliseconds: only for another terminal
  }
  openers_ = 0;
  watch_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (watch_ >= 0) {
    inotify_add_watch(watch_, port_.c_str(), IN_OPEN | IN_CLOSE);
  }
}

bool PseudoTerminal::was_left() {
  bool left = false;
  came_ = 0;
  alignas(inotify_event) std::array<char, 4096> events{};
  for (ssize_t length = 0; (length = ::read(watch_, events.data(), events.size())) > 0;) {
    for (ssize_t at = 0; at < length;) {
      const auto* event = reinterpret_cast<const inotify_event*>(events.data() + at);
      if ((event->mask & IN_OPEN) != 0) {
        ++openers_;
        ++came_;
      } else if ((event->mask & IN_CLOSE) != 0) {
        // None is counted where it was opened before the watch began.
        openers_ = std::max(openers_ - 1, 0);
        came_ = 0;
        left = left || openers_ == 0;
      }
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
    }
  }
  return left;
}

PseudoTerminal::Event PseudoTerminal::service() {
  // The terminal tells whether somebody has the other end open now, the watch whether nobody had meanwhile. In this
  // order: a host that comes between the two is seen by the watch.
  std::array<pollfd, 2> states = {{{master_, POLLIN, 0}, {watch_, POLLIN, 0}}};
  if (poll(states.data(), states.size(), 0) < 0) {
    has_input_ = false;
    return Event::kNone;
  }
  has_input_ = (states[0].revents & POLLIN) != 0;
  const bool now_open = (states[0].revents & POLLHUP) == 0;
  came_ = 0;
  const bool left = (states[1].revents & POLLIN) != 0 && was_left();
  const bool was_open = open_;
  open_ = now_open;
  if (was_open && (left || !now_open)) {
    // Nobody was there a moment ago. The system may tell of several that leave as of one.
    openers_ = now_open ? openers_ : came_;
    discard_unread();  // the next host must not begin with the last one's leftovers
    was_left();        // the watch has seen that as well
    // The first words of one that has come in the meantime are read together with the last ones of the one before.
    open_ = now_open || openers_ > 0;
    return open_ ? Event::kOpened : Event::kClosed;
  }
  return now_open && !was_open ? Event::kOpened : Event::kNone;
}

std::size_t PseudoTerminal::read(std::uint8_t* data, std::size_t capacity) {
  if (!has_input_) {
    return 0;
  }
  const ssize_t taken = ::read(master_, data, capacity);
  has_input_ = taken == static_cast<ssize_t>(capacity);
  return taken > 0 ? static_cast<std::size_t>(taken) : 0;
}

std::size_t PseudoTerminal::write(const std::uint8_t* data, std::size_t length) {
  const ssize_t taken = ::write(master_, data, length);
  return taken > 0 ? static_cast<std::size_t>(taken) : 0;
}

}  // namespace acts
