// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Tests of what Python does not see of the core: wiring, clock, pace, queue, framing, the firmware as a whole. Runs on
// the host and on the Teensy's processor, so without streams.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "acts_firmware/board/clock.hpp"
#include "acts_firmware/board/pacer.hpp"
#include "acts_firmware/firmware.hpp"
#include "acts_firmware/recovery/image_recovery.hpp"
#include "core_checks.hpp"

namespace {

void test_pin_table() {
  const acts::Wiring wiring = acts::published_wiring();
  CHECK(wiring.lines == 32);
  CHECK(wiring.pin_of_row(31) == 0);  // the picture is flipped against the lines
  CHECK(wiring.pin_of_row(18) == 13);
  CHECK(wiring.pin_of_row(17) == 15);  // pin 14 is the ADC
  CHECK(wiring.pin_of_row(0) == 32);
  CHECK(wiring.address_bits == 5);
  CHECK(wiring.address_pins[0] == 33);
  CHECK(wiring.address_pins[4] == 37);
  CHECK(wiring.led_pin == 40);
  CHECK(acts::wiring_for(33, 8).lines == 64);
  CHECK(acts::wiring_for(8, 33).address_bits == 6);
}

void test_levels_while_measuring() {
  IndexBoard board(32, 32);
  const acts::Wiring wiring = acts::published_wiring();
  for (std::size_t line = 0; line < 32; ++line) {
    board.write_pin(wiring.row_pins[line], true);
  }
  board.write_pin(wiring.address_pins[4], true);
  CHECK(board.high_pins(0, 255) == 33);
  acts::Scanner scanner(board, wiring);
  CHECK(board.high_pins(0, 255) == 0);
  scanner.measure(30, 0x15);
  CHECK(board.level(1));  // row 30 on line 1
  CHECK(board.high_pins(0, 32) == 1);
  CHECK(board.level(33) && !board.level(34) && board.level(35) && !board.level(36) && board.level(37));
  scanner.measure(2, 0x0A);
  CHECK(board.level(30));
  CHECK(board.high_pins(0, 32) == 1);
  CHECK(!board.level(33) && board.level(34) && !board.level(35) && board.level(36) && !board.level(37));
}

void test_every_taxel_is_wired(int rows, int cols) {
  IndexBoard board(rows, cols);
  acts::Scanner scanner(board, acts::wiring_for(rows, cols));
  bool right = true;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      right = right && scanner.measure(row, col) == (row * cols + col) % (acts::kCountMax + 1);
    }
  }
  CHECK(right);
}

void test_clock_across_wraps() {
  acts::ExtendedClock clock;
  CHECK(clock.extend(0xFFFFFFF0U) == 0xFFFFFFF0ULL);
  CHECK(clock.extend(0x10U) == 0x100000010ULL);
  CHECK(clock.extend(0x10U) == 0x100000010ULL);
  CHECK(clock.extend(0xFFFFFFFFU) == 0x1FFFFFFFFULL);
  CHECK(clock.extend(0U) == 0x200000000ULL);
}

void test_frame_across_a_wrap() {
  IndexBoard board(32, 32, 0xFFFFFFFFU - 100U);
  auto firmware = make_firmware(board);
  const acts::SampleFrame& frame = firmware->measure_frame();
  CHECK(frame.duration_us == 550);
  CHECK(frame.board_us == 0xFFFFFFFFULL - 100 + 550);
}

// Frames of `busy_us` each from `start_us` on; when they began.
std::vector<std::uint32_t> begins(std::uint32_t start_us, std::uint32_t busy_us, std::uint32_t period_us, int count) {
  acts::FramePacer pacer;
  std::vector<std::uint32_t> times;
  for (std::uint32_t now_us = start_us; static_cast<int>(times.size()) < count; ++now_us) {
    if (pacer.due(now_us, period_us)) {
      CHECK(pacer.begin(now_us, period_us) == 0);
      times.push_back(now_us - start_us);
      now_us += busy_us;
      pacer.end(now_us);
    }
  }
  return times;
}

