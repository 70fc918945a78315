// The sampling schemes. acts_core/sampling.py is their readable reference; a test compares the two.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/board/scanner.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/sampling/division_order.hpp"
#include "acts_firmware/sampling/random.hpp"

namespace acts {

enum class NeighbourOrder : std::uint8_t {
  kColumns = 0,  // columns outer 0, -1, +1, rows inner -1, 0, +1: the published sketches
  kRows = 1,     // rows outer -1, 0, +1, columns inner -1, 0, +1: fits the frames of the paper's figures 4 and 5
};

struct SamplingConfig {
  int rows = 32;
  int cols = 32;
  Scheme scheme = Scheme::kAdaptive;
  int m = 55;           // taxels per frame; raster measures all
  int threshold = 180;  // counts; above it adaptive and hybrid search the neighbours, tracking follows the taxel
  NeighbourOrder neighbour_order = NeighbourOrder::kColumns;
  std::uint64_t seed = 1;   // of random and hybrid sampling
  int search_quota = 11;    // taxels of a tracking frame that are kept for the search, 1 to m
  int adaptive_quota = 28;  // taxels of a hybrid frame that are chosen adaptively, 1 to m
};

enum class ConfigError : std::uint8_t {
  kNone,
  kSize,
  kM,
  kThreshold,
  kUniformM,
  kScheme,
  kSearchQuota,
  kAdaptiveQuota
};

// Spacing of rows and columns of a uniform grid of m taxels; zeros where the array has none of that many. Of all grids
// ceil(rows / s) * ceil(cols / t) == m the one with the most equal spacings, the larger one along the rows.
struct Spacing {
  int row = 0;
  int col = 0;
};
Spacing uniform_spacing(int rows, int cols, int m);

// The quota that is a share (above 0, up to 1) of m taxels, rounded up.
int quota_of(double share, int m);

// Samples frame after frame; holds what goes from one to the next (uniform offset, random numbers, what to follow).
//
// A new scheme is a number in `Scheme`, a private function beside `adaptive`, a branch in `sample`, and its twin in
// acts_core/sampling.py.
class Sampler {
 public:
  Sampler();

  // Takes the settings over and starts anew, or says what is wrong and leaves everything as it was.
  ConfigError configure(const SamplingConfig& config);
  const SamplingConfig& config() const { return config_; }

  // Taxels a frame will hold; known beforehand for every scheme.
  int frame_size() const { return config_.scheme == Scheme::kRaster ? config_.rows * config_.cols : config_.m; }

  // Measures one frame: fills scheme, size, m, indices and counts.
  void sample(TaxelReader& reader, SampleFrame& frame);

 private:
  struct Visit {
    std::uint16_t index;
    std::uint8_t next;  // which neighbour comes next
  };

  void adaptive(TaxelReader& reader, SampleFrame& frame, int m);
  void hybrid(TaxelReader& reader, SampleFrame& frame);
  void tracking(TaxelReader& reader, SampleFrame& frame);
  void uniform(TaxelReader& reader, SampleFrame& frame);
  void random(TaxelReader& reader, SampleFrame& frame);
  void shuffle_swap(std::uint32_t i, std::uint32_t j);
  void raster(TaxelReader& reader, SampleFrame& frame);
  void begin_marks();
  bool touched(TaxelReader& reader, SampleFrame& frame, int index);
  void track(TaxelReader& reader, SampleFrame& frame, int index);
  int list_candidates(int limit);

  SamplingConfig config_;
  DivisionOrder order_;
  Spacing spacing_;
  int offset_ = 0;  // of uniform sampling, 0 to spacing.row * spacing.col - 1
  Pcg32 random_;
  std::array<std::uint16_t, kMaxTaxels> shuffled_{};
  std::array<std::uint16_t, kMaxTaxels> place_{};  // of each taxel in shuffled_
  // A taxel was measured in this frame when it carries the frame's mark; so nothing is cleared between frames.
  std::array<std::uint16_t, kMaxTaxels> mark_{};
  std::uint16_t frame_mark_ = 0;
  std::array<Visit, kMaxTaxels> stack_{};
  // Of tracking: what was pressed when last measured, and how many of a taxel and its neighbours were.
  std::array<bool, kMaxTaxels> pressed_{};
  std::array<std::uint8_t, kMaxTaxels> pressed_near_{};
  std::array<std::uint16_t, kMaxTaxels> candidates_{};
  int cursor_ = 0;  // the taxel from which candidates are taken
  int walk_ = 0;    // rank in the division order at which the search goes on
};

}  // namespace acts
