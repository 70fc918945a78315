// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "instruction_counter.hpp"

namespace acts {

namespace {

// The first CMSDK APB timer of QEMU's mps2-an500. It counts down at 25 MHz, a tick in 40 ns.
constexpr std::uintptr_t kControl = 0x40000000;
constexpr std::uintptr_t kValue = 0x40000004;
constexpr std::uintptr_t kReload = 0x40000008;
constexpr std::uint32_t kEnable = 1;
constexpr std::uint32_t kFull = 0xFFFFFFFF;

constexpr std::uint64_t kTickNs = 40;
constexpr std::uint64_t kInstructionNs = 128;

volatile std::uint32_t& timer(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace

void restart_timer() {
  timer(kControl) = 0;
  timer(kReload) = kFull;
  timer(kValue) = kFull;
  timer(kControl) = kEnable;
}

std::uint32_t timer_ticks() {
  return kFull - timer(kValue);
}

std::uint32_t instructions_between(std::uint32_t earlier_ticks, std::uint32_t later_ticks) {
  const std::uint64_t ns = (later_ticks - earlier_ticks) * kTickNs;
  return static_cast<std::uint32_t>((ns + kInstructionNs / 2) / kInstructionNs);
}

__attribute__((noinline)) void loop_of_two(std::uint32_t turns) {
  __asm__ volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(turns) : : "cc");
}

}  // namespace acts
