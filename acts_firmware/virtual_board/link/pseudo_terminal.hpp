// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The virtual board's end of a pseudo-terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace acts {

// Raw, non-blocking, with a symbolic link to the host's end at a path that stays the same from run to run. Throws
// std::runtime_error where it cannot be made.
class PseudoTerminal {
 public:
  explicit PseudoTerminal(const std::string& link);
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal();

  enum class Event : std::uint8_t { kNone, kOpened, kClosed };

  // Notices whether the host's end was opened or closed, and whether the host has sent something. That it was closed
  // and opened again since the last call counts as opened.
  Event service();

  // Takes what the host had sent when `service` was last called: number of bytes, 0 for none. Never waits. What has
  // come since may be the first words of a host whose opening is not noticed yet, and the answer would be cleared away
  // then.
  std::size_t read(std::uint8_t* data, std::size_t capacity);

  bool open() const { return open_; }

  // The plug is drawn: what the host has open ends, and the link goes. A new terminal of another name stands by.
  void unplug();

  // The link leads to the new terminal.
  void plug_in();

  // Number of bytes taken, 0 when the terminal's buffer is full. Never waits.
  std::size_t write(const std::uint8_t* data, std::size_t length);

  const std::string& port() const { return port_; }

 private:
  // Makes a terminal that nobody knows yet.
  void make_terminal();
  void make_link() const;
  void remove_link() const;
  void discard_unread() const;
  // Begins to watch the host's end anew.
  void watch();
  // Whether at some time since the last call nobody had the host's end open any more.
  bool was_left();

  int master_ = -1;
  int watch_ = -1;   // of inotify; -1 where the system has none left
  int openers_ = 0;  // of the host's end, since the watch began
  int came_ = 0;     // those of them that came after the last one that left, when was_left() last looked
  bool open_ = false;
  bool has_input_ = false;
  std::string link_;
  std::string port_;
};

}  // namespace acts
