// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a host says, and the reply to it. docs/wire_protocol.md describes the layout.
#pragma once

#include <cstddef>
#include <cstdint>

#include "acts_firmware/model/model.hpp"
#include "acts_firmware/settings.hpp"

namespace acts {

// Numbers on the wire, here and below.
enum class CommandType : std::uint8_t {
  kQuery = 16,
  kConfigure = 17,
  kUploadBegin = 18,
  kUploadData = 19,
  kUploadEnd = 20,
  kMapData = 21,
  kMapEnd = 22,
};
constexpr std::uint8_t kFirstCommand = 16;  // smaller packet types are the board's own

enum class Status : std::uint8_t {
  kOk = 0,
  kUnknownCommand = 1,
  kWrongVersion = 2,
  kBadLength = 3,
  kSettingRefused = 4,
  kModelImpossible = 5,
  kUploadOutOfOrder = 6,
  kModelChecksum = 7,
  kMapImpossible = 8,
};

constexpr std::size_t kCommandHeadBytes = 8;  // type, version, length, request
constexpr std::size_t kSettingsBytes = 24 + 2 * kOwnSettings;
constexpr std::size_t kUploadBeginBytes = 16;
constexpr std::size_t kUploadOffsetBytes = 4;
constexpr std::size_t kMaxUploadPiece = 1024;
constexpr std::size_t kMapPlaceBytes = 2;
constexpr std::size_t kMapEntryBytes = 2;
constexpr std::size_t kMaxMapPiece = 512;  // entries
constexpr std::size_t kMapEndBytes = 8;

struct Command {
  std::uint8_t type = 0;
  std::uint8_t version = 0;
  std::uint16_t length = 0;  // that the packet says it has
  std::uint32_t request = 0;
  const std::uint8_t* body = nullptr;
  std::size_t body_bytes = 0;  // that it really has
};

// False where the packet was damaged on its way, or is none that a host sends.
bool read_command(const std::uint8_t* packet, std::size_t size, Command& command);

// `body` holds kSettingsBytes; what they mean is not checked.
Settings read_settings(const std::uint8_t* body);

// `body` holds kUploadBeginBytes. Returns the model's size in bytes.
std::uint32_t read_upload_begin(const std::uint8_t* body, Model& model);

// How a command ended.
struct Answer {
  std::uint32_t request = 0;
  std::uint8_t command = 0;
  Status status = Status::kOk;
  std::uint32_t detail = 0;  // SettingField, or the offset that is wanted next
};

// What the board tells about itself with every answer.
struct BoardState {
  std::uint64_t board_id;
  std::uint64_t uptime_us;
  const Settings& settings;
  const Model& model;
  bool samples_only;  // more is asked for, but the model does not allow it
  bool uploading;
  std::uint32_t overruns;
  std::uint32_t bad_commands;
  std::uint32_t map_checksum;  // of the skin's map in force, 0: none
};

constexpr std::size_t kReplyBytes = 68 + kSettingsBytes;

// Writes the packet, CRC included, to `out` (kReplyBytes). Returns its length.
std::size_t encode_reply(const Answer& answer, const BoardState& state, std::uint8_t* out);

}  // namespace acts
