// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Plain checks of how the firmware hears its host; what the commands do, Python tests.
#include "acts_firmware/wire/command.hpp"

#include <cstdint>
#include <cstring>

#include "acts_firmware/wire/packet_receiver.hpp"
#include "core_checks.hpp"

namespace {

Bytes query(std::uint32_t request) {
  Bytes packet(12);
  acts::Writer writer(packet.data());
  writer.u8(static_cast<std::uint8_t>(acts::CommandType::kQuery));
  writer.u8(acts::kPacketVersion);
  writer.u16(12);
  writer.u32(request);
  writer.u32(acts::crc32(packet.data(), writer.length()));
  Bytes wire = encoded(packet);
  wire.push_back(acts::kDelimiter);
  return wire;
}

// Takes the first packet that waits for the host, without stuffing.
Bytes next_packet(acts::TransmitQueue& output) {
  Bytes stuffed;
  while (output.size() > 0) {
    const std::uint8_t byte = *output.front().data;
    output.pop(1);
    if (byte != acts::kDelimiter) {
      stuffed.push_back(byte);
    } else if (!stuffed.empty()) {
      break;
    }
  }
  Bytes packet(stuffed.size());
  packet.resize(acts::cobs_decode(stuffed.data(), stuffed.size(), packet.data()));
  return packet;
}

void test_receiver_keeps_to_its_room() {
  acts::PacketReceiver receiver;
  const auto feed = [&receiver](const Bytes& wire) {
    acts::PacketReceiver::Event last = acts::PacketReceiver::Event::kNone;
    for (const std::uint8_t byte : wire) {
      last = receiver.push(byte);
    }
    return last;
  };
  for (const std::size_t length : {std::size_t{1}, std::size_t{254}, acts::PacketReceiver::kCapacity}) {
    Bytes wire = encoded(run_of(length));
    wire.push_back(acts::kDelimiter);
    CHECK(feed(wire) == acts::PacketReceiver::Event::kPacket);
    CHECK(receiver.size() == length);
    CHECK(std::memcmp(receiver.packet(), run_of(length).data(), length) == 0);
  }
  Bytes too_long = encoded(run_of(acts::PacketReceiver::kCapacity + 1));
  too_long.push_back(acts::kDelimiter);
  CHECK(feed(too_long) == acts::PacketReceiver::Event::kDamaged);
  CHECK(feed({0x05, 0x11, 0x00}) == acts::PacketReceiver::Event::kDamaged);  // four bytes are announced
  CHECK(feed({0x00, 0x00}) == acts::PacketReceiver::Event::kNone);
}

void test_a_query_is_answered() {
  IndexBoard board(32, 32);
  auto firmware = make_firmware(board);
  firmware->start_stream();
  for (const std::uint8_t byte : query(0xA1B2C3D4)) {
    firmware->receive(&byte, 1);
  }
  const Bytes reply = next_packet(firmware->output());
  CHECK(reply.size() == acts::kReplyBytes);
  CHECK(reply[0] == 2 && reply[1] == 1);
  CHECK(little_endian(reply, 4, 4) == 0xA1B2C3D4);
  CHECK(reply[8] == 16 && reply[9] == 0);
  CHECK(little_endian(reply, 20, 8) == acts::kVirtualBoardId);
  CHECK(reply[36] == 32 && reply[37] == 32 && reply[38] == 3);
  constexpr std::size_t kEnd = acts::kReplyBytes - acts::kPacketCrcBytes;
  CHECK(little_endian(reply, kEnd, 4) == acts::crc32(reply.data(), kEnd));
}

void test_the_published_sketch_listens_to_nobody() {
  IndexBoard board(32, 32);
  auto firmware = make_firmware(board, acts::Protocol::kRasterAscii);
  firmware->start_stream();
  const Bytes command = query(1);
  firmware->receive(command.data(), command.size());
  CHECK(firmware->output().size() == 0);
}

}  // namespace

void test_commands() {
  test_receiver_keeps_to_its_room();
  test_a_query_is_answered();
  test_the_published_sketch_listens_to_nobody();
}