void test_pace() {
  using Times = std::vector<std::uint32_t>;
  CHECK(begins(7, 60, 100, 4) == (Times{0, 100, 200, 300}));
  CHECK(begins(0xFFFFFFF0U, 60, 100, 4) == (Times{0, 100, 200, 300}));  // micros() wraps
  CHECK(begins(7, 150, 100, 4) == (Times{0, 151, 302, 453}));           // end to end
  CHECK(begins(7, 60, 0, 3) == (Times{0, 61, 122}));                    // as fast as it goes
  CHECK(begins(7, 400000, 1000, 3) == (Times{0, 400001, 800002}));      // long frames are no stall
}

void test_pace_after_lateness() {
  acts::FramePacer pacer;
  CHECK(pacer.due(50, 1000));
  CHECK(pacer.begin(50, 1000) == 0);
  pacer.end(600);
  CHECK(!pacer.due(1049, 1000));
  CHECK(pacer.begin(1400, 1000) == 0);  // a little late
  pacer.end(2000);
  CHECK(!pacer.due(2049, 1000) && pacer.due(2050, 1000));  // the grid stays
  CHECK(pacer.due(2040, 500));                             // a new period counts at once
  CHECK(pacer.begin(2050, 1000) == 0);
  pacer.end(2600);
  CHECK(pacer.begin(302600, 1000) == 299);  // something held the board up
  pacer.end(303000);
  CHECK(!pacer.due(303599, 1000) && pacer.due(303600, 1000));
}

