// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/wire/packet.hpp"

#include <array>

namespace acts {

namespace {

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & 1U) != 0 ? value >> 1U ^ 0xEDB88320U : value >> 1U;
    }
    table[byte] = value;
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

}  // namespace

std::uint32_t crc32(const std::uint8_t* data, std::size_t length, std::uint32_t before) {
  std::uint32_t crc = ~before;
  for (std::size_t i = 0; i < length; ++i) {
    crc = crc >> 8U ^ kCrcTable[(crc ^ data[i]) & 0xFFU];
  }
  return ~crc;
}

void begin_packet(Writer& writer, PacketType type) {
  writer.u8(static_cast<std::uint8_t>(type));
  writer.u8(kPacketVersion);
  writer.u16(0);
}

std::size_t end_packet(Writer& writer, std::uint8_t* out) {
  constexpr std::size_t kLengthAt = 2;
  Writer(out + kLengthAt).u16(static_cast<std::uint16_t>(writer.length() + kPacketCrcBytes));
  writer.u32(crc32(out, writer.length()));
  return writer.length();
}

std::size_t cobs_encode(const std::uint8_t* data, std::size_t length, std::uint8_t* out) {
  constexpr std::uint8_t kFullBlock = 0xFF;  // 254 bytes without a zero after them
  std::size_t code_at = 0;
  std::size_t written = 1;
  std::uint8_t code = 1;
  for (std::size_t i = 0; i < length; ++i) {
    if (data[i] != 0) {
      out[written++] = data[i];
      ++code;
    }
    // A full block at the very end needs no successor.
    if (data[i] == 0 || (code == kFullBlock && i + 1 < length)) {
      out[code_at] = code;
      code_at = written++;
      code = 1;
    }
  }
  out[code_at] = code;
  return written;
}

std::size_t cobs_decode(const std::uint8_t* data, std::size_t length, std::uint8_t* out) {
  std::size_t written = 0;
  std::size_t i = 0;
  while (i < length) {
    const std::uint8_t code = data[i++];
    if (code == 0 || i + code - 1U > length) {
      return 0;
    }
    for (int k = 1; k < code; ++k) {
      if (data[i] == 0) {
        return 0;
      }
      out[written++] = data[i++];
    }
    if (code != 0xFF && i < length) {
      out[written++] = 0;
    }
  }
  return written;
}

std::size_t encode_samples(const SampleFrame& frame, std::uint8_t* out) {
  Writer writer(out);
  begin_packet(writer, PacketType::kSamples);
  writer.u32(frame.sequence);
  writer.u64(frame.board_us);
  writer.u32(frame.duration_us);
  writer.u32(frame.overruns);
  writer.u8(static_cast<std::uint8_t>(frame.scheme));
  writer.u8(frame.rows);
  writer.u8(frame.cols);
  writer.u8(0);  // flags
  writer.u16(frame.m);
  writer.u16(0);  // reserved
  for (std::size_t i = 0; i < frame.m; ++i) {
    writer.u16(frame.indices[i]);
  }
  for (std::size_t i = 0; i < frame.m; ++i) {
    writer.u16(frame.counts[i]);
  }
  return end_packet(writer, out);
}

}  // namespace acts
