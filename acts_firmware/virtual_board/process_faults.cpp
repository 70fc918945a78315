// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The faults of a process: when they begin, what they do, when they are over.
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "process.hpp"

namespace acts {

void Process::take_faults(std::int64_t monotonic_ns) {
  end_faults(monotonic_ns);
  for (const std::string& line : control_ ? control_->read_lines() : std::vector<std::string>()) {
    try {
      plan_.add(parse_fault(line));
    } catch (const FaultError& error) {
      std::cerr << "virtual_board: --control: " << error.what() << std::endl;
    }
  }
  while (const std::optional<Fault> fault = plan_.take(monotonic_ns - epoch_.monotonic_ns)) {
    begin(*fault);
  }
  // A stream that nobody reads has no packet to be cut in.
  while (!terminal_.open()) {
    const std::optional<Fault> cut = link_.take_cut();
    if (!cut) {
      break;
    }
    cut_stream(*cut, monotonic_ns);
  }
}

void Process::begin(const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::kFreeze:
      frozen_.push_back({fault, report(fault, false) + fault.value_ns()});
      break;
    case FaultKind::kJump:
      time_.jump(fault.value_ns());
      start_ns_ += fault.value_ns();
      last_start_ns_ += fault.value_ns();
      report(fault, false);
      report(fault, true);
      break;
    default:
      link_.arm(fault);
      break;
  }
}

void Process::cut_stream(const Fault& fault, std::int64_t monotonic_ns) {
  const bool loses_port = fault.kind == FaultKind::kUnplug || fault.value > 0.0;
  if (loses_port) {
    if (unplugged_.empty()) {
      terminal_.unplug();
    }
    serve_terminal();
  }
  link_.clear();
  if (fault.kind == FaultKind::kReset) {
    power_up(monotonic_ns);
    if (terminal_.open()) {
      firmware_->start_stream();
    }
  }
  const std::int64_t began_ns = report(fault, false);
  if (loses_port) {
    unplugged_.push_back({fault, began_ns + fault.value_ns()});
  } else {
    report(fault, true);
  }
}

void Process::end_faults(std::int64_t monotonic_ns) {
  const std::vector<Fault> plugged = take_ended(unplugged_, monotonic_ns);
  if (!plugged.empty() && unplugged_.empty()) {
    terminal_.plug_in();
  }
  const std::vector<Fault> thawed = take_ended(frozen_, monotonic_ns);
  if (!thawed.empty()) {
    let_time_pass(monotonic_ns);
  }
  for (const std::vector<Fault>& ended : {plugged, thawed}) {
    for (const Fault& fault : ended) {
      report(fault, true);
    }
  }
}

std::vector<Fault> Process::take_ended(std::vector<LastingFault>& faults, std::int64_t monotonic_ns) {
  std::vector<Fault> ended;
  std::vector<LastingFault> lasting;
  for (const LastingFault& one : faults) {
    if (monotonic_ns >= one.until_ns) {
      ended.push_back(one.fault);
    } else {
      lasting.push_back(one);
    }
  }
  faults = lasting;
  return ended;
}

}  // namespace acts