// What was skipped by a board that is held up for 300 ms after a frame of 400 us.
std::uint32_t skipped_of(std::uint32_t period_us) {
  acts::FramePacer pacer;
  CHECK(pacer.begin(50, period_us) == 0);
  pacer.end(450);
  return pacer.begin(300'450, period_us);
}

void test_frames_without_a_period_are_skipped_as_well() {
  CHECK(skipped_of(0) == 750);
  CHECK(skipped_of(100) == 750);
  CHECK(skipped_of(500) == 599);
}

void test_a_shorter_period_skips_nothing() {
  constexpr std::uint32_t kLongUs = 1'000'000;
  constexpr std::uint32_t kShortUs = 1000;
  acts::FramePacer pacer;
  CHECK(pacer.due(0, kLongUs));
  CHECK(pacer.begin(0, kLongUs) == 0);
  pacer.end(600);
  for (std::uint32_t now_us = 650; now_us < 700'000; now_us += 50) {
    CHECK(!pacer.due(now_us, kLongUs));
  }
  CHECK(pacer.due(700'000, kShortUs));
  CHECK(pacer.begin(700'000, kShortUs) == 0);
  pacer.end(700'600);
  CHECK(!pacer.due(700'999, kShortUs) && pacer.due(701'000, kShortUs));
}

void test_crc() {
  const std::string check = "123456789";
  CHECK(acts::crc32(reinterpret_cast<const std::uint8_t*>(check.data()), check.size()) == 0xCBF43926U);
  CHECK(acts::crc32(nullptr, 0) == 0);
}

void test_cobs() {
  CHECK(encoded({}) == Bytes{0x01});
  CHECK(encoded({0x00}) == (Bytes{0x01, 0x01}));
  CHECK(encoded({0x11, 0x22, 0x00, 0x33}) == (Bytes{0x03, 0x11, 0x22, 0x02, 0x33}));
  CHECK(encoded(run_of(254)).size() == 255);
  CHECK(encoded(run_of(255)).size() == 257);
  for (const std::size_t length : {1U, 253U, 254U, 255U, 508U, 509U, 4132U}) {
    for (const bool zero_at_end : {false, true}) {
      Bytes data = run_of(length);
      if (zero_at_end) {
        data.back() = 0;
      }
      const Bytes stuffed = encoded(data);
      Bytes back(stuffed.size());
      back.resize(acts::cobs_decode(stuffed.data(), stuffed.size(), back.data()));
      CHECK(back == data);
      CHECK(std::memchr(stuffed.data(), 0, stuffed.size()) == nullptr);
    }
  }
  Bytes room(8);
  CHECK(acts::cobs_decode(Bytes{0x05, 0x11}.data(), 2, room.data()) == 0);
  CHECK(acts::cobs_decode(Bytes{0x00}.data(), 1, room.data()) == 0);
}

void test_packet_layout() {
  auto frame = std::make_unique<acts::SampleFrame>();
  frame->sequence = 0x01020304;
  frame->board_us = 0x1122334455667788ULL;
  frame->duration_us = 0x0A0B0C0D;
  frame->overruns = 7;
  frame->scheme = acts::RandomTaxels::kInfo.number;
  frame->rows = 15;
  frame->cols = 33;
  frame->append(0x0102, 0x0304);
  frame->append(0x0506, 0x03FF);
  Bytes packet(acts::kMaxPacketBytes);
  packet.resize(acts::encode_samples(*frame, packet.data()));
  CHECK(packet.size() == 44);
  CHECK(packet[0] == 1 && packet[1] == 1);
  CHECK(little_endian(packet, 2, 2) == 44);
  CHECK(little_endian(packet, 4, 4) == 0x01020304);
  CHECK(little_endian(packet, 8, 8) == 0x1122334455667788ULL);
  CHECK(little_endian(packet, 16, 4) == 0x0A0B0C0D);
  CHECK(little_endian(packet, 20, 4) == 7);
  CHECK(packet[24] == 2 && packet[25] == 15 && packet[26] == 33 && packet[27] == 0);
  CHECK(little_endian(packet, 28, 2) == 2);
  CHECK(little_endian(packet, 30, 2) == 0);
  CHECK(little_endian(packet, 32, 2) == 0x0102 && little_endian(packet, 34, 2) == 0x0506);
  CHECK(little_endian(packet, 36, 2) == 0x0304 && little_endian(packet, 38, 2) == 0x03FF);
  CHECK(little_endian(packet, 40, 4) == acts::crc32(packet.data(), 40));
}

void test_queue_keeps_messages_whole() {
  auto queue = std::make_unique<acts::TransmitQueue>();
  const Bytes message = run_of(50000);
  CHECK(queue->push(message.data(), message.size()));
  CHECK(queue->push(message.data(), message.size()));
  CHECK(!queue->push(message.data(), message.size()));
  CHECK(queue->size() == 100000);
  queue->pop(70000);
  CHECK(queue->push(message.data(), message.size()));  // goes round the end
  Bytes out;
  while (queue->size() > 0) {
    const acts::TransmitQueue::Piece piece = queue->front();
    out.insert(out.end(), piece.data, piece.data + piece.length);
    queue->pop(piece.length);
  }
  Bytes expected(message.begin() + 20000, message.end());
  expected.insert(expected.end(), message.begin(), message.end());
  CHECK(out == expected);
}

void test_overruns_are_counted_and_numbered() {
  IndexBoard board(32, 32);
  auto firmware = make_firmware(board);
  acts::Settings settings;
  settings.sampling.scheme = acts::Raster::kInfo.number;
  CHECK(firmware->configure(settings) == acts::SettingField::kNone);
  firmware->measure_frame();
  CHECK(firmware->output().size() == 0);  // nobody reads: discarded, no overrun
  firmware->start_stream();
  CHECK(firmware->output().size() == 1);  // the delimiter a stream starts with
  for (int i = 0; i < 40; ++i) {
    firmware->measure_frame();
  }
  const std::uint32_t overruns = firmware->overruns();
  CHECK(overruns == 40 - (acts::TransmitQueue::kCapacity - 1) / 4150);
  firmware->skip_frames(5);
  const acts::SampleFrame& frame = firmware->measure_frame();
  CHECK(frame.sequence == 46);
  CHECK(frame.overruns == overruns + 5);
  firmware->stop_stream();
  CHECK(firmware->output().size() == 0);
}

void test_settings_are_checked() {
  auto sampler = std::make_unique<acts::Sampler>();
  acts::SamplingConfig config;
  config.rows = 65;
  CHECK(sampler->configure(config) == acts::SettingField::kRows);
  config = {};
  config.m = 1025;
  CHECK(sampler->configure(config) == acts::SettingField::kM);
  config = {};
  config.threshold = 1024;
  CHECK(sampler->configure(config) == acts::SettingField::kThreshold);
  config = {};
  config.scheme = acts::Uniform::kInfo.number;
  config.m = 53;
  CHECK(sampler->configure(config) == acts::SettingField::kM);
  config = {};
  for (const int unknown : {0, 99, 255}) {
    config.scheme = static_cast<acts::Scheme>(unknown);
    CHECK(sampler->configure(config) == acts::SettingField::kScheme);
  }
  config = {};
  config.scheme = acts::Tracking::kInfo.number;
  for (const int quota : {0, 56}) {
    config.set_own(acts::Tracking::kSearchQuota, quota);
    CHECK(sampler->configure(config) == acts::SettingField{acts::Tracking::kSearchQuota.number});
  }
  config = {};
  config.scheme = acts::Hybrid::kInfo.number;
  for (const int quota : {0, 56}) {
    config.set_own(acts::Hybrid::kAdaptiveQuota, quota);
    CHECK(sampler->configure(config) == acts::SettingField{acts::Hybrid::kAdaptiveQuota.number});
  }
  CHECK(sampler->config().rows == 32 && sampler->frame_size() == 55);  // refused settings change nothing
}

class PressedReader final : public acts::TaxelReader {
 public:
  std::uint16_t measure(int /*row*/, int /*col*/) override { return acts::kCountMax; }
};

void test_new_settings_forget_what_was_pressed() {
  auto sampler = std::make_unique<acts::Sampler>();
  auto frame = std::make_unique<acts::SampleFrame>();
  PressedReader reader;
  acts::SamplingConfig config;
  config.scheme = acts::Tracking::kInfo.number;
  CHECK(sampler->configure(config) == acts::SettingField::kNone);
  sampler->sample(reader, *frame);
  const auto first = frame->indices;
  sampler->sample(reader, *frame);
  CHECK(frame->indices != first);
  CHECK(sampler->configure(config) == acts::SettingField::kNone);
  sampler->sample(reader, *frame);
  CHECK(frame->indices == first);
}

class CountingBoard final : public IndexBoard {
 public:
  CountingBoard() : IndexBoard(32, 32) {}
  void computing() override { ++calls; }
  int calls = 0;
};

void test_the_board_is_told_while_an_image_is_recovered() {
  constexpr int kAtoms = 8;
  constexpr int kSide = 8;
  const std::vector<float> values(kAtoms * kSide * kSide, 0.125F);
  auto recovery = std::make_unique<acts::ImageRecovery>();
  auto work = std::make_unique<acts::ImageRecovery::Workspace>();
  auto frame = std::make_unique<acts::SampleFrame>();
  frame->rows = frame->cols = 32;
  frame->m = 1;
  frame->indices[0] = 400;
  frame->counts[0] = 900;
  CountingBoard board;
  CHECK(recovery->prepare({values.data(), kAtoms, kSide, 1}, 32, 32));
  CHECK(recovery->recover(*frame, 180, *work, &board)[400] == 900.0F);
  CHECK(board.calls == 32 - kSide + 1);  // rows of patches
}

void test_published_ascii() {
  IndexBoard board(2, 3);
  auto firmware = make_firmware(board, acts::Protocol::kRasterAscii);
  acts::Settings settings;
  settings.sampling.rows = 2;
  settings.sampling.cols = 3;
  settings.sampling.m = 6;
  settings.sampling.scheme = acts::Raster::kInfo.number;
  CHECK(firmware->configure(settings) == acts::SettingField::kNone);
  firmware->start_stream();
  firmware->measure_frame();
  const acts::TransmitQueue::Piece piece = firmware->output().front();
  CHECK(std::string(reinterpret_cast<const char*>(piece.data), piece.length) == "0,1,2,3,4,5,60\r\n");
}

}  // namespace

int main() {
  test_pin_table();
  test_levels_while_measuring();
  test_every_taxel_is_wired(32, 32);
  test_every_taxel_is_wired(15, 7);
  test_every_taxel_is_wired(64, 64);
  test_every_taxel_is_wired(16, 64);
  test_clock_across_wraps();
  test_frame_across_a_wrap();
  test_pace();
  test_pace_after_lateness();
  test_frames_without_a_period_are_skipped_as_well();
  test_a_shorter_period_skips_nothing();
  test_crc();
  test_cobs();
  test_packet_layout();
  test_queue_keeps_messages_whole();
  test_overruns_are_counted_and_numbered();
  test_settings_are_checked();
  test_new_settings_forget_what_was_pressed();
  test_the_board_is_told_while_an_image_is_recovered();
  test_published_ascii();
  test_commands();
  if (failures > 0) {
    std::fprintf(stderr, "%d checks failed\n", failures);
    return 1;
  }
  std::puts("all checks passed");
  return 0;
}
