// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Packets, their CRC and COBS; frames as packets. docs/wire_protocol.md describes the layout.
#pragma once

#include <cstddef>
#include <cstdint>

#include "acts_firmware/frame.hpp"
#include "acts_firmware/wire/bytes.hpp"

namespace acts {

// What the board says; the host's packets are in wire/command.hpp.
enum class PacketType : std::uint8_t { kSamples = 1, kReply = 2, kImage = 3, kObject = 4 };

constexpr std::uint8_t kPacketVersion = 1;
constexpr std::size_t kPacketHeaderBytes = 32;
constexpr std::size_t kPacketCrcBytes = 4;
constexpr std::uint8_t kDelimiter = 0x00;

constexpr std::size_t samples_packet_bytes(std::size_t m) {
  return kPacketHeaderBytes + 4 * m + kPacketCrcBytes;
}
constexpr std::size_t cobs_bytes_max(std::size_t length) {
  return length + length / 254 + 1;
}

constexpr std::size_t kMaxPacketBytes = samples_packet_bytes(kMaxTaxels);
constexpr std::size_t kMaxWireBytes = cobs_bytes_max(kMaxPacketBytes) + 1;

// CRC-32 of IEEE 802.3, as zlib.crc32; of data in pieces, given the CRC of those before.
std::uint32_t crc32(const std::uint8_t* data, std::size_t length, std::uint32_t before = 0);

// The first four bytes of a packet; its length comes with end_packet.
void begin_packet(Writer& writer, PacketType type);

// Fills the length in, and writes the CRC. `out` is where the packet begins. Returns its length.
std::size_t end_packet(Writer& writer, std::uint8_t* out);

// Consistent Overhead Byte Stuffing (S. Cheshire, M. Baker, doi:10.1109/90.769765), without delimiter. `out` has room
// for cobs_bytes_max(length). Returns the number of bytes written.
std::size_t cobs_encode(const std::uint8_t* data, std::size_t length, std::uint8_t* out);

// Undoes it; `out` has room for `length` bytes. Returns the number of bytes written, 0 where `data` is not COBS.
std::size_t cobs_decode(const std::uint8_t* data, std::size_t length, std::uint8_t* out);

// Writes the packet, CRC included, to `out` (kMaxPacketBytes). Returns its length.
std::size_t encode_samples(const SampleFrame& frame, std::uint8_t* out);

}  // namespace acts
