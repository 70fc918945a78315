// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "acts_firmware/wire/command.hpp"

#include "acts_firmware/version.hpp"
#include "acts_firmware/wire/bytes.hpp"
#include "acts_firmware/wire/packet.hpp"
#include "acts_firmware/wire/packet_receiver.hpp"

namespace acts {

namespace {

static_assert(kCommandHeadBytes + kUploadOffsetBytes + kMaxUploadPiece + kPacketCrcBytes == PacketReceiver::kCapacity,
              "the largest command fits exactly");

// So many own settings of schemes lie in the midst of the others, the rest behind them.
constexpr std::size_t kOwnInTheMidst = 2;
static_assert(kOwnSettings >= kOwnInTheMidst, "the settings of tracking and hybrid have their places");

constexpr std::uint8_t kFlagSamplesOnly = 1;
constexpr std::uint8_t kFlagUploading = 2;

void put_settings(Writer& writer, const Settings& settings) {
  const SamplingConfig& sampling = settings.sampling;
  writer.u8(static_cast<std::uint8_t>(sampling.rows));
  writer.u8(static_cast<std::uint8_t>(sampling.cols));
  writer.u8(static_cast<std::uint8_t>(sampling.scheme));
  writer.u8(static_cast<std::uint8_t>(sampling.neighbour_order));
  writer.u16(static_cast<std::uint16_t>(sampling.m));
  writer.u16(static_cast<std::uint16_t>(sampling.threshold));
  for (std::size_t i = 0; i < kOwnInTheMidst; ++i) {
    writer.u16(static_cast<std::uint16_t>(sampling.own_values[i]));
  }
  writer.u16(static_cast<std::uint16_t>(settings.touch_counts));
  writer.u8(static_cast<std::uint8_t>(settings.output));
  writer.u8(static_cast<std::uint8_t>(settings.led));
  writer.u32(settings.frame_period_us);
  writer.u64(sampling.seed);
  for (std::size_t i = kOwnInTheMidst; i < kOwnSettings; ++i) {
    writer.u16(static_cast<std::uint16_t>(sampling.own_values[i]));
  }
}

void put_model(Writer& writer, const Model& model) {
  writer.u8(static_cast<std::uint8_t>(model.kind));
  writer.u8(model.patch_side);
  writer.u8(model.patch_step);
  writer.u8(model.objects);
  writer.u16(model.rows);
  writer.u16(model.columns);
  writer.u32(model.crc32);
}

}  // namespace

bool read_command(const std::uint8_t* packet, std::size_t size, Command& command) {
  if (size < kCommandHeadBytes + kPacketCrcBytes) {
    return false;
  }
  const std::size_t end = size - kPacketCrcBytes;
  if (crc32(packet, end) != Reader(packet + end).u32()) {
    return false;
  }
  Reader reader(packet);
  command.type = reader.u8();
  command.version = reader.u8();
  command.length = reader.u16();
  command.request = reader.u32();
  command.body = packet + kCommandHeadBytes;
  command.body_bytes = end - kCommandHeadBytes;
  return command.type >= kFirstCommand;
}

Settings read_settings(const std::uint8_t* body) {
  Reader reader(body);
  Settings settings;
  SamplingConfig& sampling = settings.sampling;
  sampling.rows = reader.u8();
  sampling.cols = reader.u8();
  sampling.scheme = static_cast<Scheme>(reader.u8());
  sampling.neighbour_order = static_cast<NeighbourOrder>(reader.u8());
  sampling.m = reader.u16();
  sampling.threshold = reader.u16();
  for (std::size_t i = 0; i < kOwnInTheMidst; ++i) {
    sampling.own_values[i] = reader.u16();
  }
  settings.touch_counts = reader.u16();
  settings.output = static_cast<Output>(reader.u8());
  settings.led = static_cast<LedMode>(reader.u8());
  settings.frame_period_us = reader.u32();
  sampling.seed = reader.u64();
  for (std::size_t i = kOwnInTheMidst; i < kOwnSettings; ++i) {
    sampling.own_values[i] = reader.u16();
  }
  return settings;
}

std::uint32_t read_upload_begin(const std::uint8_t* body, Model& model) {
  Reader reader(body);
  model.kind = static_cast<ModelKind>(reader.u8());
  model.patch_side = reader.u8();
  model.patch_step = reader.u8();
  model.objects = reader.u8();
  model.rows = reader.u16();
  model.columns = reader.u16();
  const std::uint32_t bytes = reader.u32();
  model.crc32 = reader.u32();
  return bytes;
}

std::size_t encode_reply(const Answer& answer, const BoardState& state, std::uint8_t* out) {
  Writer writer(out);
  begin_packet(writer, PacketType::kReply);
  writer.u32(answer.request);
  writer.u8(answer.command);
  writer.u8(static_cast<std::uint8_t>(answer.status));
  writer.u16(0);  // reserved
  writer.u32(answer.detail);
  writer.u8(kVersionMajor);
  writer.u8(kVersionMinor);
  writer.u8(kVersionPatch);
  writer.u8(
      static_cast<std::uint8_t>((state.samples_only ? kFlagSamplesOnly : 0) | (state.uploading ? kFlagUploading : 0)));
  writer.u64(state.board_id);
  writer.u64(state.uptime_us);
  put_settings(writer, state.settings);
  put_model(writer, state.model);
  writer.u32(static_cast<std::uint32_t>(kModelBytes));
  writer.u32(state.overruns);
  writer.u32(state.bad_commands);
  writer.u32(state.map_checksum);
  return end_packet(writer, out);
}

}  // namespace acts
