// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Loaded into the virtual board by LD_PRELOAD: `poll` returns 3 ms after it has looked, as where the board is put off
// the processor at that moment.

#include <dlfcn.h>
#include <poll.h>
#include <time.h>

extern "C" int poll(pollfd* descriptors, nfds_t count, int timeout_ms) {
  using Poll = int (*)(pollfd*, nfds_t, int);
  static const auto real = reinterpret_cast<Poll>(dlsym(RTLD_NEXT, "poll"));
  const int found = real(descriptors, count, timeout_ms);
  const timespec delay{0, 3'000'000};
  nanosleep(&delay, nullptr);
  return found;
}
