// What a board is told about sampling.
#pragma once

#include <cstdint>

#include "acts_firmware/frame.hpp"

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

  int taxels() const { return rows * cols; }

  // Taxels a frame will hold; known beforehand for every scheme.
  int frame_size() const { return scheme == Scheme::kRaster ? taxels() : m; }
};

bool operator==(const SamplingConfig& one, const SamplingConfig& other);

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

// What is wrong with the settings, the first there is.
ConfigError check(const SamplingConfig& config);

// The quota that is a share (above 0, up to 1) of m taxels, rounded up.
int quota_of(double share, int m);

}  // namespace acts
