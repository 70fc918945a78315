// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The board's sampler behind C functions, measuring in recorded frames; for acts_tools/evaluate/images.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <sstream>
#include <string>

#include "acts_firmware/sampling/sampler.hpp"
#include "acts_firmware/wire/command.hpp"

namespace {

// What one reading differs from what the skin would let it be.
struct Noise {
  explicit Noise(std::uint64_t seed, double counts)
      : random(seed), reading(0.0, counts > 0.0 ? counts : 1.0), on(counts > 0.0) {}

  double draw() { return on ? reading(random) : 0.0; }

  std::mt19937_64 random;
  std::normal_distribution<double> reading;
  bool on;
};

// Every measurement sees the recording a little later than the one before, as on a skin that is being pressed.
class RecordingReader final : public acts::TaxelReader {
 public:
  RecordingReader(const std::uint16_t* frames, std::size_t count, int rows, int cols, double position, double step,
                  Noise& noise)
      : frames_(frames),
        count_(count),
        taxels_(static_cast<std::size_t>(rows * cols)),
        cols_(cols),
        position_(position),
        step_(step),
        noise_(noise) {}

  std::uint16_t measure(int row, int col) override {
    const auto taxel = static_cast<std::size_t>(row * cols_ + col);
    const double position = std::clamp(position_, 0.0, static_cast<double>(count_ - 1));
    position_ += step_;
    const auto before = std::min(static_cast<std::size_t>(position), count_ - 1);
    const std::size_t after = std::min(before + 1, count_ - 1);
    const double share = position - static_cast<double>(before);
    const double first = frames_[before * taxels_ + taxel];
    const double second = frames_[after * taxels_ + taxel];
    const long counts = std::lround(first + share * (second - first) + noise_.draw());
    return static_cast<std::uint16_t>(std::clamp(counts, 0L, long{acts::kCountMax}));
  }

 private:
  const std::uint16_t* frames_;
  std::size_t count_;
  std::size_t taxels_;
  int cols_;
  double position_;
  double step_;
  Noise& noise_;
};

const char* below(const acts::OwnSetting& setting) {
  switch (setting.below) {
    case acts::Below::kRows:
      return "rows";
    case acts::Below::kCols:
      return "cols";
    case acts::Below::kNothing:
      break;
  }
  return "";
}

std::string scheme_table() {
  std::ostringstream text;
  for (const acts::SchemeInfo& info : acts::Schemes::kInfos) {
    const auto own = std::count_if(info.own_settings.begin(), info.own_settings.end(),
                                   [](const acts::OwnSetting& setting) { return setting.number != 0; });
    text << info.name << '\t' << static_cast<int>(info.number) << '\t' << info.description << '\t' << info.measures_all
         << '\t' << own << '\n';
    for (const acts::OwnSetting& setting : info.own_settings) {
      if (setting.number != 0) {
        text << int{setting.number} << '\t' << setting.name << '\t' << setting.description << '\t' << setting.initial
             << '\t' << setting.minimum << '\t' << setting.maximum << '\t'
             << (setting.is_share() ? setting.share_name : "") << '\t' << setting.share_description << '\t'
             << setting.share_initial << '\t' << below(setting) << '\n';
      }
    }
  }
  return text.str();
}

}  // namespace

extern "C" {

struct ActsSampler {
  explicit ActsSampler(Noise its_noise) : noise(its_noise) {}

  acts::Sampler sampler;
  acts::SampleFrame frame;
  Noise noise;
};

// `settings` are those of a board as on the wire. Null where the core refuses them. Every reading has normal noise of
// this standard deviation.
ActsSampler* acts_sampler_new(const std::uint8_t* settings, std::size_t bytes, double noise_counts) {
  if (bytes != acts::kSettingsBytes) {
    return nullptr;
  }
  const acts::SamplingConfig config = acts::read_settings(settings).sampling;
  auto made = std::make_unique<ActsSampler>(Noise(config.seed, noise_counts));
  return made->sampler.configure(config) == acts::SettingField::kNone ? made.release() : nullptr;
}

void acts_sampler_free(ActsSampler* sampler) {
  delete sampler;
}

// Puts a map of the skin into force, of rows x cols places as acts::SkinMap takes them; 0 where that cannot be.
int acts_sampler_map(ActsSampler* sampler, int rows, int cols, int no_skin, const std::uint8_t* entries,
                     std::uint32_t crc32) {
  acts::Sampler& its = sampler->sampler;
  return its.put_map(0, entries, rows * cols) && its.finish_map(rows, cols, no_skin, crc32) ? 1 : 0;
}

// What the schemes say of themselves, in lines of fields that tabs separate. A scheme's line: name, number,
// description, whether it measures all, and the number of its own settings. Then a line for each of these: number,
// name, description, initial value, minimum, maximum; name, description and initial value of the share that it is given
// as (empty, empty, 0 for none); and "rows" or "cols" where it is below these.
const char* acts_sampler_schemes() {
  static const std::string kTable = scheme_table();
  return kTable.c_str();
}

// Whether a frame of m taxels can be.
int acts_sampler_takes(int scheme, int rows, int cols, int m) {
  return acts::Schemes::takes(static_cast<acts::Scheme>(scheme), rows, cols, m) ? 1 : 0;
}

// Samples one frame of `frames` (count, rows, cols), the first measurement at `position` (in frames, fractional), each
// of the others `step` later. Returns the number of taxels measured.
int acts_sampler_frame(ActsSampler* sampler, const std::uint16_t* frames, std::size_t count, double position,
                       double step, std::uint16_t* indices, std::uint16_t* counts) {
  const acts::SamplingConfig& config = sampler->sampler.config();
  RecordingReader reader(frames, count, config.rows, config.cols, position, step, sampler->noise);
  sampler->sampler.sample(reader, sampler->frame);
  std::copy_n(sampler->frame.indices.begin(), sampler->frame.m, indices);
  std::copy_n(sampler->frame.counts.begin(), sampler->frame.m, counts);
  return sampler->frame.m;
}

}  // extern "C"
