// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the sketch uses of the Teensy 4.1's core, declared once more: enough to compile it without Teensyduino, to tell
// its size and to run it on a model of the board. Nothing here goes onto a board; the Arduino builder takes the real
// headers.
#pragma once

#include <cstddef>
#include <cstdint>

// The second RAM bank.
#ifdef __arm__
#define DMAMEM __attribute__((section(".dmabuffers")))
#else
#define DMAMEM
#endif

constexpr std::uint8_t LOW = 0;
constexpr std::uint8_t HIGH = 1;
constexpr std::uint8_t OUTPUT = 1;
constexpr std::uint8_t A0 = 14;

void pinMode(std::uint8_t pin, std::uint8_t mode);
void digitalWriteFast(std::uint8_t pin, std::uint8_t level);
int analogRead(std::uint8_t pin);
void analogReadResolution(unsigned bits);
void analogReadAveraging(unsigned count);
std::uint32_t micros();

// The USB serial port.
class UsbSerial {
 public:
  operator bool();  // a host has it open; implicit, as in the real one
  int available();
  std::size_t readBytes(char* out, std::size_t length);
  int availableForWrite();
  std::size_t write(const std::uint8_t* data, std::size_t length);
  void send_now();
};
extern UsbSerial Serial;

// Registers of the i.MX RT1062: clock gates, watchdog, the fuses with the serial number.
extern volatile std::uint32_t CCM_CCGR3;
extern volatile std::uint16_t WDOG1_WCR;
extern volatile std::uint16_t WDOG1_WSR;
extern volatile std::uint16_t WDOG1_WMCR;
extern volatile std::uint32_t HW_OCOTP_MAC0;

constexpr std::uint32_t CCM_CCGR_ON = 3;
constexpr std::uint32_t CCM_CCGR3_WDOG1(std::uint32_t setting) {
  return (setting & 3U) << 16U;
}
constexpr std::uint16_t WDOG_WCR_WDBG = 1U << 1U;
constexpr std::uint16_t WDOG_WCR_WDE = 1U << 2U;
constexpr std::uint16_t WDOG_WCR_SRS = 1U << 4U;
constexpr std::uint16_t WDOG_WCR_WDA = 1U << 5U;
constexpr std::uint16_t WDOG_WCR_WT(unsigned half_seconds) {
  return static_cast<std::uint16_t>((half_seconds & 0xFFU) << 8U);
}

extern "C" {
void setup();
void loop();
}
