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

  // Notices whether the host's end was opened or closed, and reads off and discards what the host has sent.
  Event service();

  bool open() const { return open_; }

  // Number of bytes taken, 0 when the terminal's buffer is full. Never waits.
  std::size_t write(const std::uint8_t* data, std::size_t length);

  const std::string& port() const { return port_; }

 private:
  void make_link() const;
  void discard_unread() const;

  int master_ = -1;
  bool open_ = false;
  std::string link_;
  std::string port_;
};

}  // namespace acts
