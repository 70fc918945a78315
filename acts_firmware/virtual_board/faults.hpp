// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Faults that the virtual board plays on purpose: which there are, how they are written, when they are due.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace acts {

enum class FaultKind : std::uint8_t {
  kUnplug,
  kReset,
  kStall,
  kFreeze,
  kJump,
  kGarbage,
  kFlip,
  kFlipRate,
  kDrop,
  kDouble,
  kTruncate,
  kLose,
  kVersion,
};

struct Fault {
  FaultKind kind;
  double value;         // seconds, bytes, bits, frames: as the kind has it
  std::int64_t due_ns;  // since the process started
  std::string text;     // as it was written, without the time

  std::int64_t value_ns() const { return static_cast<std::int64_t>(value * 1e9); }
};

// What was given, what is allowed.
class FaultError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// `KIND`, `KIND:VALUE`, `KIND:VALUE@SECONDS`; without a time it is due at once.
Fault parse_fault(const std::string& text);

// A line for each kind: name, unit, what happens.
std::string fault_help();

// Faults in the order in which they fall due.
class FaultPlan {
 public:
  void add(const Fault& fault);

  // The next one that is due, taken out of the plan.
  std::optional<Fault> take(std::int64_t since_start_ns);

 private:
  std::vector<Fault> faults_;  // the next one last
};

}  // namespace acts
