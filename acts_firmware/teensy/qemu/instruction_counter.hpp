// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Counts instructions under QEMU, which does not model cycles. With `-icount shift=7`
// (scripts/firmware_instructions.py) QEMU's clock advances by 2^7 ns with every instruction, whatever it is, and the
// machine's timers follow that clock.
#pragma once

#include <cstdint>

namespace acts {

// Sets the timer back; it runs for 1.3e9 instructions from here.
void restart_timer();

std::uint32_t timer_ticks();

// Exact, because an instruction takes 3.2 ticks. Of two readings one after the other it is what a reading takes.
std::uint32_t instructions_between(std::uint32_t earlier_ticks, std::uint32_t later_ticks);

// A loop of two instructions a turn, at least one turn: what the counter is tried with.
void loop_of_two(std::uint32_t turns);

}  // namespace acts
