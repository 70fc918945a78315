// The board's sampler behind C functions, measuring in recorded frames; for acts_tools/evaluate/images.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>

#include "acts_firmware/sampling/sampler.hpp"

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

}  // namespace

extern "C" {

struct ActsSampler {
  explicit ActsSampler(Noise its_noise) : noise(its_noise) {}

  acts::Sampler sampler;
  acts::SampleFrame frame;
  Noise noise;
};

// Null where the core refuses the settings. Every reading has normal noise of this standard deviation.
ActsSampler* acts_sampler_new(int rows, int cols, int scheme, int m, int threshold, int neighbour_order,
                              std::uint64_t seed, int search_quota, int adaptive_quota, double noise_counts) {
  acts::SamplingConfig config;
  config.rows = rows;
  config.cols = cols;
  config.scheme = static_cast<acts::Scheme>(scheme);
  config.m = m;
  config.threshold = threshold;
  config.neighbour_order = static_cast<acts::NeighbourOrder>(neighbour_order);
  config.seed = seed;
  config.search_quota = search_quota;
  config.adaptive_quota = adaptive_quota;
  auto made = std::make_unique<ActsSampler>(Noise(seed, noise_counts));
  return made->sampler.configure(config) == acts::ConfigError::kNone ? made.release() : nullptr;
}

void acts_sampler_free(ActsSampler* sampler) {
  delete sampler;
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
