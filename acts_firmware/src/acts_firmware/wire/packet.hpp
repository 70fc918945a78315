// Frames to bytes: packet, CRC and COBS. docs/wire_protocol.md describes the layout.
#pragma once

#include <cstddef>
#include <cstdint>

#include "acts_firmware/frame.hpp"

namespace acts {

constexpr std::uint8_t kPacketSamples = 1;
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

// CRC-32 of IEEE 802.3, as zlib.crc32.
std::uint32_t crc32(const std::uint8_t* data, std::size_t length);

// Consistent Overhead Byte Stuffing (S. Cheshire, M. Baker, doi:10.1109/90.769765), without delimiter. `out` has room
// for cobs_bytes_max(length). Returns the number of bytes written.
std::size_t cobs_encode(const std::uint8_t* data, std::size_t length, std::uint8_t* out);

// Undoes it; `out` has room for `length` bytes. Returns the number of bytes written, 0 where `data` is not COBS.
std::size_t cobs_decode(const std::uint8_t* data, std::size_t length, std::uint8_t* out);

// Writes the packet, CRC included, to `out` (kMaxPacketBytes). Returns its length.
std::size_t encode_samples(const SampleFrame& frame, std::uint8_t* out);

}  // namespace acts
