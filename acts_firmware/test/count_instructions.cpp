// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// How many instructions the Teensy's processor executes for an image or an object, under QEMU alone
// (scripts/firmware_instructions.py). The only argument names a file of records: a letter, a length (u32) and so many
// bytes,
//
//   s  what a host sends: a model, settings
//   p  counts of every taxel (u16): a frame is measured of them, then recovered or classified
//
// with little-endian numbers. Prints JSON, a line each: first loops of known length, then the frames.
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "../teensy/arduino/Arduino.h"
#include "../teensy/qemu/instruction_counter.hpp"
#include "acts_firmware.hpp"
#include "board/published_recovery.hpp"
#include "board/published_timing.hpp"
#include "board/wired_board.hpp"

namespace {

constexpr int kSide = 32;

// Reads the timer where the firmware asks for the time, before it computes, and where it says that it has computed.
class CountingBoard final : public acts::WiredBoard {
 public:
  CountingBoard() : WiredBoard(kSide, kSide) {}

  std::array<std::uint16_t, kSide * kSide> field{};

  std::uint16_t read_adc() override { return static_cast<std::uint16_t>(adc_input()); }
  std::uint32_t micros() override {
    if (!has_computed_) {
      began_ticks_ = acts::timer_ticks();
    }
    return 0;
  }
  void computed() override {
    ended_ticks_ = acts::timer_ticks();
    has_computed_ = true;
  }

  void forget() { has_computed_ = false; }
  bool has_computed() const { return has_computed_; }
  std::uint32_t computing() const { return acts::instructions_between(began_ticks_, ended_ticks_); }

 protected:
  double taxel_counts(int row, int col) override { return field[static_cast<std::size_t>(row * kSide + col)]; }

 private:
  bool has_computed_ = false;
  std::uint32_t began_ticks_ = 0;
  std::uint32_t ended_ticks_ = 0;
};

CountingBoard board;
DMAMEM acts::ModelMemory model_memory;  // where the sketch has it
acts::Firmware firmware(board, acts::published_wiring(), acts::Protocol::kBinary, model_memory);

void try_counter() {
  for (const std::uint32_t turns : {1U, 2U, 3U, 1000U, 1001U, 10'000'000U}) {
    acts::restart_timer();
    const std::uint32_t before = acts::timer_ticks();
    acts::loop_of_two(turns);
    const std::uint32_t after = acts::timer_ticks();
    std::printf("{\"turns\": %" PRIu32 ", \"instructions\": %" PRIu32 "}\n", turns,
                acts::instructions_between(before, after));
  }
}

void empty_queue() {
  while (firmware.output().size() > 0) {
    firmware.output().pop(firmware.output().front().length);
  }
}

// False where the firmware has nothing to compute with.
bool count_frame() {
  const acts::SampleFrame& frame = firmware.measure_frame();
  empty_queue();
  board.forget();
  acts::restart_timer();
  const std::uint32_t before = acts::timer_ticks();
  firmware.recover_frame();
  const std::uint32_t after = acts::timer_ticks();
  empty_queue();
  const acts::Settings& settings = firmware.settings();
  const acts::Model& model = firmware.models().model();
  const bool image = firmware.active_output() == acts::Output::kImage;
  std::printf("{\"output\": \"%s\", \"columns\": %d, \"m\": %d, \"computing\": %" PRIu32 ", \"with_packet\": %" PRIu32
              ", \"published_us\": %.1f, \"sampling_us\": %.1f}\n",
              image ? "image" : "object", model.columns, frame.m, board.computing(),
              acts::instructions_between(before, after),
              acts::published_recovery_us(settings.output, model, settings.sampling, frame.m),
              frame.m * acts::published_sample_us(settings.sampling));
  return board.has_computed();
}

constexpr char kNone = 0;
constexpr char kBroken = '?';

// False at the end of the file, with kNone, and at a record that is cut off or too long, with kBroken.
bool read_record(std::FILE* file, char& kind, std::uint32_t& length, std::uint8_t* bytes, std::size_t room) {
  std::array<std::uint8_t, 5> head{};
  const std::size_t got = std::fread(head.data(), 1, head.size(), file);
  kind = got == 0 ? kNone : kBroken;
  if (got != head.size()) {
    return false;
  }
  length = acts::Reader(head.data() + 1).u32();
  if (length > room || std::fread(bytes, 1, length, file) != length) {
    return false;
  }
  kind = static_cast<char>(head[0]);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::FILE* file = argc == 2 ? std::fopen(argv[1], "rb") : nullptr;
  if (file == nullptr) {
    std::fputs("count_instructions: no file of records, or none that can be read\n", stderr);
    return 2;
  }
  try_counter();
  firmware.start_stream();
  static std::array<std::uint8_t, 2 * kSide * kSide> bytes;
  char kind = kNone;
  std::uint32_t length = 0;
  while (read_record(file, kind, length, bytes.data(), bytes.size())) {
    if (kind == 's') {
      firmware.receive(bytes.data(), length);
      empty_queue();
      continue;
    }
    acts::Reader counts(bytes.data());
    for (std::uint16_t& taxel : board.field) {
      taxel = counts.u16();
    }
    if (!count_frame()) {
      std::fputs("count_instructions: the firmware neither recovers nor classifies\n", stderr);
      return 1;
    }
  }
  if (kind == kBroken) {
    std::fputs("count_instructions: a record is cut off or too long\n", stderr);
    return 1;
  }
  return 0;
}
