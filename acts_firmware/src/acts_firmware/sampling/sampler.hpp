// The sampling schemes. acts_core/sampling/schemes.py is their readable reference; a test compares the two.
#pragma once

#include "acts_firmware/board/scanner.hpp"
#include "acts_firmware/frame.hpp"
#include "acts_firmware/sampling/adaptive.hpp"
#include "acts_firmware/sampling/config.hpp"
#include "acts_firmware/sampling/dither_order.hpp"
#include "acts_firmware/sampling/division_order.hpp"
#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/random_taxels.hpp"
#include "acts_firmware/sampling/skin_map.hpp"
#include "acts_firmware/sampling/tracking.hpp"
#include "acts_firmware/sampling/uniform.hpp"

namespace acts {

// Samples frame after frame; each scheme holds what goes from one to the next (uniform offset, random numbers, what to
// follow).
//
// A new scheme is a number in `Scheme` (frame.hpp) and `known` (config.cpp), a class in a file of its own, a branch in
// `sample`, and its Python implementation in acts_core/sampling/schemes.py.
class Sampler {
 public:
  Sampler();

  // Takes the settings over and starts anew, or says what is wrong and leaves everything as it was. A map of the skin
  // stays in force, unless the size of the matrix is another.
  ConfigError configure(const SamplingConfig& config);
  const SamplingConfig& config() const { return config_; }
  int frame_size() const { return config_.frame_size(); }

  // How the taxels lie on the skin, see SkinMap: in pieces, meanwhile as the matrix; then checked and put into force.
  // False where that cannot be.
  bool put_map(int place, const std::uint8_t* entries, int count);
  bool finish_map(int rows, int cols, int no_skin, std::uint32_t crc32);
  void forget_map();
  const SkinMap& map() const { return map_; }

  // Measures one frame: fills scheme, size, m, indices and counts.
  void sample(TaxelReader& reader, SampleFrame& frame);

 private:
  void begin();

  SamplingConfig config_;
  SkinMap map_;
  DivisionOrder order_;
  DitherOrder search_order_;
  Marks marks_;
  Adaptive adaptive_;
  Tracking tracking_;
  Uniform uniform_;
  RandomTaxels random_;
};

}  // namespace acts
