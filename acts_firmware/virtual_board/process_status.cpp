// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a process prints for programs that started it: JSON, a line each.
#include <unistd.h>

#include <iostream>
#include <sstream>
#include <string>

#include "process.hpp"

namespace acts {

namespace {

std::string json_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
    }
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

// Says that a fault has begun or is over, and returns the time it gives, from which the fault's own time counts.
std::int64_t Process::report(const Fault& fault, bool is_over) const {
  const std::int64_t monotonic_ns = now_ns(CLOCK_MONOTONIC);
  if (!options_.print_status) {
    return monotonic_ns;
  }
  std::cout << "{\"fault\": " << json_text(fault.text) << ", \"over\": " << (is_over ? "true" : "false")
            << ", \"monotonic_ns\": " << monotonic_ns << ", \"epoch_monotonic_ns\": " << time_.to_host_ns(0)
            << ", \"port\": " << json_text(terminal_.port()) << "}" << std::endl;
  return monotonic_ns;
}

void Process::print_start() const {
  if (!options_.print_status) {
    return;
  }
  const SamplingConfig& sampling = options_.sampling;
  std::ostringstream line;
  line << "{\"link\": " << json_text(options_.link) << ", \"port\": " << json_text(terminal_.port())
       << ", \"pid\": " << getpid() << ", \"epoch_realtime_ns\": " << epoch_.realtime_ns
       << ", \"epoch_monotonic_ns\": " << epoch_.monotonic_ns << ", \"drift_ppm\": " << options_.drift_ppm
       << ", \"rows\": " << sampling.rows << ", \"cols\": " << sampling.cols << ", \"scheme\": \""
       << name_of(sampling.scheme) << "\", \"m\": " << sampling.m
       << ", \"frame_period_us\": " << static_cast<double>(step_ns_) / 1000.0 << "}";
  std::cout << line.str() << std::endl;
}

void Process::print_status_if_due(std::int64_t monotonic_ns) {
  const auto period_ns = static_cast<std::int64_t>(options_.status_period_s * 1e9);
  if (period_ns == 0) {
    return;
  }
  // Those that are missed, as by a process that was stopped, are not made up for.
  const std::int64_t due = (monotonic_ns - epoch_.monotonic_ns) / period_ns;
  if (due == last_status_) {
    return;
  }
  last_status_ = due;
  std::cout << "{\"frames\": " << frames_ << ", \"overruns\": " << firmware_->overruns()
            << ", \"connected\": " << (terminal_.open() ? "true" : "false") << "}" << std::endl;
}

}  // namespace acts
