// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Field out of the simulated world's ring; the file's layout is described in acts_sim/shared/timed_ring.py.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <iostream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "board/wired_board.hpp"
#include "field/field.hpp"
#include "field/mapped_file.hpp"

namespace acts {

namespace {

constexpr std::size_t kHeaderBytes = 64;
constexpr std::size_t kWrittenOffset = 24;
constexpr std::size_t kSlotHeaderBytes = 16;
constexpr std::uint32_t kVersion = 1;
constexpr std::int64_t kLookEveryNs = 100'000'000;
constexpr double kStandsStillNs = 5e8;
constexpr const char* kStandsStill =
    ": nothing was written for half a second, so the world that writes it has ended or hangs; no frames until it goes "
    "on";
constexpr const char* kGoesOn = ": goes on; frames again";
constexpr int kAttempts = 20;

// One open ring. Slots are named by their number since the first one written.
class Ring {
 public:
  Ring(const std::string& path, std::size_t width) : file_(path) {
    std::uint32_t header[3] = {};
    if (file_.size() < kHeaderBytes || std::memcmp(file_.data(), "ACTSRING", 8) != 0) {
      throw std::runtime_error(path + ": is no shared ring");
    }
    std::memcpy(header, file_.data() + 8, sizeof header);
    if (header[0] != kVersion || header[1] < 2) {
      throw std::runtime_error(path + ": is no shared ring of version 1 with two slots or more");
    }
    if (header[2] != width) {
      throw std::runtime_error(path + ": holds " + std::to_string(header[2]) + " values a slot, the array has " +
                               std::to_string(width) + " taxels");
    }
    slots_ = header[1];
    slot_bytes_ = kSlotHeaderBytes + 8 * width;
    if ((file_.size() - kHeaderBytes) / slot_bytes_ < slots_) {
      throw std::runtime_error(path + ": is shorter than its header says");
    }
  }

  bool same_file(const struct stat& status) const {
    return status.st_dev == file_.device() && status.st_ino == file_.inode();
  }

  // Whether its newest slot is too old. One that is just being written is not.
  bool stands_still(std::int64_t monotonic_ns) const {
    const std::uint64_t count = written();
    const std::optional<Slot> newest = count == 0 ? std::nullopt : slot(count - 1);
    return newest && static_cast<double>(monotonic_ns) - static_cast<double>(newest->time_ns) > kStandsStillNs;
  }

  double counts(std::size_t index, std::int64_t time_ns) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (!brackets(time_ns) && !locate(time_ns)) {
        continue;
      }
      if (empty_) {
        return 0.0;
      }
      const double early = clip_counts(value(early_, index));
      const double late = clip_counts(value(late_, index));
      std::atomic_thread_fence(std::memory_order_acquire);
      if (whole(early_) && whole(late_)) {
        return early + (late - early) * weight(time_ns);
      }
      located_written_ = kNever;  // the writer has come round to these slots
    }
    return 0.0;
  }

 private:
  struct Slot {
    std::uint64_t number = 0;
    std::uint64_t lock = 0;
    std::int64_t time_ns = 0;
  };
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  const std::uint8_t* at(std::uint64_t number) const {
    return file_.data() + kHeaderBytes + static_cast<std::size_t>(number % slots_) * slot_bytes_;
  }
  std::uint64_t load(const std::uint8_t* from) const {
    return __atomic_load_n(reinterpret_cast<const std::uint64_t*>(from), __ATOMIC_ACQUIRE);
  }
  std::uint64_t written() const { return load(file_.data() + kWrittenOffset); }
  bool whole(const Slot& slot) const { return slot.lock % 2 == 0 && load(at(slot.number)) == slot.lock; }
  double value(const Slot& slot, std::size_t index) const {
    double result = 0.0;
    std::memcpy(&result, at(slot.number) + kSlotHeaderBytes + 8 * index, sizeof result);
    return result;
  }
  double weight(std::int64_t time_ns) const {
    if (late_.time_ns <= early_.time_ns) {
      return 0.0;
    }
    // Differences of doubles: of times that a damaged ring holds the integers' may overflow.
    const double early = static_cast<double>(early_.time_ns);
    const double part = (static_cast<double>(time_ns) - early) / (static_cast<double>(late_.time_ns) - early);
    return std::clamp(part, 0.0, 1.0);
  }

