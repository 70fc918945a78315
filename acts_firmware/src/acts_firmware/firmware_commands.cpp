// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the firmware does when the host speaks.
#include "acts_firmware/firmware.hpp"

namespace acts {

namespace {

constexpr Status status_of(UploadError error) {
  switch (error) {
    case UploadError::kNone:
      break;
    case UploadError::kImpossible:
      return Status::kModelImpossible;
    case UploadError::kOutOfOrder:
      return Status::kUploadOutOfOrder;
    case UploadError::kChecksum:
      return Status::kModelChecksum;
  }
  return Status::kOk;
}

}  // namespace

void Firmware::receive(const std::uint8_t* data, std::size_t length) {
  if (protocol_ == Protocol::kRasterAscii) {
    return;
  }
  for (std::size_t i = 0; i < length; ++i) {
    switch (receiver_.push(data[i])) {
      case PacketReceiver::Event::kNone:
        break;
      case PacketReceiver::Event::kPacket:
        take_packet();
        break;
      case PacketReceiver::Event::kDamaged:
        ++bad_commands_;
        break;
    }
  }
}

void Firmware::take_packet() {
  Command command;
  // A command whose reply could not be kept is left alone: the host repeats what is not answered.
  if (!read_command(receiver_.packet(), receiver_.size(), command) || waiting_answers_ == kMaxWaitingAnswers) {
    ++bad_commands_;
    return;
  }
  const Answer answer = execute(command);
  if (streaming_) {
    answers_[(first_answer_ + waiting_answers_++) % kMaxWaitingAnswers] = answer;
    send_answers();
  }
}

Answer Firmware::execute(const Command& command) {
  Answer answer;
  answer.request = command.request;
  answer.command = command.type;
  if (command.version != kPacketVersion) {
    answer.status = Status::kWrongVersion;
    return answer;
  }
  std::size_t shortest = 0;
  std::size_t longest = 0;
  switch (static_cast<CommandType>(command.type)) {
    case CommandType::kQuery:
    case CommandType::kUploadEnd:
      break;
    case CommandType::kConfigure:
      shortest = longest = kSettingsBytes;
      break;
    case CommandType::kUploadBegin:
      shortest = longest = kUploadBeginBytes;
      break;
    case CommandType::kUploadData:
      shortest = kUploadOffsetBytes + 1;
      longest = kUploadOffsetBytes + kMaxUploadPiece;
      break;
    case CommandType::kMapData:
      shortest = kMapPlaceBytes + kMapEntryBytes;
      longest = kMapPlaceBytes + kMapEntryBytes * kMaxMapPiece;
      break;
    case CommandType::kMapEnd:
      shortest = longest = kMapEndBytes;
      break;
    default:
      answer.status = Status::kUnknownCommand;
      return answer;
  }
  const bool length_told = command.length == kCommandHeadBytes + command.body_bytes + kPacketCrcBytes;
  if (!length_told || command.body_bytes < shortest || command.body_bytes > longest) {
    answer.status = Status::kBadLength;
    return answer;
  }
  switch (static_cast<CommandType>(command.type)) {
    case CommandType::kQuery:
      return answer;
    case CommandType::kConfigure:
      return take_settings(command, answer);
    case CommandType::kUploadBegin:
    case CommandType::kUploadData:
    case CommandType::kUploadEnd:
      return take_upload(command, answer);
    case CommandType::kMapData:
    case CommandType::kMapEnd:
      return take_map(command, answer);
  }
  return answer;
}

Answer Firmware::take_settings(const Command& command, Answer answer) {
  const SettingField refused = configure(read_settings(command.body));
  if (refused != SettingField::kNone) {
    answer.status = Status::kSettingRefused;
    answer.detail = static_cast<std::uint32_t>(refused);
  }
  return answer;
}

Answer Firmware::take_map(const Command& command, Answer answer) {
  Reader reader(command.body);
  bool possible = true;
  if (command.type == static_cast<std::uint8_t>(CommandType::kMapData)) {
    const int place = reader.u16();
    const std::size_t bytes = command.body_bytes - kMapPlaceBytes;
    if (bytes % kMapEntryBytes != 0) {
      answer.status = Status::kBadLength;
      return answer;
    }
    possible = sampler_.put_map(place, command.body + kMapPlaceBytes, static_cast<int>(bytes / kMapEntryBytes));
  } else {
    const int rows = reader.u8();
    const int cols = reader.u8();
    const int no_skin = reader.u8();
    reader.u8();  // reserved
    const std::uint32_t checksum = reader.u32();
    if (rows == 0 && cols == 0) {
      sampler_.forget_map();
    } else {
      possible = sampler_.finish_map(rows, cols, no_skin, checksum);
    }
  }
  if (!possible) {
    answer.status = Status::kMapImpossible;
  }
  return answer;
}

Answer Firmware::take_upload(const Command& command, Answer answer) {
  UploadError error = UploadError::kNone;
  if (command.type == static_cast<std::uint8_t>(CommandType::kUploadBegin)) {
    Model announced;
    const std::uint32_t bytes = read_upload_begin(command.body, announced);
    error = models_.begin(announced, bytes);
  } else if (command.type == static_cast<std::uint8_t>(CommandType::kUploadData)) {
    error = models_.add(Reader(command.body).u32(), command.body + kUploadOffsetBytes,
                        command.body_bytes - kUploadOffsetBytes);
  } else {
    error = models_.end();
  }
  answer.status = status_of(error);
  answer.detail = models_.received();
  return answer;
}

void Firmware::send_answers() {
  while (waiting_answers_ > 0) {
    const BoardState state = {board_.id(),
                              clock_.extend(board_.micros()),
                              settings_,
                              models_.model(),
                              active_output() != settings_.output,
                              models_.uploading(),
                              overruns_,
                              bad_commands_,
                              sampler_.map().checksum()};
    if (!queue_packet(encode_reply(answers_[first_answer_], state, message_.data()))) {
      return;
    }
    first_answer_ = (first_answer_ + 1) % kMaxWaitingAnswers;
    --waiting_answers_;
  }
}

}  // namespace acts
