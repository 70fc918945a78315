// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "host_clock.hpp"

namespace acts {

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;

}  // namespace

std::int64_t now_ns(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * kNsPerS + time.tv_nsec;
}

void sleep_until(std::int64_t monotonic_ns) {
  timespec time{};
  time.tv_sec = monotonic_ns / kNsPerS;
  time.tv_nsec = monotonic_ns % kNsPerS;
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

Epoch read_epoch() {
  const std::int64_t before = now_ns(CLOCK_MONOTONIC);
  const std::int64_t realtime = now_ns(CLOCK_REALTIME);
  const std::int64_t after = now_ns(CLOCK_MONOTONIC);
  return {before + (after - before) / 2, realtime};
}

}  // namespace acts
