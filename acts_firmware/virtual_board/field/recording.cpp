// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Field out of a .npy file (format: NumPy enhancement proposal 1).
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>

#include "acts_firmware/limits.hpp"
#include "field/field.hpp"
#include "field/mapped_file.hpp"

namespace acts {

namespace {

constexpr std::size_t kMagicBytes = 6;

struct NpyHeader {
  std::string text;
  std::size_t data_offset;
};

NpyHeader read_header(const std::string& path, const MappedFile& file) {
  const std::uint8_t* bytes = file.data();
  if (file.size() < kMagicBytes + 6 || std::memcmp(bytes, "\x93NUMPY", kMagicBytes) != 0) {
    throw std::runtime_error(path + ": is no .npy file; write it with numpy.save");
  }
  // Version 1 has a length of two bytes, later ones of four.
  const std::size_t length_bytes = bytes[kMagicBytes] == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) {
    length |= static_cast<std::size_t>(bytes[kMagicBytes + 2 + i]) << (8 * i);
  }
  const std::size_t start = kMagicBytes + 2 + length_bytes;
  if (length > file.size() - start) {
    throw std::runtime_error(path + ": the header of the .npy file is cut off");
  }
  return {std::string(reinterpret_cast<const char*>(bytes) + start, length), start + length};
}

class Recording final : public Field {
 public:
  Recording(const std::string& path, int rows, int cols, double rate_hz, bool loop, std::int64_t start_ns)
      : path_(path), file_(path), frames_per_ns_(rate_hz / 1e9), loop_(loop), start_ns_(start_ns) {
    const NpyHeader header = read_header(path, file_);
    taxels_ = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    const std::string wanted =
        "uint16 in C order of shape (frames, " + std::to_string(rows) + ", " + std::to_string(cols) + ")";
    unsigned long long shape[3] = {};
    int past = -1;
    const std::size_t at = header.text.find("'shape': (");
    const bool read = at != std::string::npos && std::sscanf(header.text.c_str() + at, "'shape': (%llu, %llu, %llu)%n",
                                                             &shape[0], &shape[1], &shape[2], &past) == 3;
    const bool are_frames = read && past > 0;
    const bool has_size = are_frames && shape[1] == static_cast<unsigned long long>(rows) &&
                          shape[2] == static_cast<unsigned long long>(cols);
    const bool is_plain = header.text.find("'descr': '<u2'") != std::string::npos &&
                          header.text.find("'fortran_order': False") != std::string::npos;
    if (!has_size || !is_plain || shape[0] == 0) {
      std::string advice;
      if (are_frames && !has_size) {
        const std::string high = std::to_string(shape[1]);
        const std::string wide = std::to_string(shape[2]);
        advice = "; if that is the array's size, give it: --rows " + high + " --cols " + wide +
                 " (of launch files rows:=" + high + " cols:=" + wide + ")";
      } else if (has_size && !is_plain) {
        advice = "; save frames.astype(numpy.uint16, order='C')";
      }
      throw std::runtime_error(path + ": holds " + header.text.substr(0, header.text.find_last_of('}') + 1) + "; " +
                               wanted + " with one frame or more is needed" + advice);
    }
    frames_ = static_cast<std::size_t>(shape[0]);
    data_ = file_.data() + header.data_offset;
    if ((file_.size() - header.data_offset) / (2 * taxels_) < frames_) {
      throw std::runtime_error(path + ": is shorter than its header says; it was not written to its end");
    }
  }

  double counts(std::size_t index, std::int64_t monotonic_ns) override {
    double position = static_cast<double>(monotonic_ns - start_ns_) * frames_per_ns_;
    const auto count = static_cast<double>(frames_);
    if (loop_) {
      position -= std::floor(position / count) * count;
    }
    if (position <= 0.0) {
      return value(0, index);
    }
    const double whole = std::floor(position);
    if (!loop_ && whole >= count - 1.0) {
      return value(frames_ - 1, index);
    }
    const std::size_t before = static_cast<std::size_t>(whole) % frames_;
    const std::size_t after = (before + 1) % frames_;
    const double part = position - whole;
    return value(before, index) * (1.0 - part) + value(after, index) * part;
  }

 private:
  double value(std::size_t frame, std::size_t index) {
    const std::uint8_t* at = data_ + 2 * (frame * taxels_ + index);
    const int counts = at[0] | at[1] << 8;
    if (counts > kCountMax && !told_) {
      told_ = true;
      std::cerr << "virtual_board: " << path_ << ": frame " << frame << " has " << counts << " counts; all above "
                << kCountMax << " are sent as " << kCountMax << ", the most of the board's converter" << std::endl;
    }
    return counts;
  }

  std::string path_;
  MappedFile file_;
  double frames_per_ns_;
  bool loop_;
  std::int64_t start_ns_;
  std::size_t taxels_ = 0;
  std::size_t frames_ = 0;
  const std::uint8_t* data_ = nullptr;
  bool told_ = false;
};

}  // namespace

std::unique_ptr<Field> open_recording(const std::string& path, int rows, int cols, double rate_hz, bool loop,
                                      std::int64_t start_monotonic_ns) {
  return std::make_unique<Recording>(path, rows, cols, rate_hz, loop, start_monotonic_ns);
}

}  // namespace acts
