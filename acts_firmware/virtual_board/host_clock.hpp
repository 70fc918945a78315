// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The host's clocks and sleep.
#pragma once

#include <cstdint>
#include <ctime>

namespace acts {

std::int64_t now_ns(clockid_t clock);

// Until a time of CLOCK_MONOTONIC; a signal ends it early.
void sleep_until(std::int64_t monotonic_ns);

// One moment on two clocks.
struct Epoch {
  std::int64_t monotonic_ns;
  std::int64_t realtime_ns;
};

Epoch read_epoch();

}  // namespace acts
