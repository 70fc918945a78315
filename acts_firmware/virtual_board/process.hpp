// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// A process around the firmware: pseudo-terminal, pace, status. docs/virtual_board.md describes it.
#pragma once

#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "acts_firmware/firmware.hpp"
#include "board/virtual_board.hpp"
#include "control_pipe.hpp"
#include "faults.hpp"
#include "field/field.hpp"
#include "host_clock.hpp"
#include "link/claim.hpp"
#include "link/faulty_link.hpp"
#include "link/pseudo_terminal.hpp"
#include "options.hpp"

namespace acts {

// Frame after frame at its own virtual time; the process wakes once a frame, at its end. Large: on the heap.
class Process {
 public:
  // Runs until `stop_requested` is other than 0, as a signal handler sets it.
  Process(const Options& options, const volatile std::sig_atomic_t& stop_requested);

  void run();

 private:
  struct LastingFault {
    Fault fault;
    std::int64_t until_ns;
  };

  // The board's power comes on: its clock and its sequence start, its settings are those of the command line.
  void power_up(std::int64_t monotonic_ns);

  // Takes the times of a frame from the settings in force.
  void set_pace();

  // Whether the process is to end now.
  bool ended();
  // Until the frame that begins at start_ns_ is over; false when the process is to end.
  bool wait_for_frame();
  // The board's time goes on to now without a frame, and the next frame begins then.
  void let_time_pass(std::int64_t monotonic_ns);
  // Begins or ends the stream of a host that comes or goes. True where it has changed the times of the next frame.
  bool notice_host();
  // Hears what the host says as well. True as above.
  bool serve_terminal();
  bool hear_host();
  void send();
  // What the board makes of the frame measured last, when it has had the time for that.
  void recover_frame();

  void take_faults(std::int64_t monotonic_ns);
  void begin(const Fault& fault);
  void cut_stream(const Fault& fault, std::int64_t monotonic_ns);
  void end_faults(std::int64_t monotonic_ns);
  // Those of `faults` that are over, taken out of it.
  static std::vector<Fault> take_ended(std::vector<LastingFault>& faults, std::int64_t monotonic_ns);
  std::int64_t report(const Fault& fault, bool is_over) const;

  void print_start() const;
  void print_status_if_due(std::int64_t monotonic_ns);

  const Options options_;
  const volatile std::sig_atomic_t& stop_requested_;
  std::optional<std::int64_t> ends_at_ns_;  // after a signal that others may have got as well
  const Epoch epoch_;
  BoardTime time_;
  std::unique_ptr<Field> field_;
  std::unique_ptr<VirtualBoard> board_;
  ModelMemory models_{};
  std::unique_ptr<Firmware> firmware_;
  const std::unique_ptr<Claim> claim_;  // to the link; before the terminal that makes it
  PseudoTerminal terminal_;
  FaultyLink link_;
  std::unique_ptr<ControlPipe> control_;
  FaultPlan plan_;
  // Under way; of those that overlap, each ends at its own time.
  std::vector<LastingFault> unplugged_;
  std::vector<LastingFault> frozen_;
  bool stands_still_ = false;       // the field does
  std::int64_t start_ns_ = 0;       // of the next frame, on the board's clock
  std::int64_t last_start_ns_ = 0;  // of the last frame
  std::int64_t sample_ns_ = 0;
  std::int64_t duration_ns_ = 0;
  std::int64_t computing_ns_ = 0;  // after a frame, on what is sent besides its samples
  std::int64_t step_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::int64_t last_status_ = 0;  // which multiple of the period it was due at
};

}  // namespace acts