  std::optional<Slot> slot(std::uint64_t number) const {
    Slot result;
    result.number = number;
    result.lock = load(at(number));
    std::memcpy(&result.time_ns, at(number) + 8, sizeof result.time_ns);
    std::atomic_thread_fence(std::memory_order_acquire);
    return whole(result) ? std::optional<Slot>(result) : std::nullopt;
  }

  // Whether the slots found last are still those around this time.
  bool brackets(std::int64_t time_ns) const {
    if (located_written_ == kNever || empty_) {
      return false;
    }
    const bool between = early_.time_ns <= time_ns && time_ns < late_.time_ns;
    return between || (located_written_ == written() && early_.number == late_.number && early_.time_ns <= time_ns);
  }

  // Finds the slots around a time, going back from the newest. False where the writer got in the way.
  bool locate(std::int64_t time_ns) {
    const std::uint64_t count = written();
    located_written_ = count;
    empty_ = count == 0;
    if (empty_) {
      return true;
    }
    // The slot that is one round older than the next may be being overwritten.
    const std::uint64_t oldest = count > slots_ - 1 ? count - (slots_ - 1) : 0;
    std::optional<Slot> early = slot(count - 1);
    std::optional<Slot> late = early;
    while (early && early->time_ns > time_ns && early->number > oldest) {
      late = early;
      early = slot(early->number - 1);
    }
    if (!early || !late) {
      located_written_ = kNever;
      return false;
    }
    // Before the oldest its values hold, after the newest those.
    early_ = *early;
    late_ = *late;
    return true;
  }

  MappedFile file_;
  std::uint64_t slots_ = 0;
  std::size_t slot_bytes_ = 0;
  std::uint64_t located_written_ = kNever;
  bool empty_ = true;
  Slot early_;
  Slot late_;
};

class WatchedRing final : public Field {
 public:
  WatchedRing(std::string path, std::size_t width) : path_(std::move(path)), width_(width) {}

  bool refresh(std::int64_t monotonic_ns) override {
    look(monotonic_ns);
    const bool stands_still = ring_ && ring_->stands_still(monotonic_ns);
    if (stands_still != stands_still_) {
      stands_still_ = stands_still;
      std::cerr << "virtual_board: " << path_ << (stands_still ? kStandsStill : kGoesOn) << std::endl;
    }
    return !stands_still;
  }

  double counts(std::size_t index, std::int64_t monotonic_ns) override {
    return ring_ ? ring_->counts(index, monotonic_ns) : 0.0;
  }

 private:
  // Takes up a new file, and lets go of one that is gone.
  void look(std::int64_t monotonic_ns) {
    if (monotonic_ns < next_look_ns_) {
      return;
    }
    next_look_ns_ = monotonic_ns + kLookEveryNs;
    struct stat status{};
    if (stat(path_.c_str(), &status) != 0) {
      ring_.reset();  // the world is gone, and its touch with it
      refused_.reset();
      return;
    }
    const bool refused = refused_ && refused_->st_dev == status.st_dev && refused_->st_ino == status.st_ino;
    if (refused || (ring_ && ring_->same_file(status))) {
      return;
    }
    ring_.reset();
    refused_.reset();
    try {
      ring_.emplace(path_, width_);
    } catch (const std::runtime_error& error) {
      // Said once a file: a stale one of another run is replaced as soon as the world starts.
      std::cerr << "virtual_board: " << error.what() << "; the skin stays untouched until it is replaced" << std::endl;
      refused_ = status;
    }
  }

  std::string path_;
  std::size_t width_;
  std::int64_t next_look_ns_ = std::numeric_limits<std::int64_t>::min();
  std::optional<Ring> ring_;
  std::optional<struct stat> refused_;
  bool stands_still_ = false;
};

}  // namespace

std::unique_ptr<Field> watch_ring(const std::string& path, std::size_t width) {
  return std::make_unique<WatchedRing>(path, width);
}

}  // namespace acts
