// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Firmware of the readout board: a Teensy 4.1 that scans the array and streams frames over USB. docs/firmware.md says
// how it is wired, built and flashed. Everything that is not the Teensy's own is in the library.
#include <Arduino.h>

#include <acts_firmware.hpp>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>

// 0: binary packets, settings over the wire. 1: the text of the authors' published raster sketch.
#ifndef ACTS_RASTER_ASCII
#define ACTS_RASTER_ASCII 0
#endif

namespace {

// What the board starts with; a host can change all but the protocol.
constexpr acts::Protocol kProtocol = ACTS_RASTER_ASCII ? acts::Protocol::kRasterAscii : acts::Protocol::kBinary;
constexpr acts::Scheme kScheme = ACTS_RASTER_ASCII ? acts::Raster::kInfo.number : acts::Adaptive::kInfo.number;
constexpr int kRows = 32;
constexpr int kCols = 32;
constexpr int kM = 55;                          // taxels per frame
constexpr std::uint32_t kFramePeriodUs = 1000;  // frames begin no closer than this

// As on the published board: the Teensy's defaults. Set here all the same, so that another version of Teensyduino
// cannot change what is measured.
constexpr int kAdcBits = 10;
constexpr int kAdcAveraged = 4;
constexpr std::uint8_t kAdcPin = A0;

// A loop that takes longer than this ends in a reset; the watchdog knows nothing longer. Recovery of a full frame with
// the largest dictionary and patches at every taxel may, so it is fed meanwhile.
constexpr unsigned kWatchdogSeconds = 16;

void feed_watchdog() {
  WDOG1_WSR = 0x5555;
  WDOG1_WSR = 0xAAAA;
}

class TeensyBoard final : public acts::Board {
 public:
  void write_pin(std::uint8_t pin, bool high) override { digitalWriteFast(pin, high ? HIGH : LOW); }
  std::uint16_t read_adc() override { return static_cast<std::uint16_t>(analogRead(kAdcPin)); }
  std::uint32_t micros() override { return ::micros(); }
  void computing() override { feed_watchdog(); }

  // The number that the Teensy also gives as its USB serial number, by the same rule.
  std::uint64_t id() override {
    const std::uint32_t number = HW_OCOTP_MAC0 & 0xFFFFFFU;
    return number < 10000000U ? number * 10U : number;
  }
};

TeensyBoard board;
acts::FramePacer pacer;
bool host_reads = false;

// What every measurement touches is in the fast RAM1, made by setup() when the pins are outputs. A model is in RAM2,
// which start-up does not clear: nothing reads it before it was uploaded.
alignas(acts::Firmware) std::uint8_t firmware_memory[sizeof(acts::Firmware)];
DMAMEM acts::ModelMemory model_memory;
acts::Firmware* firmware = nullptr;

void start_watchdog() {
  CCM_CCGR3 |= CCM_CCGR3_WDOG1(CCM_CCGR_ON);
  WDOG1_WMCR = 0;  // the other timer in it, which would pull a pin 16 s after power-up
  // Not while a debugger or the boot loader has stopped the processor; the two reset bits stay as they are, inactive.
  WDOG1_WCR = WDOG_WCR_WT(2 * kWatchdogSeconds - 1) | WDOG_WCR_WDA | WDOG_WCR_SRS | WDOG_WCR_WDBG | WDOG_WCR_WDE;
}

[[noreturn]] void flicker(std::uint8_t pin) {
  constexpr std::uint32_t kHalfPeriodUs = 100000;
  for (;;) {
    board.write_pin(pin, micros() / kHalfPeriodUs % 2 == 0);
  }
}

void hear_host() {
  constexpr int kMaxReads = 8;  // a host that floods the board must not keep it from measuring
  std::array<char, 512> bytes;
  for (int i = 0; i < kMaxReads; ++i) {
    const int waiting = Serial.available();
    if (waiting <= 0) {
      return;
    }
    const std::size_t length =
        Serial.readBytes(bytes.data(), std::min(bytes.size(), static_cast<std::size_t>(waiting)));
    firmware->receive(reinterpret_cast<const std::uint8_t*>(bytes.data()), length);
  }
}

// A host that opens or closes the port says so by the line DTR.
void serve_host() {
  const bool open = Serial;
  if (open && !host_reads) {
    firmware->start_stream();
  }
  if (open || host_reads) {
    hear_host();  // what a host says before it leaves counts as well
  }
  if (!open && host_reads) {
    firmware->stop_stream();
  }
  host_reads = open;
}

// As much as USB takes at once; a host that does not read must not hold the sampling up.
void send() {
  acts::TransmitQueue& output = firmware->output();
  bool sent = false;
  while (output.size() > 0) {
    const int room = Serial.availableForWrite();
    if (room <= 0) {
      break;
    }
    const acts::TransmitQueue::Piece piece = output.front();
    const std::size_t taken = Serial.write(piece.data, std::min(piece.length, static_cast<std::size_t>(room)));
    if (taken == 0) {
      break;
    }
    output.pop(taken);
    sent = true;
  }
  if (sent) {
    Serial.send_now();  // do not wait for a full USB packet
  }
}

void measure() {
  const std::uint32_t period_us = firmware->settings().frame_period_us;
  const std::uint32_t now_us = micros();
  if (!pacer.due(now_us, period_us)) {
    return;
  }
  const std::uint32_t skipped = pacer.begin(now_us, period_us);
  if (skipped > 0) {
    firmware->skip_frames(skipped);
  }
  firmware->measure_frame();
  send();  // samples do not wait for what takes its time
  firmware->recover_frame();
  pacer.end(micros());
}

}  // namespace

void setup() {
  const acts::Wiring wiring = acts::published_wiring();
  for (int line = 0; line < wiring.lines; ++line) {
    pinMode(wiring.row_pins[static_cast<std::size_t>(line)], OUTPUT);
  }
  for (int bit = 0; bit < wiring.address_bits; ++bit) {
    pinMode(wiring.address_pins[static_cast<std::size_t>(bit)], OUTPUT);
  }
  pinMode(wiring.led_pin, OUTPUT);
  analogReadResolution(kAdcBits);
  analogReadAveraging(kAdcAveraged);

  firmware = new (firmware_memory) acts::Firmware(board, wiring, kProtocol, model_memory);
  acts::Settings settings;
  settings.sampling.rows = kRows;
  settings.sampling.cols = kCols;
  settings.sampling.scheme = kScheme;
  settings.sampling.m = kM;
  settings.frame_period_us = kFramePeriodUs;
  if (firmware->configure(settings) != acts::SettingField::kNone) {
    flicker(wiring.led_pin);  // the constants above do not go together
  }
  start_watchdog();
}

void loop() {
  serve_host();
  measure();
  send();
  feed_watchdog();
}
