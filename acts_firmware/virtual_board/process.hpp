// A process around the firmware: pseudo-terminal, pace, status. docs/virtual_board.md describes it.
#pragma once

#include <csignal>
#include <cstdint>

#include "acts_firmware/firmware.hpp"
#include "host_clock.hpp"
#include "options.hpp"
#include "pseudo_terminal.hpp"
#include "virtual_board.hpp"

namespace acts {

// Frame after frame at its own virtual time; the process wakes once a frame, at its end. Large: on the heap.
class Process {
 public:
  // Runs until `stop_requested` is other than 0, as a signal handler sets it.
  Process(const Options& options, const volatile std::sig_atomic_t& stop_requested);

  void run();

 private:
  // Takes the times of a frame from the settings in force.
  void set_pace();
  // False when the process is to end.
  bool wait_for(std::int64_t board_ns);
  void serve_terminal();
  void send();
  std::int64_t status_period_ns() const;
  void print_start() const;
  void print_status() const;

  const Options options_;
  const volatile std::sig_atomic_t& stop_requested_;
  const Epoch epoch_;
  const BoardTime time_;
  VirtualBoard board_;
  Firmware firmware_;
  PseudoTerminal terminal_;
  std::int64_t sample_ns_ = 0;
  std::int64_t duration_ns_ = 0;
  std::int64_t step_ns_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace acts
