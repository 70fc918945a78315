// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Real-time scheduling of this process, as docs/real_time.md describes it for all of ACTS.
#pragma once

#include <string>
#include <vector>

namespace acts {

struct Realtime {
  int priority = 0;        // under SCHED_FIFO; 0: the ordinary scheduler
  std::vector<int> cores;  // to run on; empty: any
};

// Reads cores as in 0,2-3; throws std::invalid_argument where one is not among those of this process.
std::vector<int> parse_cores(const std::string& text);

// Schedules the calling thread so, which has to be the only one, and returns in a sentence what came of it, empty where
// nothing is asked for. Never fails for a missing right. Under the ordinary scheduler it has the shortest time slices.
//
// Once the thread has computed for a second without a single sleep, the ordinary scheduler takes it back, and standard
// error tells it.
std::string enter_realtime(const Realtime& wanted);

}  // namespace acts
